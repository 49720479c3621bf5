"""``vbraille setup``."""

from __future__ import annotations

from vbraille.cli import options
from vbraille.cli.printing import say


@options.command("setup")
def command() -> None:
    """The first reading then need not wait for it."""
    import time

    from vbraille.caching import compiling_note, keep_compiled
    from vbraille.errors import VbrailleError

    if not keep_compiled():
        raise VbrailleError(
            "compiled code cannot be kept; set NUMBA_CACHE_DIR to a folder that you can write to"
        )
    if note := compiling_note():
        say(note)
    begun_s = time.monotonic()
    from vbraille.engine.compiling import compile_all

    compile_all()
    say(f"compiled: {time.monotonic() - begun_s:.0f} s")
