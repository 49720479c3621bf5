"""Study that is analysed: sessions and tables, less what is left out by a stated rule."""

from __future__ import annotations

import hashlib
import platform
from collections import Counter, defaultdict
from dataclasses import dataclass, replace
from importlib.metadata import version
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from vbraille.analysis.input.parsing import parse
from vbraille.analysis.input.scoretable import of_sheet
from vbraille.analysis.input.sessions import read_session
from vbraille.analysis.input.sheets import Sheet, read_csv
from vbraille.analysis.input.trials import LeftOut, chosen, natural
from vbraille.analysis.sharing import shared
from vbraille.errors import InputError
from vbraille.sessions.record.export import frame_of
from vbraille.version import __version__
from vbraille.wording import count

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping, Sequence
    from pathlib import Path

    from vbraille.analysis.input.sessions import SessionTrials
    from vbraille.sessions.planning.analysis import PlannedAnalysis

_NOUNS = ("trial", "comparison", "judgement")
_TOLD_VERSIONS = ("numpy", "scipy", "matplotlib")  # numbers and bytes hang on them


@dataclass(frozen=True, slots=True, eq=False)
class Study:
    """All that goes into an analysis.

    Parameters
    ----------
    trials, comparisons
        Data frames as in `vbraille.analysis.input.trials`; None if there are none.
    sessions
        Sessions that were read, in the order of participants.
    left_out
        What was left out of the analysis.
    about
        Where the data come from, as pairs of a word and a sentence.
    warnings
        What a reader must know before all numbers.
    faults
        What is damaged in the sessions, in clauses.
    judgements
        Data frame as in `vbraille.analysis.input.parsing`; None if there are none.
    """

    trials: pd.DataFrame | None
    comparisons: pd.DataFrame | None
    sessions: tuple[SessionTrials, ...]
    left_out: tuple[LeftOut, ...]
    about: tuple[tuple[str, str], ...]
    warnings: tuple[str, ...]
    faults: tuple[str, ...]
    judgements: pd.DataFrame | None = None


def load_study(
    paths: Sequence[Path],
    *,
    exclude: Mapping[str, str] | None = None,
    protocol: str | None = None,
    report: Callable[[int], None] = lambda _: None,
) -> Study:
    """Read sessions' directories and CSV files.

    Parameters
    ----------
    paths
        Directories and files, in any order.
    exclude
        Participants who are left out, each with the reason.
    protocol
        Name of the protocol whose trials are taken; None takes those of all.
    report
        Told after each path how many have been read.

    Raises
    ------
    InputError
        If a path is neither, cannot be read, or there is nothing to analyse.
    VbrailleError
        If a session has lost what it began with.
    """
    _check_paths(paths)
    sessions, files = _read(paths, report)
    sheets = list(files.values())
    sources = [*(Sheet(one.name, frame_of(one.rows), typed=True) for one in sessions), *sheets]
    apart = told_apart(sessions)
    parsed = parse(sources)
    left_out = [*parsed.left_out]
    parts = [parsed.trials, parsed.comparisons, parsed.judgements]
    for who, reason in (exclude or {}).items():
        parts, sessions = _kept(parts, sessions, "participant", who, keeps=False)
        left_out.append(LeftOut(f"participant {who}", reason))
    if protocol is not None:
        parts, sessions = _kept(parts, sessions, "protocol", protocol, keeps=True)
        left_out.append(LeftOut(f"trials of protocols other than {protocol}", "as asked for"))
    trials, comparisons, judgements = parts
    if all(part is None for part in parts):
        what = "".join(f"; left out: {left.what}, {left.reason}" for left in left_out)
        names = ", ".join(sheet.name for sheet in sources)
        raise InputError(f"{names}: no answered trial, and so nothing to analyse{what}")
    about = [("Data", _describe(parts))]
    about += [
        (f"File {sheet.name}", f"{count(len(sheet), 'row')}, SHA-256 {_sum(path)}")
        for path, sheet in files.items()
    ]
    about += [(f"Session {session.name}", _describe_session(session)) for session in sessions]
    about += _versions(sessions)
    faults = tuple(f"{session.name}: {what}" for session in sessions for what in session.faults)
    warnings = (
        *parsed.warnings,
        *apart,
        *_sources(sources),
        *_warnings(trials, sessions),
        *(f"Damaged, and analysed as far as it is whole: {fault}." for fault in faults),
    )
    return Study(
        trials,
        comparisons,
        tuple(sessions),
        tuple(left_out),
        tuple(about),
        warnings,
        faults,
        judgements,
    )


