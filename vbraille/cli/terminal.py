"""How a command says a line."""

from __future__ import annotations

import sys

from vbraille.wording import printable


def say_line(sentence: str, *, aside: bool = False) -> None:
    """Print a line at once, with control characters named.

    Parameters
    ----------
    sentence
        The line, without its end.
    aside
        Whether it goes to standard error, so that it is not taken for what the command prints.
    """
    print(printable(sentence), file=sys.stderr if aside else sys.stdout, flush=True)
