"""Options of ``vbraille completion``."""

from __future__ import annotations

import argparse

TYPE_CHECKING = False  # as in vbraille.cli
if TYPE_CHECKING:
    from vbraille.cli.parser import CommandParser


def completion(parser: CommandParser) -> None:
    """Add the shell, and the words of a line for what the shell asks at each Tab."""
    parser.add_argument(
        "shell",
        choices=("bash", "zsh", "fish", "words"),
        help="Print the script of this shell; words lists what may stand in the place of the last "
        "word of a line, which is how the scripts ask.",
    )
    words = parser.add_argument(
        "words",
        metavar="WORD",
        nargs=argparse.REMAINDER,
        help="Complete a line of these words after the program's name, if the shell is words.",
    )
    words.required = False
