"""What a reader does with a text: line after line, and the commands in between."""

from vbraille.engine.advance import EndOfLine
from vbraille.reading.commands import COMMANDS, Command
from vbraille.reading.reader import Echo, Reader, too_fast_note

__all__ = ["COMMANDS", "Command", "Echo", "EndOfLine", "Reader", "too_fast_note"]
