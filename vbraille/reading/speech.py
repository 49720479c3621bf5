"""What a reader is told, spoken by the machine's speech server."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Final, Self

from vbraille.reading.attendant import Attendant
from vbraille.wording import printable

if TYPE_CHECKING:
    from collections.abc import Callable

_MODULE: Final = "vbraille.reading.speaking"
# Sentences that follow one another so soon are one answer, such as the list of keys.
TOGETHER_S: Final = 0.05
# What a line to the speaking process begins with: whether its sentence is said in place of what is
# being said, or after it. A line without a sentence only stops what is being said.
INSTEAD: Final = "!"
AFTER: Final = "+"
_MOST: Final = 900  # characters in one line to that process, which is less than a pipe takes whole


class Speech:
    """The speech of a reading: it says the newest thing, and reading never waits for it.

    A sentence takes the place of what is being said, unless it follows the sentence before it so
    soon that both belong together. A process of its own speaks (`vbraille.reading.speaking`); where
    there is no speech it says so once, and everything here does nothing. A context manager.

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
        self._attendant: Attendant | None = Attendant(_MODULE, language)

    def say(self, sentence: str) -> None:
        """Say a sentence; this never waits."""
        now_s = self._now_s()
        how = AFTER if now_s - self._said_s < TOGETHER_S else INSTEAD
        self._said_s = now_s
        text = printable(sentence)
        for begun in range(0, len(text), _MOST):
            self._tell(how, text[begun : begun + _MOST])
            how = AFTER

    def hush(self) -> None:
        """Say no more of what is being said."""
        self._tell(INSTEAD, "")

    def close(self) -> None:
        """Speak no more than what was said so far; further calls do nothing."""
        attendant, self._attendant = self._attendant, None
        if attendant is not None:
            attendant.close()

    def _tell(self, how: str, text: str) -> None:
        if self._attendant is None:
            return
        line = f"{how}{text}".encode()
        if not self._attendant.tell(line, alone=how == INSTEAD):
            self.close()  # it has said why

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()
