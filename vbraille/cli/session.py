"""``vbraille session``: plan, run, resume, export and check legibility sessions."""

from __future__ import annotations

import secrets
import sys
from contextlib import suppress
from dataclasses import asdict
from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING, Self

from vbraille.cli.build import check_rate
from vbraille.cli.printable import printable
from vbraille.cli.stopping import EAR
from vbraille.cli.wanted import device_info, device_spec
from vbraille.devices import open_device
from vbraille.errors import InputError
from vbraille.sessions.answers import Script, Typed, parse_answers
from vbraille.sessions.plan import make_plan
from vbraille.sessions.progress import Progress
from vbraille.sessions.protocol import builtin_names, builtin_text, load_protocol
from vbraille.sessions.record import FORMAT, Record, create, load, versions

if TYPE_CHECKING:
    import argparse

    from vbraille.devices import DeviceInfo
    from vbraille.sessions.answers import Answers
    from vbraille.sessions.conduct import Field
    from vbraille.sessions.plan import Plan, Trial
    from vbraille.sessions.protocol import Protocol
    from vbraille.sessions.showing import RunEngine
    from vbraille.sessions.sounds import Sound

_MOST_DRAWN = 1_000_000  # a seed that is drawn is short enough to be written down


def run(arguments: argparse.Namespace) -> int:
    """Do what is asked of sessions."""
    return _ACTIONS[arguments.action](arguments)


def _protocols(arguments: argparse.Namespace) -> int:
    if arguments.name is not None:
        print(builtin_text(arguments.name), end="")
        return 0
    for name in builtin_names():
        protocol = load_protocol(name)
        _say(f"{name}: {protocol.title}; {protocol.trials} trials, {protocol.model.title}")
    return 0


def _plan(arguments: argparse.Namespace) -> int:
    protocol, plan = _planned(arguments)
    if arguments.brf:
        if protocol.task == "choice":
            raise InputError(f"{protocol.name} compares dots, which cannot be embossed")
        for trial in plan.trials:
            print(_cells(trial).to_brf())
        return 0
    _say(
        f"protocol: {protocol.name}, {len(plan.trials)} trials, "
        f"participant {plan.participant}, seed {plan.seed}"
    )
    block = None
    for trial in (*plan.practice, *plan.trials):
        if trial.block != block:
            block = trial.block
            _say(f"block: {block}" if block else "practice")
        _say(f"{'practice' if trial.practice else 'trial'} {trial.number}: {_describe(trial)}")
    return 0


def _run(arguments: argparse.Namespace) -> int:
    protocol, plan = _planned(arguments)
    sitting = _Sitting(arguments, protocol, plan, 0, check_rate(arguments.rate))
    answers = parse_answers(arguments.answers, protocol, plan.seed)
    sitting.check(answers)
    if isinstance(answers, Script):
        _check_script(answers, protocol, Progress(plan))
    fields = _ask_fields(protocol, arguments.field, answers)
    folder = Path(arguments.out or _new_name(plan))
    head = {
        "format": FORMAT,
        "protocol": protocol.name,
        "participant": plan.participant,
        "seed": plan.seed,
        "order": plan.order,
        "model": protocol.model.name,
        "array": asdict(protocol.model.array),
        "mapping": protocol.mapping.name,
        "geometry": asdict(protocol.geometry),
        "fields": fields,
        "device": arguments.device,
        "hand": arguments.hand,
        "answers": arguments.answers,
        "fast": arguments.fast,
        "rate_hz": arguments.rate,
        "versions": versions(),
    }
    with sitting:
        sitting.open()
        create(folder, protocol, plan, head)
        _say(f"session: {folder}")
        return sitting.run(load(folder), answers, why="start")


def _resume(arguments: argparse.Namespace) -> int:
    record = load(Path(arguments.folder))
    head = record.head
    for name in ("device", "hand", "answers"):
        if getattr(arguments, name) is None:
            setattr(arguments, name, head[name])
    arguments.fast |= head["fast"] and arguments.answers == head["answers"]
    progress = Progress(record.plan, record.told.events)
    if progress.ended:
        raise InputError(f"{record.folder} has ended; session export makes tables of it")
    sitting = _Sitting(arguments, record.protocol, record.plan, len(progress.runs), head["rate_hz"])
    answers = parse_answers(
        arguments.answers, record.protocol, record.plan.seed, progress.script_line
    )
    sitting.check(answers)
    if isinstance(answers, Script):
        _check_script(answers, record.protocol, progress)
    with sitting:
        return sitting.run(record, answers, why="resume")


