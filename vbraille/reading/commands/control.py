"""Commands to the device, and the end of reading."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from vbraille.reading.reader import Reader


def pause(reader: Reader) -> None:
    """Rest the array at once, or go on."""
    reader.engine.paused = not reader.engine.paused
    reader.say("paused" if reader.engine.paused else "reading")


def set_zero(reader: Reader) -> None:
    """Tell the device that its carriage is at the left stop."""
    reader.engine.set_zero()


def stop(reader: Reader) -> None:
    """Stop reading."""
    reader.quit()
