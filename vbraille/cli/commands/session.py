"""``vbraille session``: plan, run, resume, export and check legibility sessions."""

from __future__ import annotations

import secrets
import sys
from contextlib import suppress
from dataclasses import asdict
from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING

from vbraille.cli.wanted import check_rate, refuse_hand
from vbraille.errors import InputError, VbrailleError
from vbraille.files import check_free, write_file
from vbraille.sessions.planning.plan import make_plan
from vbraille.sessions.planning.protocol import builtin_names, builtin_text, load_protocol
from vbraille.sessions.record import journal
from vbraille.sessions.record.folder import FORMAT, create, load, versions
from vbraille.sessions.record.participants import alike, participants_in
from vbraille.sessions.record.progress import Progress
from vbraille.sessions.running.answers import ScriptedAnswers, Typed, parse_answers
from vbraille.wording import printable, spelled

if TYPE_CHECKING:
    import argparse

    from vbraille.sessions.planning.conduct import Question
    from vbraille.sessions.planning.plan import Plan, Trial
    from vbraille.sessions.planning.protocol import Protocol
    from vbraille.sessions.running.answers import Answers

_HAND = "device"  # of the simulated device, unless told otherwise
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
    if arguments.brf and protocol.task == "choice":
        raise InputError(f"{protocol.name} compares dots, which cannot be embossed")
    _say_seed(arguments, plan)
    if arguments.brf:
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
    from vbraille.cli.sitting import Sitting

    refuse_hand(arguments.device, hand=arguments.hand)
    if arguments.hand is None:
        arguments.hand = _HAND
    protocol, plan = _planned(arguments)
    sitting = Sitting(arguments, protocol, plan, 0, check_rate(arguments.rate), say=_say)
    answers = parse_answers(arguments.answers, protocol, plan)
    sitting.check(answers)
    if isinstance(answers, ScriptedAnswers):
        _check_script(answers, protocol, Progress(plan))
    folder = Path(arguments.out or _new_name(plan))
    check_free(folder)
    if not arguments.another:
        _ask_who(folder.absolute().parent, plan.participant, answers)
    fields = _ask_fields(protocol, arguments.field, answers)
    head = {
        "format": FORMAT,
        "protocol": protocol.name,
        "participant": plan.participant,
        "seed": plan.seed,
        "order": plan.order,
        "model": protocol.model.name,
        "array": {
            name: getattr(protocol.model.display, name)
            for name in ("rows", "columns", "column_pitch_mm", "row_pitch_mm")
        },
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
        _say_seed(arguments, plan)
        _say(f"session: {folder}")
        return sitting.run(load(folder), answers, why="start")


def _resume(arguments: argparse.Namespace) -> int:
    from vbraille.cli.sitting import Sitting

    record = load(Path(arguments.folder))
    if record.told.damage is not None:
        raise VbrailleError(
            f"{record.folder} is damaged: of {journal.NAME} {record.told.damage}; the "
            f"{len(record.told.events)} events before it are whole, and nothing was changed"
        )
    head = record.head
    refuse_hand(arguments.device or head["device"], hand=arguments.hand)
    for name in ("device", "hand", "answers"):
        if getattr(arguments, name) is None:
            setattr(arguments, name, head[name])
    arguments.fast |= head["fast"] and arguments.answers == head["answers"]
    progress = Progress(record.plan, record.told.events)
    if progress.ended:
        raise InputError(f"{record.folder} has ended; session export makes tables of it")
    sitting = Sitting(
        arguments, record.protocol, record.plan, len(progress.runs), head["rate_hz"], say=_say
    )
    used = progress.script_lines.get(arguments.answers, 0)
    answers = parse_answers(arguments.answers, record.protocol, record.plan, used)
    sitting.check(answers)
    if isinstance(answers, ScriptedAnswers):
        _check_script(answers, record.protocol, progress)
    with sitting:
        return sitting.run(record, answers, why="resume")


def _export(arguments: argparse.Namespace) -> int:
    from vbraille.sessions.record.anonymous import anonymous
    from vbraille.sessions.record.export import Traces, encode, rows, to_csv
    from vbraille.sessions.record.folder import whole_lines
    from vbraille.sessions.record.notes import read_notes

    if arguments.bids and not arguments.out:
        raise InputError("--bids needs a directory; give one with --out")
    record = load(Path(arguments.folder), salvaged=arguments.salvage)
    traces = Traces(record, salvaged=arguments.salvage)
    if arguments.bids:
        from vbraille.sessions.record.dataset import write

        written = write(record, Path(arguments.out), traces, without_times=arguments.anonymous)
        for path in written:
            _say(f"written: {path}")
    else:
        exported = rows(record, traces)
        table = to_csv(anonymous(record, exported) if arguments.anonymous else exported)
        if arguments.out is None:
            sys.stdout.write(table)
        else:
            write_file(Path(arguments.out), encode(table))
            _say(f"written: {arguments.out}, {len(record.plan.trials)} rows")
    # Where the table is printed, nothing else may be between it and who reads it.
    if arguments.anonymous and (notes := len(read_notes(record.told.events))):
        what = "1 note" if notes == 1 else f"{notes} notes"
        print(f"left out: {what}, since nobody knows what is in them", file=sys.stderr)
    told = sys.stdout if arguments.out else sys.stderr
    print(f"record: {journal.sum_of(whole_lines(record.folder))}", file=told, flush=True)
    faults = list(traces.faults)
    if record.told.bad:
        faults.append(f"of {journal.NAME}, {_lines(record.told.bad)}")
    elif record.told.damage is not None:
        faults.append(f"{journal.NAME} is damaged, {record.told.damage}")
    if faults:
        raise VbrailleError(f"exported is what is whole; {'; '.join(faults)}")
    return 0


def _lines(bad: tuple[int, ...]) -> str:
    """Say which lines of a journal are not whole."""
    from vbraille.sessions.record.export import spans

    one = len(bad) == 1
    return f"{'line' if one else 'lines'} {spans(bad)} {'is' if one else 'are'} not whole"


def _check(arguments: argparse.Namespace) -> int:
    from vbraille.sessions.record.check import check_folder

    good = True
    for finding in check_folder(Path(arguments.folder), arguments.expect):
        good &= finding.good
        text = spelled(finding.text)
        _say(text if finding.good else f"fault: {text}")
    return 0 if good else 1


_ACTIONS = {
    "protocols": _protocols,
    "plan": _plan,
    "run": _run,
    "resume": _resume,
    "export": _export,
    "check": _check,
}


def _planned(arguments: argparse.Namespace) -> tuple[Protocol, Plan]:
    protocol = load_protocol(arguments.protocol)
    seed = arguments.seed
    if seed is None:
        seed = secrets.randbelow(_MOST_DRAWN)
    plan = make_plan(
        protocol,
        arguments.participant,
        seed,
        arguments.order,
        texture=arguments.texture,
        contrast=arguments.contrast,
    )
    return protocol, plan


def _say_seed(arguments: argparse.Namespace, plan: Plan) -> None:
    """Say the seed, if it was drawn."""
    if arguments.seed is None:
        print(f"seed: {plan.seed}", file=sys.stderr, flush=True)


def _describe(trial: Trial) -> str:
    if len(trial.stimuli) == 2:
        return ", then ".join(f"{stimulus.value:g} mm" for stimulus in trial.stimuli)
    return f"{trial.condition}, {_cells(trial).to_unicode()}, dots {_cells(trial).to_dots()}"


def _cells(trial: Trial):
    import numpy as np

    from vbraille.braille.cells import Cells

    return Cells.bare(np.array(trial.stimuli[0].masks, np.uint8))


def _check_script(script: ScriptedAnswers, protocol: Protocol, progress: Progress) -> None:
    """Raise InputError if a line of the file is no answer to its trial: nothing is begun then."""
    from vbraille.sessions.running.console import read_line
    from vbraille.sessions.running.orders import find_order

    trials = iter(progress.plan.trials[progress.done :])
    correcting, answered = progress.correcting, progress.last_answered
    for line, number in script.left:
        found = find_order(line)
        if found is not None and found[0].word == "undo":
            correcting = correcting or answered
        if found is not None and found[0].word != "answer":
            continue
        trial = correcting or next(trials, None)
        if trial is None:
            raise InputError(f"{script.path} line {number}: there is no trial left to answer")
        try:
            read_line(protocol, trial, line if found is None else found[1])
        except ValueError as error:
            raise InputError(f"{script.path} line {number}: {error}") from None
        correcting, answered = None, trial if correcting is None else answered


def _ask_who(room: Path, participant: str, answers: Answers) -> None:
    """Ask whether a new participant is one whose pseudonym is nearly the same.

    Raises
    ------
    InputError
        If it is, or nobody is there who could be asked.
    """
    known = participants_in(room)
    if participant in known:
        return
    near = next((other for other in known if alike(other, participant)), None)
    if near is None:
        return
    told = f"{participant} is new here, and {near} has the session {known[near]}"
    if isinstance(answers, Typed) and sys.stdin.isatty():
        _say(f"participant: {told}; is {participant} somebody else? (yes or no):")
        while (line := answers.line()) is not None:
            if line.strip().lower() in ("y", "yes"):
                return
            if line.strip().lower() in ("n", "no"):
                break
            _say("type yes or no:")
        raise InputError(f"nothing was begun; give --participant {near}")
    raise InputError(
        f"{told}; give --participant {near}, or --another if {participant} is somebody else"
    )


def _ask_fields(protocol: Protocol, given: dict[str, str], answers: Answers) -> dict[str, str]:
    """What the protocol asks about the participant: as given, else typed, else nothing."""
    names = [field.name for field in protocol.fields]
    for name in given:
        if name not in names:
            raise InputError(
                f"{protocol.name} does not ask for {name!r}; "
                f"it asks for {', '.join(names) or 'nothing'}"
            )
    told = {}
    for field in protocol.fields:
        if field.name in given:
            if field.choices and given[field.name] not in field.choices:
                raise InputError(
                    f"{field.name} is {given[field.name]!r}; it must be {_choices(field)}"
                )
            if not given[field.name].isprintable():
                raise InputError(
                    f"{field.name} is {given[field.name]!r}; it must be one line of text"
                )
            told[field.name] = given[field.name]
        else:
            told[field.name] = _ask(field, answers) if isinstance(answers, Typed) else ""
    return told


def _ask(field: Question, typed: Typed) -> str:
    choices = f" ({_choices(field)})" if field.choices else ""
    while True:
        _say(f"{field.ask}{choices}:")
        line = typed.line()
        if line is None:
            raise InputError(f"nobody said {field.name}; give --field {field.name}=…")
        text = line.strip()
        if not field.choices or not text or text in field.choices:
            return text


def _choices(field: Question) -> str:
    return " or ".join(field.choices)


def _new_name(plan: Plan) -> str:
    return f"{plan.participant}-{plan.protocol}-{datetime.now():%Y%m%d-%H%M%S}"


def _say(sentence: str) -> None:
    with suppress(BrokenPipeError):  # a session does not end because nobody listens
        print(printable(sentence), flush=True)
