"""Sessions that are killed again and again, and what became of their answers."""

from __future__ import annotations

import csv
import io
import os
from collections import Counter
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np
from vbraille.sessions.record.events import to_json
from vbraille.sessions.record.folder import PLAN, check, load
from vbraille.sessions.record.traces import read_last_tie

from vbraille.sessions.record import journal

if TYPE_CHECKING:
    from pathlib import Path
from tests.benchmarks.killed_runs import Ended, acknowledged, parse, run_program

KILLS = """
format = 1
name = "kills"
title = "Pairs between delimiters"
source = "ours"
model = "vbd"
[keys]
l = "1"
r = "4"
n = "0"
[design]
kind = "combinations"
characters = ["a", "c", "4", "0"]
length = 2
before = "c"
after = "c"
repeats = 2
blocks = 2
[[conditions]]
name = "plain"
texture = 0.0
[[conditions]]
name = "textured"
texture = 1.0
[practice]
trials = 2
strings = ["c", "l"]
[trial]
gap_s = 0.0
[session]
break_every = 10
"""
# The same strings, but the contrast of each is chosen by the answers in its condition.
ADAPTIVE = f"""{KILLS}
[procedure]
kind = "quest"
parameter = "contrast"
least = 0.1
most = 1.0
step = 0.05
spread = [0.1, 0.2, 0.4]
"""
STAIRCASES = f"""{KILLS}
[procedure]
kind = "staircase"
parameter = "contrast"
least = 0.1
most = 1.0
start = [0.9, 0.4]
steps = [0.2, 0.1, 0.05]
"""
TRIALS = 64
MOST_LINES = 24
MOST_PAUSE_S = 0.012  # some more than a trial takes
# Shares of the kills, and of those a cut of the journal's last line if it may be lost.
STARTING, BEGINNING, CUT = 0.3, 0.2, 0.5
# What a crash of the machine may take: it was not said to be kept.
_NOT_DURABLE = ("presented", "cue", "contact", "read")
_DONE = ("answer", "undo", "note", "repeat")
Event = dict


@dataclass(slots=True)
class Tally:
    """What came of the kills; the lists have a sentence each."""

    kills: int = 0
    starting: int = 0
    torn: int = 0
    sessions: int = 0
    acknowledged: int = 0
    most_attempts: int = 0
    lost: list[str] = field(default_factory=list)
    skipped: list[str] = field(default_factory=list)
    others: list[str] = field(default_factory=list)


def kill_often(kills: int, seed: int, folder: Path, toml: str = KILLS) -> Tally:
    """Kill so many runs of sessions at random moments, and bring every session to its end."""
    random = np.random.default_rng(seed)
    protocol = folder / "kills.toml"
    protocol.write_text(toml)
    tally = Tally()
    while tally.kills < kills:
        tally.sessions += 1
        number = f"{tally.sessions:03}"
        answers = folder / f"{number}.txt"
        answers.write_text(script(random))
        command = ["session", "run", str(protocol), "--participant", "P1", "--fast"]
        command += ["--seed", str(random.integers(1000)), "--answers", str(answers)]
        command += ["--hand", "sweep:150", "--out"]
        whole = folder / f"{number}-whole"
        ended = run_program([*command, str(whole)])
        assert ended.code == 0, ended.stderr
        run = [*command, str(folder / number)]
        _Killed(run, whole, ended.first_line_s, random, tally).go(kills)
    return tally


def script(random: np.random.Generator) -> str:
    """Lines of a file of answers: some are taken back, the last one too."""
    lines = ["# answers, notes, and answers that are corrected"]
    for trial in range(1, TRIALS + 1):
        answer, other = ("".join(random.choice(list("lcrn"), 2)) for _ in range(2))
        noted, repeated, undone = random.random(3) < 0.1
        if noted:
            lines.append(f"note before {trial}")
        if repeated:
            lines.append("repeat")
        lines.append(answer)
        if undone or trial == TRIALS:
            lines += ["undo", other]
    return "\n".join(lines) + "\n"


