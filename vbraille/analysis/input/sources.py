"""What trials come from, each under a name of its own: two sites may have one folder's name."""

from __future__ import annotations

from collections import Counter, defaultdict
from dataclasses import replace
from typing import TYPE_CHECKING

from vbraille.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence
    from pathlib import Path

    from vbraille.analysis.input.sheets import Sheet
    from vbraille.analysis.input.sittings import SessionTrials


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


def named(sitting: SessionTrials, name: str, site: str = "") -> SessionTrials:
    """Session under another name; if a site is given, its participant is named after it as well."""
    who = f"{site}/{sitting.head['participant']}" if site else sitting.head["participant"]
    return replace(
        sitting,
        name=name,
        head=sitting.head | {"participant": who},
        rows=[row | {"session": name, "participant": who} for row in sitting.rows],
        examples=tuple(replace(example, participant=who) for example in sitting.examples),
    )


def of_site(sheet: Sheet, site: str) -> Sheet:
    """Sheet with its participants and sessions under the name of a site."""
    frame = sheet.frame.copy()
    for name in {"participant", "session"} & set(frame):
        stripped = frame[name].str.strip()
        frame[name] = frame[name].mask(stripped != "", f"{site}/" + stripped)
    return replace(sheet, frame=frame)


def check_copies(sittings: Iterable[SessionTrials]) -> None:
    """Raise InputError if two directories hold the same session.

    They do if they began alike and an answer was given at the same moment: one may be an earlier
    copy of the other, or a damaged one.
    """
    moments: dict[tuple, SessionTrials] = {}
    for sitting in sittings:
        for row in sitting.rows:
            if not row["answer_time"]:
                continue
            told = ("seed", "protocol", "device", "answers")
            key = (row["trial"], row["cue_time"], row["answer_time"], row["answered"])
            key += tuple(str(sitting.head.get(name)) for name in told)
            other = moments.setdefault(key, sitting)
            if other is not sitting:
                raise InputError(
                    f"{other.folder} and {sitting.folder} are the same session; give it once"
                )


def told_apart(sittings: Iterable[SessionTrials]) -> list[str]:
    """Sentences that tell which sessions have the same folder name."""
    of: defaultdict[tuple[str, str], list[SessionTrials]] = defaultdict(list)
    for sitting in sittings:
        of[sitting.folder.resolve().name, sitting.head["participant"]].append(sitting)
    return [
        f"Sessions {' and '.join(sitting.name for sitting in alike)} are told apart by where they "
        f"are; their participant {who} is taken for one person. If they are several, give --sites."
        for (_, who), alike in of.items()
        if len(alike) > 1
    ]
