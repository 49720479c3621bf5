"""The process that speaks: sentences on standard input, as `vbraille.reading.speech` sends them.

If there is no speech, or none any more, it says so once on standard error and ends.
"""

from __future__ import annotations

import os
import sys
from contextlib import suppress
from typing import TYPE_CHECKING, Final

from vbraille.reading.speech import AFTER, INSTEAD
from vbraille.reading.ssip import SpeechError, SpeechServer

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

_PIPE_BYTES: Final = 1 << 16  # all that a pipe holds


def newest(lines: Iterable[str]) -> list[str]:
    """Lines from the last on that takes the place of those before it."""
    kept: list[str] = []
    for line in lines:
        if line.startswith(INSTEAD):
            kept.clear()
        kept.append(line)
    return kept


def speak(orders: int, language: str) -> None:
    """Say what comes until it ends.

    Parameters
    ----------
    orders
        Descriptor from which lines come.
    language
        Language that is spoken, as a tag.

    Raises
    ------
    SpeechError
        If there is no speech.
    """
    server = SpeechServer(language)
    for lines in _batches(orders):
        try:
            _say(server, lines)
        except SpeechError:  # the server may have been started anew; if not, that is the end
            server.close()
            server = SpeechServer(language)
            _say(server, lines)
    server.close()


def _batches(orders: int) -> Iterator[list[str]]:
    """All lines that have come, again and again; of several the newest are what is true."""
    begun = b""
    while chunk := os.read(orders, _PIPE_BYTES):
        *lines, begun = (begun + chunk).split(b"\n")
        yield newest(line.decode("utf-8", "replace") for line in lines)


def _say(server: SpeechServer, lines: list[str]) -> None:
    for line in lines:
        if line.startswith(INSTEAD):
            server.hush()
        if line[len(AFTER) :].strip():
            server.say(line[len(AFTER) :])


def main() -> int:
    """Speak until there is no more to say, or no speech."""
    try:
        speak(sys.stdin.fileno(), sys.argv[1])
    except SpeechError as error:
        with suppress(OSError):
            print(f"speech: {error}; reading goes on without it", file=sys.stderr, flush=True)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
