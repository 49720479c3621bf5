"""``vbraille session``: plan, run, resume, export and check legibility sessions."""

from __future__ import annotations

import sys
from contextlib import ExitStack, closing, contextmanager, suppress
from dataclasses import asdict
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from vbraille.cli.old.terminal import print_json, say_line
from vbraille.errors import InputError
from vbraille.sessions.planning.protocolfiles import builtin_names, builtin_text, load_protocol
from vbraille.sessions.planning.stimuli import said_value
from vbraille.sessions.record.folder import nearly_same
from vbraille.sessions.running.responses import Typed, takes_lines
from vbraille.signals import EAR
from vbraille.simulation.specs import refuse_hand
from vbraille.wording import spelled

if TYPE_CHECKING:
    import argparse
    from collections.abc import Callable, Iterator

    from vbraille.cli.old.reading.speech import Speech
    from vbraille.sessions.planning.pace import ParticipantField
    from vbraille.sessions.planning.protocol import Protocol
    from vbraille.sessions.planning.stimuli import Trial
    from vbraille.sessions.running.responses import Responses
    from vbraille.sessions.session import Session


def run(arguments: argparse.Namespace) -> int:
    """Do what is asked of sessions."""
    return _ACTIONS[arguments.action](arguments)


def _protocols(arguments: argparse.Namespace) -> int:
    if arguments.name is not None:
        print(builtin_text(arguments.name), end="")
        return 0
    protocols = {name: load_protocol(name) for name in builtin_names()}
    if arguments.json:
        print_json(
            [
                {
                    "name": name,
                    "title": each.title,
                    "adaptive": each.adaptive,
                    "trials": each.trials,
                    "display": each.model.title,
                }
                for name, each in protocols.items()
            ]
        )
        return 0
    for name, protocol in protocols.items():
        most = "at most " if protocol.adaptive else ""
        _say(f"{name}: {protocol.title}; {most}{protocol.trials} trials, {protocol.model.title}")
    return 0


def _plan(arguments: argparse.Namespace) -> int:
    from vbraille.sessions.session import plan_session

    protocol, plan = plan_session(arguments.protocol, arguments.participant, **_chances(arguments))
    if arguments.brf and protocol.task == "choice":
        raise InputError(f"{protocol.name} compares dots, which cannot be embossed")
    if arguments.brf and protocol.pictures:
        raise InputError(f"{protocol.name} shows pictures, which are no braille; leave --brf out")
    if arguments.seed is None:
        say_line(f"seed: {plan.seed}", aside=True)
    if arguments.json:
        print(plan.to_json(), end="")
        return 0
    if arguments.brf:
        for trial in plan.trials:
            print(_cells(trial).to_brf())
        return 0
    _say(
        f"protocol: {protocol.name}, {len(plan.trials)} trials, "
        f"participant {plan.participant}, seed {plan.seed}"
    )
    if plan.group:
        _say(f"group: {plan.group}")
    from vbraille.forecast.pilots import expected_minutes

    minutes = expected_minutes(protocol, plan)
    _say(f"analysis: {protocol.planned_analysis.described()}")
    _say(f"length: some {minutes:.0f} minutes, if people read as those of the source")
    if protocol.adaptive:
        from vbraille.sessions.planning.nexttrial import describe

        _say(f"procedure: {describe(protocol)}")
    block = None
    for trial in (*plan.practice, *plan.trials):
        if trial.block != block:
            block = trial.block
            _say(f"block: {block}" if block else "practice")
        which = "practice" if trial.practice else "trial"
        _say(f"{which} {trial.number}: {_describe(protocol, trial)}")
    return 0


def _run(arguments: argparse.Namespace) -> int:
    from vbraille.sessions.conditions import Conditions
    from vbraille.sessions.session import Session

    refuse_hand(arguments.device, hand=arguments.hand)
    session = Session.create(
        arguments.protocol,
        arguments.participant,
        folder=arguments.out,
        **_chances(arguments),
        fields=arguments.field,
        conditions=Conditions(rate_hz=arguments.rate, fast=arguments.fast, **_chosen(arguments)),
        begun=arguments.begun,
    )
    with _taken(session.answers(), speech=arguments.speech) as (answers, say):
        if not arguments.another:
            _ask_who(session.folder.absolute().parent, session.plan.participant, answers, say)
        if isinstance(answers, Typed):
            session.tell(_ask_fields(session.protocol, arguments.field, answers, say))
        return _conduct(session, answers, say)


