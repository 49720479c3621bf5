"""liblouis, in a process of its own: answers questions on stdin until it closes.

It is run as a script, knows nothing of vbraille, and sets itself a limit of processor time before
each question; when that runs out the system ends it, as a crash does.
"""

from __future__ import annotations

import ctypes
import pickle
import signal
import sys
from contextlib import suppress
from functools import cache
from itertools import takewhile

# liblouis's own binding comes with the system; PyPI has another package of that name.
sys.path.insert(0, "/usr/lib/python3/dist-packages")
import louis

COMPILING_S = 20.0  # the largest tables take a second or two
UNDEFINED = 0xFF00  # the cell of `undefined.utb`
KEYS = (b"display-name", b"index-name", b"language", b"grade", b"dots", b"type")

LIBRARY = louis.liblouis
LIBRARY.lou_getTableInfo.restype = ctypes.c_char_p
LIBRARY.lou_listTables.restype = ctypes.POINTER(ctypes.c_char_p)
LIBRARY.lou_setLogLevel(60_000)


def translate(
    table: str, more: str, text: str, forms: list[int] | None
) -> tuple[bytes, list[int], list[int]]:
    """Dots of a text, for each cell the character that it stands for, and undefined cells."""
    compile_table(f"{table},{more}")
    signal.setitimer(signal.ITIMER_PROF, 0.5 + len(text) / 10_000)
    dots, places, _, _ = louis.translate([table, more], text, forms, mode=louis.dotsIO)
    undefined = [cell for cell, code in enumerate(dots) if ord(code) == UNDEFINED]
    return bytes(ord(code) & 0xFF for code in dots), places, undefined


@cache
def compile_table(tables: str) -> None:
    """Have liblouis read a table, which may take long; RuntimeError if there is none."""
    signal.setitimer(signal.ITIMER_PROF, COMPILING_S)
    louis.checkTable([tables])


def list_tables() -> list[list[str]]:
    """File name of each table that has metadata, and what it says under each of the keys."""
    found = []
    for path in takewhile(lambda path: path is not None, LIBRARY.lou_listTables()):
        told = (path.rpartition(b"/")[2], *(LIBRARY.lou_getTableInfo(path, key) for key in KEYS))
        found.append([(said or b"").decode("utf-8", "replace") for said in told])
    return found


def serve() -> None:
    """Answer questions, each the name of a function and what it is given, until there are none."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the program that asks decides when to end
    while True:
        name, *given = pickle.load(sys.stdin.buffer)
        try:
            answer = globals()[name](*given)
        except (RuntimeError, ValueError) as error:
            answer = RuntimeError(str(error))
        signal.setitimer(signal.ITIMER_PROF, 0)
        pickle.dump(answer, sys.stdout.buffer)
        sys.stdout.buffer.flush()


if __name__ == "__main__":
    with suppress(EOFError):
        serve()
