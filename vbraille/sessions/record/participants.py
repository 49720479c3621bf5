"""Pseudonyms that may mean one person, such as P7, p7, P07 and P-07."""

from __future__ import annotations

import json
import re
from typing import TYPE_CHECKING

from vbraille.sessions.record.folder import HEAD

if TYPE_CHECKING:
    from pathlib import Path


def label_of(pseudonym: str) -> str:
    """Label that BIDS takes for a pseudonym or other name: its letters and digits alone."""
    return re.sub(r"[^A-Za-z0-9]", "", pseudonym)


def alike(one: str, other: str) -> bool:
    """Whether two pseudonyms differ only in case, leading zeros, or signs that labels lack."""
    return _plain(one) == _plain(other) or label_of(one).lower() == label_of(other).lower()


def participants_in(room: Path) -> dict[str, str]:
    """Participants whose sessions are in a directory, each with the name of one session."""
    found: dict[str, str] = {}
    try:
        heads = sorted(room.glob(f"*/{HEAD}"))
    except OSError:
        return {}
    for head in heads:
        try:
            told = json.loads(head.read_text("utf-8"))
            found.setdefault(str(told["participant"]), head.parent.name)
        except (OSError, ValueError, KeyError, TypeError):
            continue  # this is no readable session; whoever uses it will be told
    return found


def nearly_same(room: Path, participant: str) -> tuple[str, str] | None:
    """Another participant in a directory whose pseudonym is similar to a new one.

    Returns
    -------
    tuple[str, str] or None
        Pseudonym of the other participant, and the name of one of their sessions. None if there
        is no such participant, or the new pseudonym is already in the directory itself.
    """
    known = participants_in(room)
    if participant in known:
        return None
    return next(((other, known[other]) for other in known if alike(other, participant)), None)


def _plain(pseudonym: str) -> str:
    return label_of(re.sub(r"(?<![0-9])0+(?=[0-9])", "", pseudonym)).lower()