def _resume(arguments: argparse.Namespace) -> int:
    from vbraille.sessions.session import Session

    fast = {"fast": True} if arguments.fast else {}
    session = Session.resume(arguments.folder, begun=arguments.begun, **fast, **_chosen(arguments))
    with _taken(session.answers(), speech=arguments.speech) as (answers, say):
        return _conduct(session, answers, say)


@contextmanager
def _taken(
    answers: Responses, *, speech: bool
) -> Iterator[tuple[Responses, Callable[[str], None]]]:
    """Have lines that are typed at a terminal edited there; give who answers, and who speaks."""
    say = _say
    with ExitStack() as stack:
        if speech:
            from vbraille.cli.old.reading.speech import Speech

            say = partial(_say_aloud, stack.enter_context(closing(Speech())))
        if isinstance(answers, Typed) and sys.stdin and takes_lines(sys.stdin.fileno()):
            from vbraille.cli.old.typedlines import EditedLines

            lines = EditedLines(say)
            lines.take()
            stack.callback(lines.release)
            answers, say = lines, lines.say
        yield answers, say


def _conduct(session: Session, answers: Responses, say: Callable[[str], None]) -> int:
    session.run(answers, say=say, warn=partial(say_line, aside=True), before_rest=EAR.close)
    return 0


def _chosen(arguments: argparse.Namespace) -> dict[str, Any]:
    """Conditions of a session that were given as options."""
    from vbraille.sessions.conditions import LiveAddress

    names = ("device", "hand", "answers", "markers", "also")
    given = {name: getattr(arguments, name) for name in names}
    given["sound"] = arguments.cues
    given["live"] = LiveAddress(arguments.host, arguments.port) if arguments.monitor else None
    return {name: value for name, value in given.items() if value is not None}


def _chances(arguments: argparse.Namespace) -> dict[str, Any]:
    """Seed of a plan, and the values in place of the display's own tuning."""
    return {
        name: getattr(arguments, name) for name in ("seed", "order", "group", "texture", "contrast")
    }


def _export(arguments: argparse.Namespace) -> int:
    from vbraille.cli.old.exporting import export

    return export(arguments, _say)


def _methods(arguments: argparse.Namespace) -> int:
    from vbraille.analysis.input.study import load_study
    from vbraille.analysis.methods import methods

    paths = [Path(name) for name in arguments.paths]
    told = methods(load_study(paths, exclude=arguments.exclude))
    if not told:
        raise InputError("tables do not tell what was done; give directories of sessions")
    _say(told)
    return 0


def _check(arguments: argparse.Namespace) -> int:
    from vbraille.sessions.record.folder import check_folder

    findings = check_folder(Path(arguments.folder), arguments.expect)
    if arguments.json:
        found = [asdict(finding) for finding in findings]
        good = all(each["good"] for each in found)
        print_json({"good": good, "findings": found})
        return 0 if good else 1
    good = True
    for finding in findings:
        good &= finding.good
        _say(finding.text if finding.good else f"fault: {finding.text}")
    return 0 if good else 1


def _pilot(arguments: argparse.Namespace) -> int:
    from vbraille.cli.old.terminal import WorkProgress
    from vbraille.forecast.pilots import MARK, pilot
    from vbraille.forecast.workers import Workers
    from vbraille.sessions.running.reader import ReaderHabits

    protocol = load_protocol(arguments.protocol)
    folder = Path(arguments.out or f"pilot-{protocol.name}")
    workers = Workers(arguments.workers)
    progress = WorkProgress(verbose=arguments.verbose)
    report = pilot(
        protocol,
        arguments.participants,
        folder,
        workers,
        habits=ReaderHabits(arguments.noise, arguments.lapses, arguments.false_alarms),
        seed=arguments.seed,
        report=progress.of,
    )
    _say(f"pilot: {arguments.participants} sessions of {protocol.name}; {MARK}")
    _say(f"written: {report / 'report.html'}")
    return 0


