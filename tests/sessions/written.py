"""Sessions of every kind, which today's code writes once in a run of the tests.

They are small, and the same in every run but for times of day. No test may change one: a test that
would damage one or go on with it takes a copy.
"""

from functools import cache
from pathlib import Path
from tempfile import mkdtemp

from tests.sessions.sittings import COMPARED, MINI, Session, crash
from vbraille.engine.batch import BatchEngine
from vbraille.engine.host import HostDiedError

LETTERS = """
format = 1
name = "letters"
title = "Two letters at two levels of texture"
source = "ours"
model = "stress2"
[design]
kind = "list"
strings = ["ab", "cd"]
order = "listed"
[[conditions]]
name = "smooth"
texture = 0.0
[[conditions]]
name = "rough"
texture = 1.0
[practice]
trials = 1
strings = ["ef"]
"""
_DIES_AT = 1500  # number of ticks after which an engine is gone


class _Dying(BatchEngine):
    """Ends once as a host process does that was killed."""

    died = False

    def poll(self):
        if self.tally.ticks >= _DIES_AT and not self.died:
            self.died = True
            raise HostDiedError("the process that drives the device has ended (killed by signal 9)")
        return super().poll()


def _begun(name, toml=LETTERS):
    folder = Path(mkdtemp(prefix="vbraille-session-")) / name
    return Session(folder, toml, participant="P07", seed=42, hand="sweep:150")


def _torn(name):
    """Cut a session short in the line of its second answer."""
    session = _begun(name)
    session.sit()
    journal = session.folder / "journal.jsonl"
    lines = journal.read_bytes().splitlines(keepends=True)
    second = [n for n, line in enumerate(lines) if b'"event":"answer"' in line][1]
    crash(session.folder, sum(map(len, lines[:second])) + 60)
    return session


def _resumed(name):
    session = _torn(name)
    session.sit()
    return session


def _ended(name):
    session = _begun(name)
    session.sit(noise=0.2)
    return session


def _compared(name):
    session = _begun(name, COMPARED)
    session.sit()
    return session


def _host_died(name):
    session = _begun(name)
    session.sit(engine=_Dying)
    return session


def _stopped(name):
    session = _begun(name)
    session.sit(
        ("^ready: practice 1", "note the room is cold"),
        ("^read:", "ef"),
        ("^cue: trial 1", "note a car passed"),
        ("^note:", "pause"),
        ("^pause:", ""),
        ("^go:", "contrast 0.7"),
        ("^read:", "c d"),
        ("^cue: trial 2", "repeat"),
        ("^read:", "ab"),
        ("^answer: trial 2", "undo"),
        ("^undo:", "note the finger slipped"),
        ("^note:", "1-4 ?"),
        ("^answer: trial 2", "note in the break"),
        ("^note:", ""),
        ("^read:", "ab"),
        ("^cue: trial 4", "stop"),
    )
    return session


def _on_paper(name):
    session = _begun(name, MINI.replace('model = "vbd"', 'model = "vbd"\nmedium = "paper"'))
    session.sit(
        ("^ready: trial 1", ""),
        ("^cue:", ""),
        ("^read:", "a"),
        ("^ready: trial 2", "stop"),
    )
    return session


_MADE = {
    "ended": _ended,
    "resumed": _resumed,
    "torn": _torn,
    "stopped": _stopped,
    "host-died": _host_died,
    "compared": _compared,
    "on-paper": _on_paper,
}
SESSIONS = tuple(_MADE)
ON_DEVICE = tuple(name for name in SESSIONS if name != "on-paper")


@cache
def written(name):
    """Directory of one of `SESSIONS`, which no test may change."""
    return _MADE[name](name).folder
