"""``vbraille session run --monitor``: a live view of a session, as a browser has it."""

import json
import os
import re
import signal
import subprocess
from contextlib import contextmanager

import msgspec
import numpy as np
import pytest
from websockets.sync.client import connect

from tests.cli import program
from tests.sessions.sittings import MINI, of
from tests.tiers import heavy
from vbraille.live.messages import (
    FRAME,
    Hello,
    LetGo,
    Next,
    Point,
    Press,
    Refused,
    State,
    Turn,
    Welcome,
)
from vbraille.sessions.record.check import check
from vbraille.sessions.record.export import rows
from vbraille.sessions.record.folder import load

SEEING = MINI + "[session]\nblind = false\n"
HOW = ("--participant", "P07", "--seed", "1", "--hand", "sweep:150", "--sound", "none")


@contextmanager
def opened(address):
    """A page of the live view at an address."""
    url, _, token = address.partition("/#")
    with connect(f"{url.replace('http', 'ws')}/live") as socket:
        yield Page(socket, token)


class Page:
    """A page as a program: it asks, and takes what comes."""

    def __init__(self, socket, token):
        self.socket = socket
        self.state = None
        self.states = []
        self.ask(Hello(token=token))
        self.welcome = msgspec.json.decode(self.socket.recv(program.PATIENCE_S), type=Welcome)

    def ask(self, request):
        self.socket.send(msgspec.json.encode(request).decode())

    def next(self):
        """The next frame: its header, and its deflections; states that come before are kept."""
        self.ask(Next())
        while isinstance(told := self.socket.recv(program.PATIENCE_S), str):
            self.state = msgspec.json.decode(told, type=State)
            self.states.append(self.state)
        header = np.frombuffer(told, FRAME, 1)[0]
        shape = int(header["rows"]), int(header["columns"])
        size = shape[0] * shape[1]
        rest = np.frombuffer(told, "<f4", offset=FRAME.itemsize)
        return header, rest[:size].reshape(shape), rest[size:].reshape(-1, 3)

    def until(self, pattern):
        """Draw frames until the page says that the session waits for something."""
        frames = [self.next()]
        while not re.search(pattern, self.state.place if self.state else ""):
            frames.append(self.next())
        return frames

    def refused(self, request):
        """Why a request is refused."""
        self.ask(request)
        return msgspec.json.decode(self.socket.recv(program.PATIENCE_S), type=Refused).why


class Sitting:
    """A session in a process, and what it says."""

    def __init__(self, process):
        self.process = process
        self.said = []

    def until(self, pattern):
        for line in self.process.stdout:
            self.said.append(line.rstrip("\n"))
            if re.search(pattern, line):
                return self.said[-1]
        raise AssertionError(f"{pattern!r} was not said, but {self.said}")

    def type(self, line):
        self.process.stdin.write(f"{line}\n")
        self.process.stdin.flush()


@contextmanager
def sat(room, toml=MINI, answers="typed", more=()):
    """A session before a live view, and a page of that."""
    (room / "mini.toml").write_text(toml)
    words = "session", "run", room / "mini.toml", *HOW, "--answers", answers, "--out", room / "s"
    with program.start(
        *words, "--monitor", *more, stdin=subprocess.PIPE, encoding="utf-8"
    ) as process:
        try:
            yield Sitting(process)
            assert process.wait(program.PATIENCE_S) == 0, process.stderr.read()
        finally:
            process.kill()


def address_of(sitting):
    return sitting.until(r"^live view: http://").removeprefix("live view: ")


def read_all(sitting, first=1):
    """Answer all trials, and end the session."""
    for _ in range(first, 5):
        sitting.until("^read:")
        sitting.type("c")
    sitting.until("^last:")
    sitting.type("")
    sitting.until("^record:")


def test_who_watches_is_blind(tmp_path):
    with sat(tmp_path) as sitting, opened(address_of(sitting)) as page:
        frames = page.until("trial 1 of 4: was read")
        sitting.type("c")
        sitting.until("^answer: trial 1")
        frames += page.until("trial 2 of 4")
        sitting.type("stop")
        sitting.until("^record:")
    assert {frame.size for _, frame, _ in frames} == {0}
    assert all(np.isnan(samples[:, 2]).all() for _, _, samples in frames)
    assert max(header["line"] for header, _, _ in frames) >= 1
    assert not any(state.lines or state.knobs or not state.blind for state in page.states)
    assert not any(one.startswith("answer") for state in page.states for one in state.said)
    record = load(tmp_path / "s")
    assert all(finding.good for finding in check(record))
    (run,) = of(record.told.events, "run")
    assert run["monitor"] == {"blind": True, "host": "127.0.0.1", "pointer": True}
    assert [row["moved_by"] for row in rows(record)][:1] == ["simulated"]