def _export(arguments: argparse.Namespace) -> int:
    from vbraille.sessions import bids
    from vbraille.sessions.export import rows, to_csv, write_new

    record = load(Path(arguments.folder))
    if record.told.damage is not None:
        before = f"what the {len(record.told.events)} events before it tell is exported"
        print(f"{record.folder}: the journal is damaged, {before}", file=sys.stderr, flush=True)
    if arguments.bids:
        if arguments.out is None:
            raise InputError("--bids needs a directory; give one with --out")
        for path in bids.write(record, Path(arguments.out)):
            _say(f"written: {path}")
        return 0
    table = to_csv(rows(record))
    if arguments.out is None:
        sys.stdout.write(table)
    else:
        write_new(Path(arguments.out), table.encode())
        _say(f"written: {arguments.out}, {len(record.plan.trials)} rows")
    return 0


def _check(arguments: argparse.Namespace) -> int:
    from vbraille.sessions.check import check

    good = True
    for finding in check(load(Path(arguments.folder))):
        good &= finding.good
        _say(finding.text if finding.good else f"fault: {finding.text}")
    return 0 if good else 1


_ACTIONS = {
    "protocols": _protocols,
    "plan": _plan,
    "run": _run,
    "resume": _resume,
    "export": _export,
    "check": _check,
}


class _Sitting:
    """One run of a session: its engine, and what goes on around it. A context manager."""

    def __init__(
        self,
        arguments: argparse.Namespace,
        protocol: Protocol,
        plan: Plan,
        runs: int,
        rate_hz: float,
    ) -> None:
        self._arguments = arguments
        self._real = not arguments.fast
        self._engine: RunEngine | None = None
        self._opened = False
        # Another hand each time that the session is gone on with, and the same for the same seed.
        spec = device_spec(arguments.device, arguments.hand, plan.seed + runs)
        if arguments.fast and not spec.startswith("sim:"):
            raise InputError("--fast is for the simulated device; leave out --device")
        if protocol.medium == "device":
            wanted = device_info(protocol.model, protocol.geometry, rate_hz)
            self._engine = _build(spec, wanted, protocol, plan, fast=arguments.fast)

    def check(self, answers: Answers) -> None:
        """Raise InputError if these answers cannot be had in this way."""
        if self._arguments.fast and answers.typed:
            raise InputError("--fast is for answers that are not typed; give --answers simulated")

    def open(self) -> None:
        """Start the engine, unless it was."""
        if self._engine is not None and not self._opened:
            self._engine.start()
            self._opened = True

    def run(self, record: Record, answers: Answers, *, why: str) -> int:
        """Conduct the session until its end, or until it is stopped."""
        from vbraille.sessions.console import Console
        from vbraille.sessions.course import Course
        from vbraille.sessions.journal import Journal
        from vbraille.sessions.showing import OnDevice

        with Journal(record.folder) as journal:
            torn_bytes = journal.set_torn_aside()
            self.open()
            progress = Progress(record.plan, journal.told.events)
            display = None
            if self._engine is not None:
                display = OnDevice(self._engine, record.protocol, record.folder, keeps=answers.felt)
            sound = self._sound(answers)
            course = Course(
                record.protocol,
                record.plan,
                journal,
                progress,
                display,
                waits=answers.typed,
                corrects=not answers.felt,
                say=_say,
                play=sound.play,
                real=self._real,
            )
            told = {"why": why, "torn_bytes": torn_bytes, "sound": sound.name}
            if progress.runs:
                told["gap_s"] = _since(progress.wall)
                _say(f"resume: {progress.done} of {len(record.plan.trials)} trials have answers")
            if torn_bytes:
                _say(f"torn: {torn_bytes} bytes at the end of the journal are in journal.torn")
            if not answers.typed and not progress.begun:
                told["practice"] = "left out"
            try:
                arguments = self._arguments
                course.start(
                    **told,
                    spec=arguments.device,
                    hand=arguments.hand,
                    answers=arguments.answers,
                    clock="machine" if self._real else "manual",
                )
                if "practice" in told:
                    _say("practice: left out, since answers are not typed")
                    course.log("begin")
                Console(course, answers, say=_say, real=self._real).run()
            finally:
                EAR.close()  # so that the array goes to rest
                if display is not None:
                    display.close()
            if display is not None:
                counts = {name: count for name, count in display.engine.counts.items() if count}
                course.log("closed", lost=display.engine.lost, counts=counts)
        return 0

    def _sound(self, answers: Answers) -> Sound:
        from vbraille.sessions.sounds import Bell, Silence, Tones

        wanted = self._arguments.sound
        if wanted == "none" or (wanted == "auto" and not answers.typed):
            return Silence()
        if wanted != "bell":
            try:
                return Tones()
            except OSError as error:
                if wanted == "tones":
                    raise InputError(f"{error}; give --sound bell, or none") from None
            _say("sound: the terminal's bell, since there is no audio output")
        return Bell()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        if self._engine is not None:
            EAR.close()
            self._engine.close()