def excluding(study: Study, planned: PlannedAnalysis) -> Study:
    """Study without what its planned analysis excludes.

    Trials that took too little or too long are left out, and participants who failed too many
    catch trials.

    Raises
    ------
    InputError
        If nothing is left.
    """
    parts = [study.trials, study.comparisons, study.judgements]
    left_out, sessions = list(study.left_out), list(study.sessions)
    for at, (noun, part) in enumerate(zip(_NOUNS, parts, strict=True)):
        if part is None or "duration_s" not in part:
            continue
        taken = pd.to_numeric(part["duration_s"], errors="coerce")
        fast = taken < (planned.too_fast_s or 0.0)
        slow = taken > (planned.too_slow_s or np.inf)
        for wrong, words, limit in (
            (fast, "less", planned.too_fast_s),
            (slow, "more", planned.too_slow_s),
        ):
            if wrong.any():
                what = count(int(wrong.sum()), noun)
                left_out.append(LeftOut(what, f"planned: they took {words} than {limit:g} s"))
        kept = ~(fast | slow)
        parts[at] = chosen(part, kept) if kept.any() else None
    for who, right, asked in _caught(sessions) if planned.catch_right is not None else ():
        if right < (planned.catch_right or 0.0) * asked:
            parts, sessions = _kept(parts, sessions, "participant", who, keeps=False)
            why = f"planned: {right} of {asked} catch trials right"
            left_out.append(LeftOut(f"participant {who}", why))
    if all(part is None for part in parts):
        raise InputError("the planned analysis excludes all trials; see [analysis] of the protocol")
    return replace(
        study,
        trials=parts[0],
        comparisons=parts[1],
        judgements=parts[2],
        sessions=tuple(sessions),
        left_out=tuple(left_out),
    )


def _caught(sessions: Sequence[SessionTrials]) -> list[tuple[str, int, int]]:
    """Participants with catch trials, how many they had right, and how many they answered."""
    found: dict[str, list[bool]] = {}
    for session in sessions:
        for row in session.rows:
            if row.get("catch") and row["answered"] != "":
                own = found.setdefault(session.head["participant"], [])
                own.append(row["correct"] == 1)
    return [(who, sum(right), len(right)) for who, right in found.items()]


def load_scores(path: Path) -> tuple[pd.DataFrame, list[tuple[str, str]]]:
    """Read a table of scores, and say where it comes from.

    Raises
    ------
    InputError
        If the file is no such table.
    """
    sheet = read_csv(path)
    scores = of_sheet(sheet)
    people = count(scores["participant"].nunique(), "participant")
    about = [
        ("Data", f"{count(len(sheet), 'score')} of {people}"),
        (f"File {path.name}", f"{count(len(sheet), 'row')}, SHA-256 {_sum(path)}"),
    ]
    return scores, about + _versions(())


def _kept(
    parts: Sequence[pd.DataFrame | None],
    sessions: Sequence[SessionTrials],
    name: str,
    level: str,
    *,
    keeps: bool,
) -> tuple[list[pd.DataFrame | None], list[SessionTrials]]:
    """Rows and sessions that have a level, or those that have not.

    Raises
    ------
    InputError
        If there is no such participant or protocol, as when a name is misspelled.
    """
    known = {of for part in parts if part is not None for of in part[name].cat.categories}
    if level not in known:
        raise InputError(
            f"there is no {name} {level!r} with answered trials; there are "
            f"{', '.join(sorted(known, key=natural)) or 'none'}"
        )
    left: list[pd.DataFrame | None] = []
    for part in parts:
        if part is not None:
            rows = (part[name] == level) == keeps
            part = chosen(part, rows) if rows.any() else None
        left.append(part)
    return left, [one for one in sessions if (one.head[name] == level) == keeps]


def _check_paths(paths: Sequence[Path]) -> None:
    """Raise InputError if there is nothing at a path, or a path is there twice."""
    if not paths:
        raise InputError("nothing is given to analyse; give directories of sessions or CSV files")
    seen: set[Path] = set()
    for path in paths:
        if not path.exists():
            raise InputError(f"there is no {path}; give the directory of a session or a CSV file")
        if path.resolve() in seen:
            raise InputError(f"{path} is there twice; give it once")
        seen.add(path.resolve())


def _read(
    paths: Sequence[Path], report: Callable[[int], None]
) -> tuple[list[SessionTrials], dict[Path, Sheet]]:
    """Read sessions and tables, each under a name that no other has."""
    names = dict(zip(paths, distinct_names([path.resolve() for path in paths]), strict=True))
    sessions: list[SessionTrials] = []
    files: dict[Path, Sheet] = {}
    read = shared(read_session, [path for path in names if path.is_dir()])
    for number, (path, name) in enumerate(names.items(), 1):
        if path.is_dir():
            session = next(read)
            rows = [row | {"session": name} for row in session.rows]
            sessions.append(replace(session, name=name, rows=rows))
        else:
            files[path] = replace(read_csv(path), name=name)
        report(number)
    sessions.sort(key=lambda session: (natural(session.head["participant"]), natural(session.name)))
    check_copies(sessions)
    return sessions, dict(sorted(files.items(), key=lambda named: named[1].name))


