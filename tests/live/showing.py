"""A live view of a line whose hand a test is, and pages of it: by a program, or in a browser."""

import json
import math
import shutil
import threading
import time
from http.client import HTTPConnection

import numpy as np
import pytest
from msgspec.structs import replace
from websockets.sync.client import connect

from vbraille.engine.record import INTS, Ring
from vbraille.live.messages import (
    CommandShown,
    KnobShown,
    LetGo,
    LineShown,
    PagePress,
    Point,
    Turn,
    ViewState,
)
from vbraille.live.states import array_shown, geometry_shown, rows_shown
from vbraille.live.view import LiveView
from vbraille.render import STRESS2

TEXT = "abc fed"
MASKS = np.array([1, 3, 9, 0, 11, 17, 25], np.uint8)
LINES = [
    LineShown(n + 1, TEXT, 0.0, 14.0 * n, MASKS.tolist(), [(i, i + 1) for i in range(7)], n == 1)
    for n in range(3)
]
PATIENCE_S = 20.0
# The header of a frame, as docs/live-view.md has it.
HEADER = np.dtype(
    [
        *((name, "<u2") for name in ("rows", "columns", "signals", "unused")),
        *((name, "<u4") for name in ("flags", "state", "line", "part", "late", "spare")),
        *((name, "<f8") for name in ("tick", "time_s")),
        *((name, "<f4") for name in ("x_mm", "y_mm", "theta_rad", "vx_mm_s")),
        *((name, "<f4") for name in ("lateness_us", "work_us", "share", "age_ms")),
    ]
)


def parts(frame):
    """Header and deflections of a frame, of which nothing may be left over."""
    header = np.frombuffer(frame, HEADER, 1)[0]
    numbers = np.frombuffer(frame, "<f4", offset=HEADER.itemsize)
    size = int(header["rows"]) * int(header["columns"])
    assert numbers.size == size + header["signals"]
    return header, numbers[:size].reshape(header["rows"], header["columns"])


class Reading:
    """A reading whose hand stands still until a page moves it; a context manager."""

    def __init__(self, **options):
        self.style, self.display = STRESS2.style, STRESS2.display
        self.asked, self.x_mm = [], 40.0
        self.view = LiveView(**options)
        self.state = ViewState(
            title="A story",
            array=array_shown(self.display),
            geometry=geometry_shown(self.style.geometry),
            rows_shown=rows_shown(self.style, self.display),
            lines=LINES,
            place="line 2",
            knobs=[KnobShown("texture", "texture", "", 0.5, 0.1, 0.0, 1.0)],
            commands=[CommandShown("LNDN", "next line")],
            simulated=True,
            device="reading",
            said=["line: 2"],
        )
        self.program = self.style.render(MASKS, self.display)
        self.ring, self.count = Ring.alone(self.display.shape, 4096), 0
        self._stop = threading.Event()
        self._thread = threading.Thread(target=self._tick)

    @property
    def address(self):
        return self.view.addresses[0].removeprefix("live view: ")

    def frame(self, x_mm=None):
        return self.program.path(np.array([self.x_mm if x_mm is None else x_mm]))[0]

    def tick(self, count=1):
        """Leave records of ticks, as the engine does."""
        ints, floats, frames = self.ring.columns
        frame = self.frame()
        for _ in range(count):
            slot, n = self.ring.slot, self.count
            ints[slot] = 0
            ints[slot, :2] = n, time.monotonic_ns()
            ints[slot, INTS.index("line")] = 2
            floats[slot] = 0
            floats[slot, :3] = self.x_mm, math.nan, math.nan
            floats[slot, 8] = 1
            frames[slot] = frame
            self.ring.publish()
            self.count += 1

    def obey(self):
        for asked in self.view.take():
            self.asked.append(asked)
            match asked:
                case Point(x_mm=x_mm):
                    self.x_mm = x_mm
                    self.state = replace(self.state, held=True)
                case LetGo():
                    self.state = replace(self.state, held=False)
                case Turn(value=value):
                    knob = replace(self.state.knobs[0], value=value)
                    self.state = replace(self.state, knobs=[knob])
                case PagePress(command="LNDN"):
                    lines = [replace(one, under=one.number == 3) for one in LINES]
                    said = [*self.state.said, "line: 3"]
                    self.state = replace(self.state, lines=lines, said=said)
        self.view.tell(self.state)

    def _tick(self):
        while not self._stop.wait(0.01):
            self.obey()
            self.tick(10)

    def __enter__(self):
        self.tick()
        self.obey()
        self.view.__enter__()
        self.view.watch(self.ring.another())
        self._thread.start()
        return self

    def __exit__(self, *exception):
        self._stop.set()
        self._thread.join()
        self.view.__exit__(*exception)


