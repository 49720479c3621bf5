"""Which trials belong together, where columns alone do not say: strings, and sessions."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd

from vbraille.braille.spelling import to_braille
from vbraille.sessions.planning.design import StringList
from vbraille.sessions.planning.protocolfiles import builtin_names, builtin_text, parse_protocol

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from numpy.typing import NDArray

    from vbraille.analysis.input.sheets import Sheet


def string_sets(whole: pd.DataFrame) -> list[str]:
    """String that each trial is an ordering of: the one whose cells it shows, in any order.

    The column ``string_set`` says which that is. For tables that were exported before there was
    such a column, the protocol tells: if it is one of ours that reorders strings, and all that it
    presented are orders of its strings. Otherwise each string stands for itself.

    Parameters
    ----------
    whole
        Columns ``protocol``, ``presented`` and ``string_set``, Unicode braille.
    """
    known = {
        protocol: listed
        for protocol, shown in whole.groupby("protocol")["presented"]
        if (listed := _reordered(protocol)) and listed.keys() >= set(map(_sorted, shown))
    }
    rows = whole[["string_set", "protocol", "presented"]].itertuples(index=False, name=None)
    return [
        told or (known[protocol][_sorted(presented)] if protocol in known else presented)
        for told, protocol, presented in rows
    ]


def numbered(whole: pd.DataFrame, sheets: Sequence[Sheet]) -> NDArray[np.bool_]:
    """Whether a trial has session and number, so that it can be seen to be there twice.

    Parameters
    ----------
    whole
        Trials, or comparisons, of all sheets; the index's first level is the sheet's number.
    """
    told = np.array([{"session", "trial"} <= set(sheet.frame) for sheet in sheets])
    return told[whole.index.get_level_values(0)] & (whole["trial"] > 0).to_numpy()


def tell_sessions_apart(whole: pd.DataFrame, sheets: Sequence[Sheet]) -> list[str]:
    """Rename sessions of two tables that share a name but not their answers; tell of it.

    Where the answers are the same a trial is there twice, which is an error and is not mended here.

    Parameters
    ----------
    whole
        Data frame as in `numbered`; its column ``session`` changes.
    """
    number = pd.Series(whole.index.get_level_values(0), whole.index)
    who = [whole["participant"], whole["session"]]
    if (number.groupby(who).nunique() == 1).all():
        return []
    told = []
    known: Any = whole[numbered(whole, sheets)].groupby(["participant", "session"], sort=False)
    for (participant, session), part in known:
        answers = {n: _answers(own) for n, own in part.groupby(level=0)}
        if not _differ(list(answers.values())):
            continue
        alike = (whole["participant"] == participant) & (whole["session"] == session)
        names = [f"{sheets[n].name}: {session}" for n in number[alike]]
        whole.loc[alike, "session"] = names
        told.append(
            f"Session {session} is in {' and '.join(sheets[n].name for n in answers)} with other "
            f"answers: these are told apart as two sessions; their participant {participant} is "
            f"taken for one person. If they are several, give --sites."
        )
    return told


def _answers(part: pd.DataFrame) -> dict[tuple, tuple]:
    """What was shown and answered in each trial, by what identifies the trial."""
    names = ("presented", "answered", "duration_s", "first", "second", "chosen")
    known = part[[name for name in names if name in part]].map(str)
    keys = part[["protocol", "condition", "block", "trial"]]
    rows = (frame.itertuples(index=False, name=None) for frame in (keys, known))
    return dict(zip(*rows, strict=True))


def _differ(sheets: Sequence[Mapping[tuple, tuple]]) -> bool:
    """Whether tables have different trials under the same numbers.

    If most of the trials agree, one table is taken for an edited copy of the other.
    """
    clash = False
    for n, one in enumerate(sheets):
        for other in sheets[:n]:
            both = one.keys() & other.keys()
            alike = sum(one[trial] == other[trial] for trial in both)
            if both and (len(both) < 2 or 2 * alike >= len(both)):
                return False
            clash |= bool(both)
    return clash


@cache
def _reordered(protocol: str) -> dict[str, str]:
    """Strings of one of our protocols by their sorted cells; empty if it keeps their order."""
    if protocol not in builtin_names():
        return {}
    design = parse_protocol(builtin_text(protocol), protocol).design
    if not isinstance(design, StringList) or not design.reorder:
        return {}
    strings = [to_braille(masks) for masks in design.strings]
    return {_sorted(string): string for string in reversed(strings)}


def _sorted(text: str) -> str:
    return "".join(sorted(text))
