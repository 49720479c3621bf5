"""The process that speaks the sentences that `vbraille.reading.speech` sends.

If there is no speech, or none any more, it says so once on standard error and ends.
"""

from __future__ import annotations

import sys
from contextlib import suppress
from typing import TYPE_CHECKING

from vbraille.reading.speech import Spoken
from vbraille.reading.ssip import SpeechError, SpeechServer
from vbraille.workers import begin

if TYPE_CHECKING:
    from collections.abc import Iterable

    from vbraille.workers import Incoming


def newest(sentences: Iterable[Spoken]) -> list[Spoken]:
    """Sentences from the last on that takes the place of those before it."""
    kept: list[Spoken] = []
    for sentence in sentences:
        if sentence.instead:
            kept.clear()
        kept.append(sentence)
    return kept


def speak(orders: Incoming[Spoken], language: str) -> None:
    """Say what comes until it ends.

    Parameters
    ----------
    orders
        Sentences that come.
    language
        Language that is spoken, as a tag.

    Raises
    ------
    SpeechError
        If there is no speech.
    """
    server = SpeechServer(language)
    while not orders.ended:
        orders.wait()
        sentences = newest(orders.take())  # of several the newest are what is true
        try:
            _say(server, sentences)
        except SpeechError:  # the server may have been started anew; if not, that is the end
            server.close()
            server = SpeechServer(language)
            _say(server, sentences)
    server.close()


def _say(server: SpeechServer, sentences: list[Spoken]) -> None:
    for sentence in sentences:
        if sentence.instead:
            server.hush()
        if sentence.text.strip():
            server.say(sentence.text)


def main() -> int:
    """Speak until there is no more to say, or no speech."""
    try:
        speak(begin(Spoken)[0], sys.argv[2])
    except SpeechError as error:
        with suppress(OSError):
            print(f"speech: {error}; reading goes on without it", file=sys.stderr, flush=True)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