def _build(
    spec: str, wanted: DeviceInfo, protocol: Protocol, plan: Plan, *, fast: bool
) -> RunEngine:
    """The engine: in a process of its own, or on a clock turned by hand."""
    if fast:
        from vbraille.engine.batch import BatchEngine

        return BatchEngine(open_device(spec, wanted), wanted.rate_hz)
    from vbraille.engine.host import Host

    trials = (*plan.practice, *plan.trials)
    most = max(len(protocol.line(s.masks)) for trial in trials for s in trial.stimuli)
    return Host(spec, wanted, most)


def _planned(arguments: argparse.Namespace) -> tuple[Protocol, Plan]:
    protocol = load_protocol(arguments.protocol)
    seed = arguments.seed
    if seed is None:
        seed = secrets.randbelow(_MOST_DRAWN)
        print(f"seed: {seed}", file=sys.stderr, flush=True)
    plan = make_plan(
        protocol,
        arguments.participant,
        seed,
        arguments.order,
        texture=arguments.texture,
        contrast=arguments.contrast,
    )
    return protocol, plan


def _describe(trial: Trial) -> str:
    if len(trial.stimuli) == 2:
        return ", then ".join(f"{stimulus.value:g} mm" for stimulus in trial.stimuli)
    return f"{trial.condition}, {_cells(trial).to_unicode()}, dots {_cells(trial).to_dots()}"


def _cells(trial: Trial):
    import numpy as np

    from vbraille.translate.cells import Cells

    return Cells.bare(np.array(trial.stimuli[0].masks, np.uint8))


def _check_script(script: Script, protocol: Protocol, progress: Progress) -> None:
    """Raise InputError if a line of the file is no answer to its trial: nothing is begun then."""
    from vbraille.sessions.console import read_line
    from vbraille.sessions.orders import find_order

    trials = iter(progress.plan.trials[progress.done :])
    trial = progress.correcting or next(trials, None)
    for line, number in script.left:
        found = find_order(line)
        if found is not None and found[0].word == "undo" and trial is not None:
            continue
        if found is not None and found[0].word != "answer":
            continue
        if trial is None:
            raise InputError(f"{script.path} line {number}: there is no trial left to answer")
        try:
            read_line(protocol, trial, line if found is None else found[1])
        except ValueError as error:
            raise InputError(f"{script.path} line {number}: {error}") from None
        trial = next(trials, trial)


def _ask_fields(protocol: Protocol, given: dict[str, str], answers: Answers) -> dict[str, str]:
    """What the protocol asks about the participant: as given, else typed, else nothing."""
    names = [field.name for field in protocol.fields]
    for name in given:
        if name not in names:
            raise InputError(
                f"{protocol.name} does not ask for {name!r}; it asks for {', '.join(names)}"
            )
    told = {}
    for field in protocol.fields:
        if field.name in given:
            if field.choices and given[field.name] not in field.choices:
                raise InputError(
                    f"{field.name} is {given[field.name]!r}; it must be {_choices(field)}"
                )
            told[field.name] = given[field.name]
        else:
            told[field.name] = _ask(field, answers) if isinstance(answers, Typed) else ""
    return told


def _ask(field: Field, typed: Typed) -> str:
    choices = f" ({_choices(field)})" if field.choices else ""
    while True:
        _say(f"{field.ask}{choices}:")
        line = typed.line()
        if line is None:
            raise InputError(f"nobody said {field.name}; give --field {field.name}=…")
        text = line.strip()
        if not field.choices or not text or text in field.choices:
            return text


def _choices(field: Field) -> str:
    return " or ".join(field.choices)


def _new_name(plan: Plan) -> str:
    return f"{plan.participant}-{plan.protocol}-{datetime.now():%Y%m%d-%H%M%S}"


def _since(wall: str) -> float:
    """Seconds since a time of the journal; not below 0, should the clock have been set back."""
    before = datetime.fromisoformat(wall)
    return round(max((datetime.now(before.tzinfo) - before).total_seconds(), 0.0), 3)


def _say(sentence: str) -> None:
    with suppress(BrokenPipeError):  # a session does not end because nobody listens
        print(printable(sentence), flush=True)
