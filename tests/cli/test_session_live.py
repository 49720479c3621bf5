"""``vbraille session run --monitor``: a live view of a session, as a browser has it."""

import os
import re
import signal
import socket
import subprocess
from contextlib import contextmanager

import msgspec
import numpy as np
import pytest
from websockets.sync.client import connect

from tests.cli import program
from tests.live.headers import FRAME
from tests.sessions.sittings import MINI, of
from tests.tiers import heavy
from vbraille.live.messages import (
    LetGo,
    Next,
    PageHello,
    PagePress,
    Point,
    Refused,
    Turn,
    ViewState,
    Welcome,
)
from vbraille.sessions.record.export import rows
from vbraille.sessions.record.folder import check, load

SEEING = MINI + "[session]\nblind = false\n"
HOW = ("--participant", "P07", "--seed", "1", "--hand", "sweep:150", "--cues", "none")


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
        self.ask(PageHello(token=token))
        self.welcome = msgspec.json.decode(self.socket.recv(program.PATIENCE_S), type=Welcome)

    def ask(self, request):
        self.socket.send(msgspec.json.encode(request).decode())

    def next(self):
        """The next frame: its header, and its deflections; states that come before are kept."""
        self.ask(Next())
        while isinstance(told := self.socket.recv(program.PATIENCE_S), str):
            self.state = msgspec.json.decode(told, type=ViewState)
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
    (run,) = of(record.journal.events, "run")
    assert run["monitor"] == {"blind": True, "host": "127.0.0.1", "pointer": True}
    assert [row["moved_by"] for row in rows(record)][:1] == ["simulated"]


@heavy
def test_unless_the_protocol_says_otherwise(tmp_path):
    with sat(tmp_path, SEEING) as sitting, opened(address_of(sitting)) as page:
        frames = page.until("trial 1 of 4: was read")
        read_all(sitting)
    shown = [frame for header, frame, _ in frames if header["line"] == 1]
    assert {frame.shape for frame in shown} == {(1, 12)}
    assert max(float(frame.max()) for frame in shown) > 0.5
    record = load(tmp_path / "s")
    masks = record.plan.trials[0].stimuli[0].masks
    (line,) = next(state.lines for state in page.states if state.lines)
    assert line.cells == list(record.protocol.line(masks))
    assert [one.text for one in check(record) if "live view" in one.text] == [
        "live view: run 1 was shown at 127.0.0.1, with its stimuli"
    ]


@heavy
def test_what_the_pointer_reads_is_marked(tmp_path, call):
    with sat(tmp_path) as sitting, opened(address_of(sitting)) as page:
        page.until("trial 1 of 4: is read")
        page.ask(Point(x_mm=40.0))
        sitting.until("^hand: moved in the live view")
        while not page.state.held:
            page.next()
        page.ask(LetGo())
        sitting.until("^hand: simulated again")
        read_all(sitting)
    record = load(tmp_path / "s")
    for kind in ("hand_taken", "hand_given_back"):
        assert [event["trial"] for event in of(record.journal.events, kind)] == [1]
    moved = [row["moved_by"] for row in rows(record)]
    assert moved == ["simulated:pointer", *["simulated"] * 3]
    assert all(finding.good for finding in check(record))
    said = call("analyse", tmp_path / "s", "--out", tmp_path / "report")
    assert said.code == 0
    assert (
        "The pointer of a live view was the hand in 1 trial of s: that is no data about people."
        in (tmp_path / "report" / "report.html").read_text()
    )


@heavy
def test_nothing_is_turned_or_pressed_at_the_page(tmp_path):
    with sat(tmp_path) as sitting, opened(address_of(sitting)) as page:
        page.until("trial 1 of 4")
        assert page.welcome.steers
        for request in (Turn("contrast", 0.5), PagePress("pause")):
            page.ask(request)
        while not any("refused: in a session" in one for one in page.state.said):
            page.next()
        assert not page.state.paused
        sitting.type("stop")
        sitting.until("^record:")
    kinds = {event.kind for event in load(tmp_path / "s").journal.events}
    assert not kinds & {"tuning", "pause"}


@heavy
def test_without_its_server_the_session_goes_on(tmp_path):
    with sat(tmp_path) as sitting:
        address_of(sitting)
        sitting.until("^cue: trial 1")
        os.kill(server_of(sitting.process.pid), signal.SIGKILL)
        sitting.until("^live view: ended by a fault")
        read_all(sitting)
    record = load(tmp_path / "s")
    assert all(finding.good for finding in check(record))
    assert [event["answer"] for event in of(record.journal.events, "answer")] == ["⠉"] * 4


def server_of(process):
    """The process of the server that a process has started."""
    listed = subprocess.run(
        ["ps", "-o", "pid=,args=", "--ppid", str(process)],
        capture_output=True, encoding="utf-8", check=True,
    )  # fmt: skip
    (line,) = [one for one in listed.stdout.splitlines() if "vbraille.live.serving" in one]
    return int(line.split()[0])


@heavy
def test_a_port_in_use_costs_the_view_alone(tmp_path):
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
        with sat(tmp_path, answers="simulated", more=("--port", port)) as sitting:
            said = sitting.until("^live view:")
            sitting.until("^end:")
    assert said == f"live view: port {port} is in use; give --port another, or leave it out"


@pytest.mark.parametrize(
    ("toml", "options", "says"),
    [
        (MINI, ("--monitor", "--fast"), "--monitor is for sessions that run by the clock; leave"),
        (MINI.replace('"vbd"', '"vbd"\nmedium = "paper"'), ("--monitor",), "is read on paper, and"),
        (MINI, ("--port", 80), "--port is for the live view; add --monitor, or leave --port out"),
        (MINI, ("--monitor", "--port", 70000), "--port is 70000; it must be 0 to 65535"),
    ],
    ids=["fast", "paper", "alone", "port"],
)
def test_a_session_that_cannot_be_watched_is_not_begun(call, tmp_path, toml, options, says):
    (tmp_path / "mini.toml").write_text(toml)
    answers = "simulated" if "paper" not in toml else "typed"
    said = call(
        "session", "run", tmp_path / "mini.toml", "--participant", "P07",
        "--answers", answers, "--out", tmp_path / "s", *options,
    )  # fmt: skip
    assert (said.code, said.out) == (2, "")
    assert says in said.err
    assert not (tmp_path / "s").exists()
