"""``vbraille setup``."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

from vbraille.caching import compiling_note, keep_compiled
from vbraille.cli.old.terminal import say_line
from vbraille.errors import VbrailleError

if TYPE_CHECKING:
    import argparse


def run(arguments: argparse.Namespace) -> int:  # noqa: ARG001 - as each command is called
    """Compile all that readings call, or load it, and say how long that took."""
    if not keep_compiled():
        raise VbrailleError(
            "what is compiled can be kept nowhere; give a folder that can be written by "
            "NUMBA_CACHE_DIR"
        )
    if note := compiling_note():
        say_line(note)
    begun_s = time.monotonic()
    from vbraille.engine.compiling import compile_all

    compile_all()
    say_line(f"compiled: {time.monotonic() - begun_s:.0f} s")
    return 0
