"""Short signals of what is easily missed, such as the end of a line."""

from __future__ import annotations

import os
import time
from enum import Enum
from typing import TYPE_CHECKING, Final, Self

from vbraille.workers import Worker

if TYPE_CHECKING:
    from collections.abc import Callable

_APART_S: Final = 0.1
_MODULE: Final = "vbraille.reading.cueing"


class Cue(Enum):
    """Something that a signal stands for, beside the sentence that says it."""

    LINE_END = "line end"
    PAGE_END = "page end"
    NOT_FOUND = "not found"
    LIMIT = "limit reached"


class CueKind(Enum):
    """What cues are given by."""

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


class Cues:
    """Cues that a reader hears, at most ten a second. A context manager.

    A process of its own gives them, so that reading never waits for a sound. Where there is no
    audio output the terminal's bell rings.

    Parameters
    ----------
    kind
        What cues are given by.
    now_s
        Clock in seconds that does not go back.
    """

    def __init__(self, kind: CueKind, now_s: Callable[[], float] = time.monotonic) -> None:
        self._now_s = now_s
        self._given_s = float("-inf")
        self._kind = kind
        self._worker: Worker | None = None  # started with the first cue

    def give(self, cue: Cue) -> None:
        """Give a cue, in place of one that is still heard; one that comes too soon is left out."""
        now_s = self._now_s()
        if self._kind is CueKind.NONE or now_s - self._given_s < _APART_S:
            return
        self._given_s = now_s
        if self._worker is None:
            self._worker = Worker(_MODULE, self._kind.value)
        if not self._worker.send(cue, alone=True):
            self.close()  # whatever ended it, the sentences beside the cues are still said

    def close(self) -> None:
        """Give no more cues; further calls do nothing."""
        self._kind = CueKind.NONE
        worker, self._worker = self._worker, None
        if worker is not None:
            worker.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()