def _describe(parts: Sequence[pd.DataFrame | None]) -> str:
    told = []
    for noun, part in zip(_NOUNS, parts, strict=True):
        if part is None:
            continue
        people = count(part["participant"].nunique(), "participant")
        more = ""
        if noun == "trial":
            conditions = part["condition"].cat.categories
            more = f" in {count(len(conditions), 'condition')} ({', '.join(conditions)})"
        elif noun == "judgement":
            more = f" ({', '.join(part['question'].unique())})"
        told.append(f"{count(len(part), noun)} of {people}{more}")
    return "; ".join(told)


def _describe_session(session: SessionTrials) -> str:
    head = session.head
    answered = sum(row["answered"] != "" for row in session.rows)
    return (
        f"participant {head['participant']}, protocol {head['protocol']}, seed {head['seed']}, "
        f"model {head['model']}, device {head['device']}, answers {head['answers']}, "
        f"{answered} of {len(session.rows)} trials answered, {session.state}"
    )


def _versions(sessions: Sequence[SessionTrials]) -> list[tuple[str, str]]:
    """Versions of the programs that analyse, and of those that ran the sessions."""
    ours = {"vbraille": __version__, "python": platform.python_version()}
    ours |= {name: version(name) for name in _TOLD_VERSIONS}
    of: dict[str, list[str]] = {}
    for session in sessions:
        of.setdefault(_listed(session.versions), []).append(session.name)
    run = [(f"Versions of {', '.join(names)}", versions) for versions, names in of.items()]
    return [("Versions of this analysis", _listed(ours)), *run]


def _listed(versions: Mapping[str, str]) -> str:
    return ", ".join(f"{name} {told}" for name, told in versions.items())


def _sources(sheets: Sequence[Sheet]) -> list[str]:
    """Sentences about answers that no person gave, and about trials that no finger read."""
    simulated, scripted, pointed = [], [], {}
    for sheet in sheets:
        moved = [source == "simulated:pointer" for source in sheet.frame.get("moved_by", ())]
        if any(moved):
            pointed[sheet.name] = sum(moved)
        kinds = {source.partition(":")[0] for source in sheet.frame.get("answers_from", ())}
        if "simulated" in kinds:
            simulated.append(sheet.name)
        if kinds - {"simulated", "typed", ""}:
            scripted.append(sheet.name)
    told = []
    if simulated:
        told.append(
            f"A simulated reader answered in {', '.join(simulated)}: that is no data about people."
        )
    for name, trials in pointed.items():
        told.append(
            f"The pointer of a live view was the hand in {count(trials, 'trial')} of {name}: that "
            f"is no data about people."
        )
    if scripted:
        told.append(f"Answers came from a file in {', '.join(scripted)}.")
    return told


def _warnings(trials: pd.DataFrame | None, sessions: Sequence[SessionTrials]) -> list[str]:
    told = [
        f"Session {session.name} is not whole: {session.state}."
        for session in sessions
        if session.state != "ended"
    ]
    protocols = () if trials is None else trials["protocol"].cat.categories
    if len(protocols) > 1:
        told.append(
            f"Trials are of {len(protocols)} protocols, {', '.join(protocols)}; what is said of "
            f"characters, strings and errors pools them (--protocol takes one)."
        )
    return told


def _sum(path: Path) -> str:
    return hashlib.sha256(path.read_bytes()).hexdigest()


def distinct_names(paths: Sequence[Path]) -> list[str]:
    """Name of each path, with as many of its folders as tell it apart from the others.

    Parameters
    ----------
    paths
        Resolved paths, no two alike.
    """
    names = [path.name for path in paths]
    for many in range(2, max((len(path.parts) for path in paths), default=0) + 1):
        counts = Counter(names)
        if len(counts) == len(names):
            break
        names = [
            "/".join(path.parts[-many:]) if counts[name] > 1 else name
            for name, path in zip(names, paths, strict=True)
        ]
    return names


def check_copies(sessions: Iterable[SessionTrials]) -> None:
    """Raise InputError if two directories hold the same session.

    They do if they began alike and an answer was given at the same moment: one may be an earlier
    copy of the other, or a damaged one.
    """
    moments: dict[tuple, SessionTrials] = {}
    for session in sessions:
        for row in session.rows:
            if not row["answer_time"]:
                continue
            told = ("seed", "protocol", "device", "answers")
            key = (row["trial"], row["cue_time"], row["answer_time"], row["answered"])
            key += tuple(str(session.head.get(name)) for name in told)
            other = moments.setdefault(key, session)
            if other is not session:
                raise InputError(
                    f"{other.folder} and {session.folder} are the same session; give it once"
                )


def told_apart(sessions: Iterable[SessionTrials]) -> list[str]:
    """Sentences that tell which sessions have the same folder name."""
    of: defaultdict[tuple[str, str], list[SessionTrials]] = defaultdict(list)
    for session in sessions:
        of[session.folder.resolve().name, session.head["participant"]].append(session)
    return [
        f"Sessions {' and '.join(session.name for session in alike)} are told apart by where they "
        f"are; their participant {who} is taken for one person."
        for (_, who), alike in of.items()
        if len(alike) > 1
    ]
