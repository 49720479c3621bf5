"""liblouis, in a process of its own: answers questions on stdin until it closes.

It is run as a script, knows nothing of vbraille, and sets itself a limit of processor time before
each question; when that runs out the system ends it, as a crash does.
"""

from __future__ import annotations

import ctypes
import pickle
import signal
import sys
from functools import cache
from itertools import takewhile
from pathlib import Path
from typing import Any

# liblouis's own binding comes with the system; PyPI has another package of that name.
sys.path.insert(0, "/usr/lib/python3/dist-packages")
import louis

COMPILING_S = 20.0  # the largest tables take a second or two
KEYS = ("language", "grade", "type", "dots", "display-name", "index-name")

LIBRARY = louis.liblouis
LIBRARY.lou_getTableInfo.restype = ctypes.c_char_p
LIBRARY.lou_listTables.restype = ctypes.POINTER(ctypes.c_char_p)
LIBRARY.lou_version.restype = ctypes.c_char_p
LIBRARY.lou_getTypeformForEmphClass.restype = ctypes.c_ushort
LIBRARY.lou_setLogLevel(60_000)


def translate(
    table: str, more: str, text: str, forms: list[int] | None
) -> tuple[list[int], list[int]]:
    """Dots of a text, and for each cell the character that it stands for."""
    compile_table(f"{table},{more}")
    limit_processor_time(0.5 + len(text) / 10_000)
    dots, places, _, _ = louis.translate([table, more], text, forms, mode=louis.dotsIO)
    return [*map(ord, dots)], places


@cache
def compile_table(tables: str) -> None:
    """Have liblouis read a table, which may take long; RuntimeError if there is none."""
    limit_processor_time(COMPILING_S)
    louis.checkTable([tables])


def list_tables() -> list[dict[str, str]]:
    """File name and metadata of each table that has some."""
    found = []
    for path in takewhile(lambda path: path is not None, LIBRARY.lou_listTables()):
        told = {key: LIBRARY.lou_getTableInfo(path, key.encode()) or b"" for key in KEYS}
        said = {key: value.decode("utf-8", "replace") for key, value in told.items()}
        found.append({"name": Path(path.decode()).name, **said})
    return found


def emphasis_bit(table: str, name: str) -> int:
    """Bit that a table has for a class of emphasis; 0 if it has no such class."""
    compile_table(table)
    return LIBRARY.lou_getTypeformForEmphClass(table.encode(), name.encode())


def display_dots(table: str, characters: str) -> list[int]:
    """Dots that a display table has for characters."""
    return [ord(dots) & 0xFF for dots in louis.charToDots([table], characters)]


def version() -> str:
    """Version of liblouis."""
    return LIBRARY.lou_version().decode()


def limit_processor_time(seconds: float) -> None:
    """Have the system end this process when it has worked for that long."""
    signal.setitimer(signal.ITIMER_PROF, seconds)


def answer(question: tuple[Any, ...]) -> Any:
    """Answer one question: the name of a function, and what it is given."""
    name, *given = question
    try:
        return globals()[name](*given)
    except (RuntimeError, ValueError) as error:
        return RuntimeError(str(error))
    finally:
        limit_processor_time(0)


def serve() -> None:
    """Answer questions until there are no more."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the program that asks decides when to end
    while True:
        try:
            question = pickle.load(sys.stdin.buffer)
        except EOFError:
            return
        sys.stdout.buffer.write(pickle.dumps(answer(question)))
        sys.stdout.buffer.flush()


if __name__ == "__main__":
    serve()
