"""Sessions in this process, as fast as the machine can, with an experimenter of a few lines."""

import re
import struct
from dataclasses import dataclass, field
from pathlib import Path

from vbraille.devices import open_device
from vbraille.display import Display
from vbraille.engine.batch import BatchEngine
from vbraille.sessions.planning.plan import make_plan
from vbraille.sessions.planning.protocol import parse_protocol
from vbraille.sessions.record.events import to_json
from vbraille.sessions.record.folder import FORMAT, check_end, create, load, versions
from vbraille.sessions.record.journal import Journal
from vbraille.sessions.record.progress import Progress
from vbraille.sessions.running.answers import Simulated
from vbraille.sessions.running.console import Console
from vbraille.sessions.running.course import Course
from vbraille.sessions.running.showing import OnDevice
from vbraille.simulation.steering import Steering

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


@dataclass
class Person:
    """Types each line when what was said last matches its pattern."""

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


@dataclass
class Sat:
    """What came of a sitting."""

    said: list
    events: list
    played: list
    record: object
    progress: object
    course: object


class Session:
    """A session on the disk, sat at once or several times."""

    def __init__(
        self, folder: Path, toml: str = MINI, participant="P1", seed=1, hand="sweep:150",
        procedure=None,
    ):  # fmt: skip
        self.folder = folder
        self.protocol = parse_protocol(toml, "test")
        self.plan = make_plan(self.protocol, participant, seed)
        self.hand = hand
        self.procedure = procedure
        head = {
            "format": FORMAT, "protocol": self.protocol.name, "participant": participant,
            "seed": seed, "order": self.plan.order, "model": self.protocol.model.name,
            "fields": {}, "rate_hz": 1000.0, "answers": "typed", "fast": True,
            "hand": hand, "device": "sim", "versions": versions(),
        }  # fmt: skip
        create(folder, self.protocol, self.plan, head)

    def person(self, *script):
        """A person who types these lines."""
        return Person(list(script))

    def sit(self, *script, engine=BatchEngine, noise=0.0):
        """Run it: by a person, or one who types these lines, else by a simulated reader."""
        given = bool(script) and hasattr(script[0], "next")
        person = script[0] if given else self.person(*script)
        said, played = person.said, []
        answers = person if script else Simulated(self.protocol, self.plan, noise)
        model, display = self.protocol.model, None
        if self.protocol.medium == "device":
            array = model.display
            info = Display(
                "test", array.rows, array.columns, array.column_pitch_mm, array.row_pitch_mm,
                1024, model.display.rest_side, 300.0, 200.0, 1000.0,
            )  # fmt: skip
            steering = Steering()
            spec = f"sim:?hand={self.hand}&seed=1&steering={steering.descriptor}"
            engine = engine(open_device(spec, info), poll_ticks=100)
            engine.start()
            display = OnDevice(
                engine, self.protocol, self.folder, keeps=not script, steering=steering,
                tie=lambda: journal.durable,
            )  # fmt: skip
        record = load(self.folder)
        with Journal(self.folder) as journal:
            check_end(self.folder, journal.told)
            torn = journal.set_torn_aside()
            progress = Progress(self.plan, journal.told.events, self.procedure)
            course = Course(
                self.protocol, self.plan, journal, progress, display, waits=answers.typed,
                corrects=answers.typed, say=said.append, play=played.append,
                real=display is None,
            )  # fmt: skip
            try:
                source = "typed" if script else f"simulated:{noise:g}"
                course.start(why="test", torn_bytes=torn, answers=source)
                Console(course, answers, say=said.append, real=False).run()
            finally:
                if display is not None:
                    display.close()
        record = load(self.folder)
        progress = Progress(self.plan, record.told.events, self.procedure)
        return Sat(said, record.told.events, played, record, progress, course)


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


def of(events, name):
    """Events of a kind, as the journal has them."""
    return [to_json(event) for event in events if event.kind == name]