def _withdraw(arguments: argparse.Namespace) -> int:
    from vbraille.sessions.record.withdrawal import withdrawal

    rooms = [Path(name) for name in arguments.paths or ["."]]
    told = withdrawal(rooms, arguments.participant)
    left = [f"left: {path} names {told.participant}; look at it yourself" for path in told.left]
    if not told.found:
        for sentence in left:
            _say(sentence)
        names = ", ".join(map(str, rooms))
        raise InputError(f"there is nothing of {arguments.participant} to remove in {names}")
    if not arguments.yes:
        for sentence in told.sentences():
            _say(f"found: {sentence}")
        _say(f"remove all of {arguments.participant} for good? (yes or no):")
        if (Typed().line() or "").strip().lower() not in ("y", "yes"):
            raise InputError("nothing was removed; answer yes, or give --yes")
    told.remove()
    for sentence in [*(f"removed: {each}" for each in told.sentences()), *left]:
        _say(sentence)
    return 1 if left else 0


_ACTIONS = {
    "withdraw": _withdraw,
    "pilot": _pilot,
    "protocols": _protocols,
    "plan": _plan,
    "run": _run,
    "resume": _resume,
    "export": _export,
    "methods": _methods,
    "check": _check,
}


def _describe(protocol: Protocol, trial: Trial) -> str:
    if protocol.parameter is not None:
        if protocol.adaptive and not trial.practice:
            shown = [stimulus.value or 0.0 for stimulus in trial.stimuli]
            if (standard := protocol.standard) is not None:
                words = ["the standard" if value == standard else "a value" for value in shown]
                return f"{trial.condition}, {', then '.join(words)}"
            lower = shown[0] < shown[1]
            return f"{trial.condition}, the {'lower' if lower else 'higher'} value first"
        values = [stimulus.value or 0.0 for stimulus in trial.stimuli]
        return ", then ".join(said_value(value, protocol.parameter) for value in values)
    stimulus = trial.stimuli[0]
    if stimulus.picture is not None:
        return f"{trial.condition}, {stimulus.picture}"
    text = stimulus.text
    written = "" if text is None else f"{text}, "
    cells = f"{_cells(trial).to_unicode()}, dots {_cells(trial).to_dots()}"
    return f"{trial.condition}, {written}{cells}"


def _cells(trial: Trial):
    import numpy as np

    from vbraille.braille.cells import Cells

    return Cells.bare(np.array(trial.stimuli[0].masks, np.uint8))


def _ask_who(room: Path, participant: str, answers: Responses, say: Callable[[str], None]) -> None:
    """Ask whether a new participant is one whose pseudonym is nearly the same.

    Raises
    ------
    InputError
        If the participant is one of those, or no experimenter is there to be asked.
    """
    found = nearly_same(room, participant)
    if found is None:
        return
    near, session = found
    told = f"{participant} is new here, and {near} has the session {session}"
    if isinstance(answers, Typed) and sys.stdin.isatty():
        say(f"participant: {told}; is {participant} another person? (yes or no):")
        while (line := answers.line()) is not None:
            if line.strip().lower() in ("y", "yes"):
                return
            if line.strip().lower() in ("n", "no"):
                break
            say("type yes or no:")
        raise InputError(f"nothing was begun; give --participant {near}")
    raise InputError(
        f"{told}; give --participant {near}, or --another if {participant} is another person"
    )


def _ask_fields(
    protocol: Protocol, given: dict[str, str], typed: Typed, say: Callable[[str], None]
) -> dict[str, str]:
    """Responses to what the protocol asks about the participant: as given, otherwise as typed."""
    return {
        field.name: given[field.name] if field.name in given else _ask(field, typed, say)
        for field in protocol.fields
    }


def _ask(field: ParticipantField, typed: Typed, say: Callable[[str], None]) -> str:
    choices = f" ({' or '.join(field.choices)})" if field.choices else ""
    while True:
        say(f"{field.ask}{choices}:")
        line = typed.line()
        if line is None:
            raise InputError(f"{field.name} was not answered; give --field {field.name}=…")
        text = line.strip()
        if not field.choices or text in field.choices:
            return text


def _say(sentence: str) -> None:
    with suppress(BrokenPipeError):  # a session does not end because its output is closed
        say_line(spelled(sentence))


def _say_aloud(speech: Speech, sentence: str) -> None:
    _say(sentence)
    speech.say(spelled(sentence))
