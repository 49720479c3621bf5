"""What a reader does with a text: line after line, and the commands in between."""

from vbraille.reading.bindings import Command, Context
from vbraille.reading.commands.table import COMMANDS

__all__ = ["COMMANDS", "Command", "Context"]
