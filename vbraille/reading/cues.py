"""Short signals of what is easily missed, such as the end of a line."""

from __future__ import annotations

import os
from enum import Enum


class Cue(Enum):
    """Something that a signal stands for, beside the sentence that says it."""

    LINE_END = "line end"
    PAGE_END = "page end"
    NOT_FOUND = "not found"
    LIMIT = "limit reached"


class CueKind(Enum):
    """Kinds of signals by which cues are given."""

    SOUND = "sound"
    BELL = "bell"
    NONE = "none"


def choose_cues(asked: str | None, *, attended: bool) -> CueKind:
    """Choose what cues are given by.

    Parameters
    ----------
    asked
        Value of a `CueKind` that was asked for; None if none was.
    attended
        Whether somebody is at a terminal. Nobody else hears cues that were not asked for, and at
        the end of a network the terminal's bell is the only sound that comes through.
    """
    if asked is not None:
        return CueKind(asked)
    if not attended:
        return CueKind.NONE
    return CueKind.BELL if "SSH_CONNECTION" in os.environ else CueKind.SOUND
