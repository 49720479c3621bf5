"""The process that gives cues and plays sounds: both come, and sounds or bells go out.

It is told whether by "tones" or by "bell". Where there is no audio output, or none any more, it
rings the bell.
"""

from __future__ import annotations

import sys
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Final

from vbraille.cli.old.reading.view import Cue, SoundFile
from vbraille.errors import InputError
from vbraille.sounds import Bell, Tones
from vbraille.workers import begin

if TYPE_CHECKING:
    from collections.abc import Callable

    from vbraille.workers import Incoming

_BELL_S: Final = 0.2  # from one bell to the next, so that two are heard as two


@dataclass(frozen=True, slots=True)
class CueTone:
    """One tone of a cue's melody: its frequency in Hz, and how long it lasts in ms."""

    frequency_hz: float
    duration_ms: float


# Each is another melody, and another number of bells: who does not hear pitch hears the rhythm.
MELODIES: Final = {
    Cue.LINE_END: (CueTone(880, 50),),
    Cue.PAGE_END: (CueTone(660, 60), CueTone(880, 60)),
    Cue.LIMIT: (CueTone(220, 60), CueTone(220, 60), CueTone(220, 60)),
    Cue.NOT_FOUND: (CueTone(440, 60), CueTone(370, 60), CueTone(311, 60), CueTone(262, 120)),
}


def give(
    orders: Incoming[Cue | SoundFile], kind: str, open_tones: Callable[[], Tones] = Tones
) -> None:
    """Give cues, and play files of sound, until the orders end.

    Parameters
    ----------
    orders
        Cues and files that come.
    kind
        "tones" or "bell", by which cues are given; files are played in any case, if
        there is an audio output.
    open_tones
        Function that opens the audio output, or raises OSError.
    """
    tones = None
    if kind == "tones":
        with suppress(OSError):
            tones = open_tones()
    bell, rings = Bell(), 0
    player = None  # of files
    while not orders.ended:
        if rings:
            bell.ring()
            rings -= 1
        if not orders.wait(_BELL_S if rings else None):
            continue
        cues = orders.take()
        if not cues:
            continue
        cue = cues[-1]  # of several the newest is what is true
        if isinstance(cue, SoundFile):
            with suppress(OSError, InputError):  # words are said beside it
                player = player or tones or open_tones()
                player.play_file(Path(cue.path))
            continue
        rings = len(MELODIES[cue])
        if tones is not None:
            try:
                tones.play_melody(MELODIES[cue])
                rings = 0
            except OSError:  # the audio output is gone
                tones = None


if __name__ == "__main__":
    give(begin(Cue | SoundFile)[0], sys.argv[2])
