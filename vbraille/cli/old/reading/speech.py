"""Speech: sentences that the machine's speech server speaks."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Final

import msgspec

from vbraille.wording import printable
from vbraille.workers import Worker

if TYPE_CHECKING:
    from collections.abc import Callable

_MODULE: Final = "vbraille.cli.old.reading.speaking"
# Sentences that follow one another so soon are one answer, such as the list of keys.
TOGETHER_S: Final = 0.05


class Spoken(msgspec.Struct, frozen=True):
    """A sentence to be said, in place of what is being said or after it; it may be empty."""

    text: str
    instead: bool


class Speech:
    """The speech of a reading: it says the newest thing, and reading never waits for it.

    A sentence takes the place of what is being said, unless it follows the sentence before it so
    soon that both belong together. A process of its own speaks (`vbraille.cli.old.reading.speaking`); where
    there is no speech it says so once, and everything here does nothing.

    Parameters
    ----------
    language
        Language that is spoken, as a tag such as "fr" or "pt-BR".
    now_s
        Clock in seconds that does not go back.
    """

    def __init__(self, language: str = "en", now_s: Callable[[], float] = time.monotonic) -> None:
        self._now_s = now_s
        self._said_s = float("-inf")
        # Started now, since a server that must be started first takes half a second.
        self._worker = Worker(_MODULE, language)

    def say(self, sentence: str) -> None:
        """Say a sentence; this never waits."""
        now_s = self._now_s()
        instead = now_s - self._said_s >= TOGETHER_S
        self._said_s = now_s
        if not self._worker.send(Spoken(printable(sentence), instead), alone=instead):
            self.close()  # it has said why

    def close(self) -> None:
        """Speak no more than what was said so far; further calls do nothing."""
        self._worker.close()