def split(address):
    """Host, port and token of an address."""
    base, _, token = address.partition("#")
    host, _, port = base.removeprefix("http://").rstrip("/").rpartition(":")
    return host, int(port), token


class Client:
    """A page as a program; a context manager."""

    def __init__(self, address, *, origin="", token=None):
        self.name, self.port, self.token = split(address)
        self.token = self.token if token is None else token
        self._origin = f"http://{self.name}:{self.port}" if origin == "" else origin
        self.state = {}

    def __enter__(self):
        self._opening = connect(
            f"ws://{self.name}:{self.port}/live",
            origin=self._origin,
            compression=None,
        )
        self._socket = self._opening.__enter__()
        self.ask(ask="hello", token=self.token)
        self.welcome = self.hear()
        return self

    def __exit__(self, *exception):
        self._opening.__exit__(*exception)

    def ask(self, **request):
        self._socket.send(json.dumps(request))

    def hear(self):
        said = self._socket.recv(PATIENCE_S)
        return said if isinstance(said, bytes) else json.loads(said)

    def frame(self, **request):
        """The next frame's parts; a state that comes before it is kept."""
        self.ask(ask="next", **request)
        while not isinstance(said := self.hear(), bytes):
            assert said["tell"] == "state", said
            self.state = said
        return parts(said)

    def until(self, so):
        """Ask for frames until the header of one and the state are as wanted."""
        end_s = time.monotonic() + PATIENCE_S
        while not so((found := self.frame())[0], self.state):
            assert time.monotonic() < end_s, self.state
        return found


def get(address, path="/", method="GET", **headers):
    """Status, text and headers of an answer to a request for a file."""
    host, port, _ = split(address)
    asking = HTTPConnection(host, port, timeout=PATIENCE_S)
    asking.request(method, path, headers=headers)
    answer = asking.getresponse()
    body = answer.read().decode(errors="replace")
    asking.close()
    return answer.status, body, answer.headers


def launch(playwright):
    """Start Debian's Chromium; a test that needs it is skipped where it is not installed."""
    path = shutil.which("chromium")
    if path is None:
        pytest.skip("chromium is not installed; `make test` does that")
    return playwright.chromium.launch(
        executable_path=path, args=["--no-sandbox", "--disable-gpu", "--disable-extensions"]
    )


def until(page, expression):
    """Wait for something to be so; the page's own rules forbid Playwright's way of waiting."""
    for _ in range(int(PATIENCE_S / 0.02)):
        if value := page.evaluate(expression):
            return value
        page.wait_for_timeout(20)
    raise AssertionError(f"never: {expression}")


def comes(page, so):
    """Wait for something on the program's side, while the page goes on."""
    for _ in range(int(PATIENCE_S / 0.02)):
        if so():
            return
        page.wait_for_timeout(20)
    raise AssertionError("it never came")


def settled(page):
    """Wait until whatever is on its way is drawn, and told in words and numbers."""
    until(page, f"vbraille.told > {page.evaluate('vbraille.drawn')} + 3")
