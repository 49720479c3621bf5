"""Which trials belong together, where columns alone do not say: strings, and sessions."""

from __future__ import annotations

from collections import defaultdict
from functools import cache
from typing import TYPE_CHECKING

from vbraille.braille.spelling import to_braille
from vbraille.sessions.planning.design import StringList
from vbraille.sessions.planning.protocol import parse_protocol
from vbraille.sessions.planning.protocolfiles import builtin_names, builtin_text

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence


def string_sets(values: Mapping[str, Sequence[str]]) -> list[str]:
    """Of each trial the string whose cells it shows in this order or another.

    It is what column ``string_set`` says. Tables that were exported before there was one are
    told by their protocol: if that is one of ours which reorders strings, and all that it
    presented are orders of its strings. Else a string is itself.

    Parameters
    ----------
    values
        Columns ``protocol``, ``presented`` and ``string_set``, Unicode braille.
    """
    of: defaultdict[str, set[str]] = defaultdict(set)
    for protocol, presented in zip(values["protocol"], values["presented"], strict=True):
        of[protocol].add(presented)
    known = {
        protocol: listed
        for protocol, shown in of.items()
        if (listed := _reordered(protocol)) and listed.keys() >= {_sorted(text) for text in shown}
    }
    sets = []
    columns = (values[name] for name in ("string_set", "protocol", "presented"))
    for told, protocol, presented in zip(*columns, strict=True):
        listed = known[protocol][_sorted(presented)] if protocol in known else presented
        sets.append(told or listed)
    return sets


def tell_sessions_apart(values: dict[str, list]) -> list[str]:
    """Rename sessions of two tables that have one name and other answers; what to know of them.

    Where the answers are the same a trial is there twice, and that is not for us to mend.

    Parameters
    ----------
    values
        Columns of trials, or of comparisons; ``session`` changes.
    """
    homes: defaultdict[tuple, set[int]] = defaultdict(set)
    for n, session in enumerate(values.get("session", ())):
        homes[values["participant"][n], session].add(id(values["sheet"][n]))
    if all(len(sheets) == 1 for sheets in homes.values()):
        return []
    of: defaultdict[tuple, dict[str, dict[tuple, tuple]]] = defaultdict(dict)
    for n, session in enumerate(values.get("session", ())):
        whose = values["participant"][n], session
        trial = tuple(values[name][n] for name in ("protocol", "condition", "block", "trial"))
        if values["told"][n] and values["trial"][n]:
            of[whose].setdefault(values["sheet"][n].name, {})[trial] = _answer(values, n)
    apart = {whose: list(of[whose]) for whose in of if _differ(list(of[whose].values()))}
    if apart:
        columns = (values[name] for name in ("participant", "session", "sheet"))
        values["session"] = [
            f"{sheet.name}: {session}" if (who, session) in apart else session
            for who, session, sheet in zip(*columns, strict=True)
        ]
    return [
        f"Session {session} is in {' and '.join(sheets)} with other answers: these are told apart "
        f"as two sessions; their participant {who} is taken for one person. If they are several, "
        f"give --sites."
        for (who, session), sheets in apart.items()
    ]


def _answer(values: Mapping[str, list], n: int) -> tuple:
    names = ("presented", "answered", "duration_s", "first", "second", "chosen")
    return tuple(str(values[name][n]) for name in names if name in values)


def _differ(sheets: Sequence[Mapping[tuple, tuple]]) -> bool:
    """Whether tables have trials of the same numbers that are not the same trials.

    An edited copy of a table is a copy: in it most of the trials agree.
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
