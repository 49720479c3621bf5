"""Commands on the pages of a surface of two axes: turn to another, and how a finger strays."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Final

from vbraille.reading.cues import Cue
from vbraille.render.braille.straying import BAND_BOUNDS

if TYPE_CHECKING:
    from collections.abc import Callable

    from vbraille.reading.reader import Reader
    from vbraille.render.braille.straying import Straying

_STEP: Final = 0.1  # of the band, in line pitches
_WORDS: Final = {
    "line": "straying: the finger is kept on its line",
    "free": "straying: each actuator shows what lies under it",
}


def next_page(reader: Reader) -> None:
    """Turn to the next page of the surface; where that has one line, go to the next one."""
    _turn(reader, 1)


def previous_page(reader: Reader) -> None:
    """Turn to the page of the surface before; where that has one line, go to the one before."""
    _turn(reader, -1)


def change_straying(reader: Reader) -> None:
    """Keep the finger on its line of a page, or show what lies under each actuator."""
    straying = reader.style.straying
    manner = "free" if straying.manner == "line" else "line"
    _show(reader, replace(straying, manner=manner), _WORDS[manner])


def turn_band(steps: int) -> Callable[[Reader], None]:
    """Make a command that makes the band of a line wider, or narrower if negative."""

    def handler(reader: Reader) -> None:
        straying = reader.style.straying
        low, high = BAND_BOUNDS
        band = round(min(max(straying.band + steps * _STEP, low), high), 2)
        if band == straying.band:
            reader.cue(Cue.LIMIT)
            reader.say(f"band: {band:g} line pitches, the {'most' if steps > 0 else 'least'}")
        else:
            _show(reader, replace(straying, band=band), f"band: {band:g} line pitches")

    return handler


def _turn(reader: Reader, step: int) -> None:
    if not reader.turn_page(step):
        reader.cue(Cue.LIMIT)
        reader.say("last page" if step > 0 else "first page")
    elif not reader.under.rows:
        reader.announce()


def _show(reader: Reader, straying: Straying, said: str) -> None:
    """Show pages with another straying, which can be taken back, and say what has changed."""
    if not reader.under.rows:
        reader.cue(Cue.LIMIT)
        reader.say("straying: one line is under the hand, and the finger cannot leave it")
        return
    before = reader.style
    reader.tune(straying=straying)
    reader.styles_before.append(before)
    reader.say(said)
