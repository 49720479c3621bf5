"""Reading: a text line after line, or a picture, and the commands in between."""

from vbraille.cli.old.reading.commands.table import COMMANDS
from vbraille.cli.old.reading.keys import Command, Context

__all__ = ["COMMANDS", "Command", "Context"]