class _Killed:
    """A session that is killed and gone on with, beside one that was not disturbed."""

    def __init__(
        self,
        run: list[str],
        whole: Path,
        first_line_s: float,
        random: np.random.Generator,
        tally: Tally,
    ) -> None:
        self._run = run
        self._whole = whole
        self._folder = whole.with_name(run[-1].rpartition("/")[2])
        self._first_line_s = first_line_s
        self._random = random
        self._tally = tally
        self._lost, self._skipped, self._others = tally.lost, tally.skipped, tally.others
        self._said: list[str] = []
        self._tails: list[bytes] = []

    def go(self, kills: int) -> None:
        """Until its end; after so many kills, by a run that is let be."""
        tally = self._tally
        while not self._over():
            command = self._run
            if self._folder.exists():
                command = ["session", "resume", str(self._folder)]
            aside, untorn = self._aside_bytes(), not self._tail()
            before = len(self._events()) if self._folder.exists() else 0
            if tally.kills == kills:
                ended = run_program(command)
            else:
                # All is drawn in any case, so that what is drawn later never depends on time.
                kind, share, cut, at = self._random.random(4)
                lines = int(self._random.integers(1, MOST_LINES + 1))
                if kind < STARTING:
                    ended = run_program(command, 0, share * 1.3 * self._first_line_s)
                elif kind < STARTING + BEGINNING:
                    ended = run_program(command, 1 + lines % 3, share * MOST_PAUSE_S)
                else:
                    ended = run_program(command, lines, share * MOST_PAUSE_S)
                if ended.code is None:
                    tally.kills += 1
                    tally.starting += not ended.lines
                    if cut < CUT and self._folder.exists():
                        self._cut(at, before, ended.lines)
            if (untorn or self._aside_bytes() > aside) and (tail := self._tail()):
                self._tails.append(tail)
                tally.torn += 1
            self._said += ended.lines
            self._see(ended)
            if ended.code:  # it would fail for ever
                return
        self._compare()

    def _see(self, ended: Ended) -> None:
        """What must hold after every kill."""
        if ended.code:
            self._add(self._others, f"exit code {ended.code}: {ended.stderr.strip()}")
        if not self._folder.exists():
            if self._said:
                self._add(self._lost, "the session is gone")
            return
        for finding in check(load(self._folder)):
            if not finding.good:
                self._add(self._others, f"session check: {finding.text}")
        missing = Counter(acknowledged(self._said)) - Counter(_answers(self._events()))
        for trial, answer in missing:
            self._add(self._lost, f"answer to trial {trial}, {answer}, is not in the journal")

    def _compare(self) -> None:
        """What must hold at the end, beside the session that was not disturbed."""
        tally, events = self._tally, self._events()
        whole = [to_json(event) for event in load(self._whole).journal.events]
        tally.acknowledged += len(acknowledged(self._said))
        if (self._folder / PLAN).read_bytes() != (self._whole / PLAN).read_bytes():
            self._add(self._others, "the plan is another one")
        if _done(events) != _done(whole) or _answers(events) != _answers(whole):
            self._add(self._lost, "what the file says was not done line by line, once each")
        if _first_shown(events) != _first_shown(whole):
            self._add(self._skipped, "what the trials first showed, or their order, is another")
        self._compare_said(_last(events, "presented", "attempt"))
        for problem in _wrong_attempts(events):
            self._add(self._skipped, problem)
        self._compare_table(events, whole)
        self._compare_tails(events)

    def _compare_said(self, attempts: dict[int, int]) -> None:
        """Nothing was shown after its answer was in, and nothing that the journal has not."""
        answered: set[int] = set()
        cues: Counter[int] = Counter()
        for line in self._said:
            kind, trial = parse(line)
            if kind == "answer":
                answered.add(trial)
            elif kind == "cue":
                cues[trial] += 1
                if trial in answered:
                    self._add(
                        self._lost,
                        f"trial {trial} was shown again after its answer was acknowledged",
                    )
        for trial in cues:
            if cues[trial] > attempts[trial]:
                self._add(
                    self._skipped,
                    f"trial {trial} was shown {cues[trial]} times, as {attempts[trial]}",
                )

    def _compare_table(self, events: list[Event], whole: list[Event]) -> None:
        exported = run_program(["session", "export", str(self._folder)])
        rows = list(csv.DictReader(io.StringIO("\n".join(exported.lines))))
        attempts = _last(events, "presented", "attempt")
        self._tally.most_attempts = max(self._tally.most_attempts, *attempts.values())
        if {int(row["trial"]): int(row["attempt"]) for row in rows} != attempts:
            self._add(self._others, "the exported attempts are not those of the journal")
        if {int(row["trial"]): row["answered"] for row in rows} != _last(whole, "answer", "answer"):
            self._add(self._lost, "the exported answers are not those of the undisturbed session")
        if len(rows) != TRIALS:
            self._add(self._skipped, f"{len(rows)} rows are exported, of {TRIALS} trials")

    def _compare_tails(self, events: list[Event]) -> None:
        """Every torn end is in its file; `session check` holds that against the run events."""
        torn = self._folder / journal.TORN
        found = torn.read_bytes() if torn.exists() else b""
        if found != b"".join(tail + b"\n" for tail in self._tails):
            self._add(self._others, "journal.torn does not hold what was torn")
        lengths = iter([len(tail) for tail in self._tails])
        for run in _of(events, "run"):
            # One that was killed between setting it aside and its own event names none.
            if run.get("torn_bytes") and run["torn_bytes"] not in lengths:
                self._add(
                    self._others, f"a run event names {run['torn_bytes']} torn bytes that are none"
                )
        checked = run_program(["session", "check", str(self._folder)])
        named = any(line.startswith(f"{journal.TORN}: ") for line in checked.lines)
        if checked.code or named != bool(self._tails) or "is ended" not in checked.lines[-2]:
            self._add(
                self._others, f"session check, exit code {checked.code}: {'; '.join(checked.lines)}"
            )

    def _cut(self, share: float, before: int, lines: list[str]) -> None:
        """Cut the last line short, as if the machine had crashed, unless it was acknowledged.

        Only one that came after those before, of the run that said these lines.
        """
        told = self._told()
        happened = Counter(event.kind for event in told.events[before:])
        last = told.events[-1].kind
        said = Counter(line.partition(":")[0] for line in lines)
        loose = last in _NOT_DURABLE
        loose |= last in ("answer", "undo", "note") and happened[last] > said[last]
        loose |= last == "run" and not said.keys() - {"session", "resume", "torn"}
        # A chunk of a trace names lines that were on the disk before it.
        ties = [read_last_tie(path) for path in self._folder.glob("trace-*.gz")]
        loose &= all(tie is None or tie.number < len(told.events) for tie in ties)
        if not happened or not loose or told.torn:
            return
        path = self._folder / journal.NAME
        content = path.read_bytes()
        start = content.rindex(b"\n", 0, -1) + 1
        os.truncate(path, start + 1 + int(share * (len(content) - start - 1)))

    def _told(self) -> journal.JournalContents:
        return journal.decode((self._folder / journal.NAME).read_bytes())

    def _events(self) -> list[Event]:
        return [to_json(event) for event in self._told().events]

    def _over(self) -> bool:
        return self._folder.exists() and bool(_of(self._events(), "end"))

    def _tail(self) -> bytes:
        return self._told().torn if self._folder.exists() else b""

    def _aside_bytes(self) -> int:
        torn = self._folder / journal.TORN
        return torn.stat().st_size if torn.exists() else 0

    def _add(self, sentences: list[str], what: str) -> None:
        sentence = f"session {self._folder.name}: {what}"
        if sentence not in sentences:
            sentences.append(sentence)


