"""A page of the live view as a program: it asks for frames, steers, and keeps the last state."""

import json
import re
import time

import numpy as np
from websockets.sync.client import connect

from tests.cli import program
from tests.live.headers import FRAME

ADDRESS = r"live view: (http://[0-9.:]+/)#(\S+)"


class Watcher:
    """A page that was opened by the address that the program printed."""

    def __init__(self, printed):
        address, token = re.search(ADDRESS, printed).groups()
        self.state = {}
        self._token = token
        self._opening = connect(
            f"{address.replace('http', 'ws', 1)}live",
            origin=address.rstrip("/"),
            open_timeout=program.PATIENCE_S,
            compression=None,
        )

    def __enter__(self):
        self._socket = self._opening.__enter__()
        self.ask(ask="hello", token=self._token)
        self.welcome = json.loads(self._socket.recv(program.PATIENCE_S))
        return self

    def __exit__(self, *exception):
        self._opening.__exit__(*exception)

    def ask(self, **request):
        """Send a request."""
        self._socket.send(json.dumps(request))

    def frame(self):
        """The next frame's header; a state that comes before it is kept."""
        self.ask(ask="next")
        while True:
            told = self._socket.recv(program.PATIENCE_S)
            if isinstance(told, bytes):
                return np.frombuffer(told, FRAME, 1)[0]
            said = json.loads(told)
            assert said["tell"] == "state", said
            self.state = said

    def until(self, what):
        """Ask for frames until one and the state are as wanted; give the header."""
        end = time.monotonic() + program.PATIENCE_S
        while not what(header := self.frame(), self.state):
            assert time.monotonic() < end, f"{header}, {self.state}"
        return header

    def hold(self, x_mm):
        """Hold the hand at a place, until it is there."""
        self.ask(ask="point", x_mm=x_mm)
        return self.until(lambda header, _: abs(header["x_mm"] - x_mm) < 0.02)

    def read_line(self, number):
        """Be the hand: to the end of a line, and back."""
        self.until(lambda header, _: header["line"] == number)
        self.hold(290.0)
        self.hold(-5.4)
