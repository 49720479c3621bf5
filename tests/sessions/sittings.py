"""Sessions in this process, as fast as the machine can, with an experimenter of a few lines."""

import re
import struct
from copy import copy
from dataclasses import dataclass, field
from pathlib import Path
from shutil import copytree

from vbraille.devices import open_device
from vbraille.engine.batch import BatchEngine
from vbraille.sessions import session as door
from vbraille.sessions.conditions import Conditions
from vbraille.sessions.planning.making import make_plan
from vbraille.sessions.planning.protocolfiles import parse_protocol
from vbraille.sessions.record import events as kinds
from vbraille.sessions.record.events import to_json
from vbraille.sessions.record.folder import create, load
from vbraille.sessions.record.progress import Progress
from vbraille.sessions.session import head_of

MINI = """
format = 1
name = "mini"
title = "Four characters between delimiters"
source = "ours"
model = "vbd"
[keys]
l = "1"
[design]
kind = "combinations"
characters = ["a", "c", "4", "0"]
length = 1
before = "c"
after = "c"
"""
COMPARED = """
format = 1
name = "widths"
title = "Two widths"
source = "ours"
model = "vbd"
[design]
kind = "choice"
parameter = "dot_width_mm"
values = [1.0, 2.0]
string = "a"
"""


ANSWERING = kinds.Answer | kinds.Missed | kinds.Reply  # events that are no more asked for


@dataclass
class Person:
    """Types each line when what was said last matches its pattern."""

    name = "typed"
    script: list
    typed: bool = True
    felt: bool = False
    said: list = field(default_factory=list)
    seen: int = 0
    waited: int = 0

    def lines(self, _wait_s):
        if not self.script:
            return None
        pattern, line = self.script[0]
        new = self.said[self.seen :]
        for n, sentence in enumerate(new, self.seen):
            if re.search(pattern, sentence):
                self.seen = n + 1
                self.script.pop(0)
                return [line]
        self.waited += 1
        assert self.waited < 5000, f"{pattern!r} is never said: {self.said[-20:]}"
        return []

    def next(self, *_):
        return None

    def reply(self, *_):
        return None


class Played:
    """Keeps the participant's signals."""

    name = "none"

    def __init__(self):
        self.tones = []

    def play(self, tone):
        self.tones.append(tone)


@dataclass
class Sat:
    """What came of a sitting."""

    said: list
    events: list
    played: list
    record: object
    progress: object  # as its journal has it
    live: object  # as it was when the sitting ended


class Session:
    """A session on the disk, sat at once or several times."""

    def __init__(self, folder: Path, toml: str = MINI, participant="P1", seed=1, hand="sweep:150"):
        self.folder = folder
        self.protocol = parse_protocol(toml, "test")
        self.plan = make_plan(self.protocol, participant, seed)
        conditions = Conditions(hand=hand, fast=True)
        create(folder, self.protocol, self.plan, head_of(self.protocol, self.plan, {}, conditions))

    def person(self, *script):
        """A person who types these lines."""
        return Person(list(script))

    def sit(self, *script, engine=BatchEngine, noise=0.0, view=None):
        """Run it: by a person, or one who types these lines, else by a simulated reader."""
        person = script[0] if script and isinstance(script[0], Person) else self.person(*script)
        said, played = person.said, Played()
        session = door.Session.resume(
            self.folder,
            fast=True,
            engine=lambda spec, wanted: engine(open_device(spec, wanted), poll_ticks=100),
        )
        answers = person if script else f"simulated:{noise:g}"
        session.run(answers, say=said.append, sound=played, view=view)
        record = session.record
        progress = Progress(self.plan, record.journal.events, record.procedure)
        return Sat(said, record.journal.events, played.tones, record, progress, session.progress)


def crash(folder, size):
    """Cut a session's journal, and what of its traces was written after the lines that are gone.

    As a crash of the machine leaves it: what is on the disk was not written before its time.
    """
    path = folder / "journal.jsonl"
    kept = path.read_bytes()[:size]
    path.write_bytes(kept)
    for trace in folder.glob("trace-*.gz"):
        content, end = trace.read_bytes(), 0
        while end < len(content):
            length, _, _, _, number = struct.unpack_from("<II2sHI", content, end + 16)
            if number > kept.count(b"\n"):
                break
            end += length
        trace.write_bytes(content[:end])


def gone_on(session, folder, size, *script, **given):
    """Resume a copy of a session whose journal was cut, as by a kill, and give what comes of it.

    Also gives the number of its trials and questions that had an answer before.
    """
    copytree(session.folder, folder)
    crash(folder, size)
    other = copy(session)
    other.folder = folder
    kept = [e for e in load(folder).journal.events if isinstance(e, ANSWERING)]
    sat = other.sit(*script, **given)
    assert [e for e in sat.events if isinstance(e, ANSWERING)][: len(kept)] == kept
    return sat, len(kept)


def kill_often(session, folder, *script, cuts=5, **given):
    """Cut a session's journal at many places; each time none is lost, and none asked for again."""
    journal = (session.folder / "journal.jsonl").read_bytes()
    whole = journal.find(b"\n") + 1
    for n in range(cuts):
        size = whole + (len(journal) - whole) * (2 * n + 1) // (2 * cuts)
        sat, _ = gone_on(session, folder / f"{n}", size, *script, **given)
        assert sat.progress.ended
        answers = [e for e in sat.events if isinstance(e, ANSWERING)]
        asked = [
            (e.kind, e.trial, e.practice, getattr(e, "name", ""), getattr(e, "block", 0))
            for e in answers
        ]
        assert len(set(asked)) == len(asked)


def of(events, name):
    """Events of a kind, as the journal has them."""
    return [to_json(event) for event in events if event.kind == name]