def _of(events: list[Event], name: str) -> list[Event]:
    return [event for event in events if event["event"] == name]


def _answers(events: list[Event]) -> list[tuple[int, str]]:
    return [(event["trial"], event["answer"]) for event in _of(events, "answer")]


def _done(events: list[Event]) -> list[tuple]:
    """What was done for each line of the file."""
    names = ("script_line", "event", "trial", "answer", "text", "corrects")
    return [tuple(map(event.get, names)) for event in events if event["event"] in _DONE]


def _first_shown(events: list[Event]) -> list[tuple[int, dict]]:
    """Trials in the order in which they were first shown, and what each then showed."""
    first: dict[int, dict] = {}
    for event in _of(events, "presented"):
        first.setdefault(event["trial"], event["shown"])
    return list(first.items())


def _last(events: list[Event], name: str, member: str) -> dict:
    return {event["trial"]: event[member] for event in _of(events, name)}


def _wrong_attempts(events: list[Event]) -> list[str]:
    """Trials that were shown again without a reason, or not again though they were open."""
    problems = []
    attempts: Counter[int] = Counter()
    open_trial, reason = 0, True
    for event in events:
        kind, trial = event["event"], event.get("trial", 0)
        if kind == "presented":
            if trial != (open_trial or trial) or event["attempt"] != attempts[trial] + 1:
                problems.append(
                    f"trial {trial} was shown as attempt {event['attempt']} after "
                    f"{attempts[trial]}, with trial {open_trial} open"
                )
            if attempts[trial] and not reason:
                problems.append(f"trial {trial} was shown again, and was not to be")
            attempts[trial] = event["attempt"]
            open_trial, reason = trial, False
        elif kind == "answer" and trial == open_trial:
            open_trial = 0
        reason |= kind in ("run", "repeat")
    return problems
