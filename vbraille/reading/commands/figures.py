"""The command that feels a figure of the text."""

from __future__ import annotations

from typing import TYPE_CHECKING

from vbraille.errors import InputError
from vbraille.reading.cues import Cue
from vbraille.reading.figured import figure_of_block
from vbraille.wording import spelled

if TYPE_CHECKING:
    from vbraille.reading.reader import Reader


def feel(reader: Reader) -> None:
    """Put the figure that the line stands for alone under the hand, until a key leads back."""
    line, under = reader.line, reader.under
    address = "" if line is None else figure_of_block(line)
    figures = under.figured.all if address else None
    if figures is None:
        reader.cue(Cue.NOT_FOUND)
        reader.say("figure: none on this line")
        return
    try:
        under.alone = figures.feel(address, reader.say, reader.cue)
    except InputError as error:
        reader.cue(Cue.NOT_FOUND)
        reader.say(f"figure not felt: {spelled(str(error))}")
        return
    reader.say(f"{under.alone.key('BACK', 'G')} or escape goes back to the text")
