"""Pilots: a protocol's sessions with the simulated reader, and their report, all so marked."""

from __future__ import annotations

import csv
import io
import json
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from vbraille.errors import InputError, VbrailleError
from vbraille.files import check_free, write_file
from vbraille.forecast.workers import KeptResults, work_on
from vbraille.sessions.conditions import Conditions
from vbraille.sessions.planning.protocolfiles import parse_protocol
from vbraille.sessions.record.folder import load
from vbraille.sessions.session import Session
from vbraille.wording import setting

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from vbraille.analysis.results import Results, ResultTable
    from vbraille.forecast.workers import Workers
    from vbraille.sessions.planning.plan import Plan
    from vbraille.sessions.planning.protocol import Protocol
    from vbraille.sessions.running.reader import ReaderHabits

MARK = "simulated reader, no data about people"
MOST_PILOTS = 500
ABOUT, REPORT = "pilot.json", "report"
_TOLD = (
    "A simulated reader answered in all sessions here. Nothing in this directory is data about "
    "people.\n"
)


@dataclass(frozen=True, slots=True)
class PilotTask:
    """A session of one simulated participant.

    Parameters
    ----------
    text, where
        The protocol's file: its content, and what messages call it.
    participant
        Pseudonym, which tells that no person is meant.
    seed
        What the plan, the hand and the noise are drawn by, together with the pseudonym.
    answers
        Source of the answers, such as ``simulated:0.4``.
    hand
        What moves the simulated device.
    folder
        Directory of the session.
    files
        Texts of the files that stand beside the protocol, by name.
    """

    text: str
    where: str
    participant: str
    seed: int
    answers: str
    hand: str
    folder: str
    files: Mapping[str, str] = field(default_factory=dict)

    @property
    def protocol(self) -> Protocol:
        """The protocol, made anew from its file and those beside it."""
        return parse_protocol(self.text, self.where, beside=lambda name: self.files[name])


# Lévesque 2009, 4.3: 12 s for a string of five cells.
READING_S = 12 / 5
ANSWERING_S = 3.0  # ours: an answer is said and typed
BREAK_S = 120.0  # ours


def expected_minutes(protocol: Protocol, plan: Plan) -> float:
    """Estimate how long a session takes, in minutes, with people who read as in the source.

    Parameters
    ----------
    protocol, plan
        The protocol, and a participant's plan of it; where answers choose the trials, with the
        most that there may be.
    """
    trials = plan.trials[: protocol.trials]
    shown = [*plan.practice, *trials]
    cells = sum(len(stimulus.masks) for trial in shown for stimulus in trial.stimuli)
    seconds = READING_S * cells + len(shown) * (ANSWERING_S + protocol.trial.gap_s)
    if every := protocol.session.break_every:
        seconds += (protocol.session.break_s or BREAK_S) * ((len(trials) - 1) // every)
    limit = protocol.session.limit_s
    return (seconds if limit is None else min(seconds, limit)) / 60


def conduct(task: PilotTask) -> int:
    """Conduct a session as fast as the machine can, or go on with it, and count its trials."""
    folder = Path(task.folder)
    if folder.exists():
        progress = load(folder).progress()
        if progress.ended:
            return progress.done
        session = Session.resume(folder)
    else:
        session = Session.create(
            task.protocol,
            task.participant,
            folder=folder,
            seed=task.seed,
            conditions=Conditions(answers=task.answers, hand=task.hand, fast=True, sound="none"),
        )
    return session.run().progress.done


def pilot(
    protocol: Protocol,
    participants: int,
    folder: Path,
    workers: Workers,
    *,
    habits: ReaderHabits,
    seed: int,
    report: Callable[[int, int], None] = lambda _done, _all: None,
) -> Path:
    """Conduct the sessions of a pilot, write its report, and give the report's directory.

    Parameters
    ----------
    protocol
        Protocol that is tried.
    participants
        Number of simulated participants.
    folder
        New directory; or that of the same pilot, ended early, which then goes on.
    workers
        Processes that conduct the sessions, which do not depend on their number.
    habits
        Noise, lapses and false alarms of the simulated reader.
    seed
        What plans, hands and noise are drawn by.
    report
        Function that is called with how many sessions are done, and how many there are.

    Raises
    ------
    InputError
        If an argument cannot be used, or the directory is of something else.
    VbrailleError
        If the work ended early.
    """
    if not 1 <= participants <= MOST_PILOTS:
        raise InputError(
            f"{setting('participants')} is {participants}; it must be 1 to {MOST_PILOTS}"
        )
    answers = habits.checked().spec
    tasks = [
        PilotTask(
            text=protocol.text,
            where=protocol.name,
            participant=name,
            seed=seed,
            answers=answers,
            hand="slow",
            folder=str(folder / name),
            files=protocol.files,
        )
        for name in (f"SIM{number:03}" for number in range(1, participants + 1))
    ]
    about = {"mark": MARK, "protocol": protocol.text, "participants": participants, "seed": seed,
             "answers": answers}  # fmt: skip
    about |= {"files": protocol.files} if protocol.files else {}
    _begin(folder, about, tasks[0])
    ended = work_on(workers, conduct, tasks, KeptResults(None, {}), report)
    if ended is not None:
        raise VbrailleError(f"{ended}; the same command goes on with {folder}")
    from vbraille.analysis import analyse
    from vbraille.analysis.report.written import write_report

    results = marked(analyse([task.folder for task in tasks], seed=seed))
    write_report(results, folder / REPORT, mark=mark_rows)
    return folder / REPORT


def _begin(folder: Path, about: dict[str, Any], first: PilotTask) -> None:
    """Make the directory of a pilot, or see that it is this pilot's."""
    path = folder / ABOUT
    content = (json.dumps(about, ensure_ascii=False, indent=1) + "\n").encode()
    if path.exists() and path.read_bytes() == content:
        if (folder / REPORT).exists():
            raise InputError(f"{folder} has this pilot already, with its report; look there")
        return
    check_free(folder)
    # Made once so that what cannot be used is known before there is a directory.
    conditions = Conditions(answers=first.answers, hand=first.hand, fast=True)
    given = {"folder": first.folder, "seed": first.seed, "conditions": conditions}
    Session.create(first.protocol, first.participant, **given).answers()
    folder.mkdir(parents=True, exist_ok=True)
    write_file(path, content)
    write_file(folder / "README.txt", _TOLD.encode())


def marked(results: Results) -> Results:
    """Results in which every title says that no people were asked."""

    def table(one: ResultTable) -> ResultTable:
        return replace(one, schema=replace(one.schema, title=f"{one.schema.title} ({MARK})"))

    chapters = tuple(
        replace(
            chapter,
            title=f"{chapter.title} ({MARK})",
            tables=tuple(map(table, chapter.tables)),
            figures=tuple(
                replace(
                    figure,
                    title=f"{figure.title} ({MARK})",
                    chart=replace(figure.chart, title=f"{figure.chart.title} ({MARK})"),
                )
                for figure in chapter.figures
            ),
        )
        for chapter in results.chapters
    )
    return replace(results, title=f"{results.title} ({MARK})", chapters=chapters)


def mark_rows(text: str) -> str:
    """Table in CSV with a column in each row that says that no people were asked."""
    rows = list(csv.reader(io.StringIO(text)))
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    for number, row in enumerate(rows):
        writer.writerow([*row, "yes" if number else MARK])
    return out.getvalue()
