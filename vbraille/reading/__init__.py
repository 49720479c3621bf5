"""Reading: a text line after line, or a picture, and the commands in between."""

from vbraille.reading.commands.table import COMMANDS
from vbraille.reading.keys import Command, Context

__all__ = ["COMMANDS", "Command", "Context"]
