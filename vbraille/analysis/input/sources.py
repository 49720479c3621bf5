"""Names of sessions and tables that tell them apart, and sessions that are there twice."""

from __future__ import annotations

from collections import Counter, defaultdict
from typing import TYPE_CHECKING

from vbraille.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence
    from pathlib import Path

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
        f"are; their participant {who} is taken for one person."
        for (_, who), alike in of.items()
        if len(alike) > 1
    ]
