"""A line that is typed: a question, the text so far, and the keys that change it.

Keys come from the one decoder, so that a line can be typed at the terminal or at the keyboard of a
conventional display, and Escape leaves it at once.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence


class Prompt:
    """A question to be answered by a line.

    Parameters
    ----------
    question
        What is asked, such as "search for".
    answer
        Function that is called with the line, once it is complete.
    earlier
        Lines that were typed before or can be chosen, the newest last.
    """

    def __init__(
        self, question: str, answer: Callable[[str], None], earlier: Sequence[str] = ()
    ) -> None:
        self.question = question
        self.text, self.cursor = "", 0
        self._answer = answer
        self._earlier = [*dict.fromkeys(earlier), ""]
        self._choice = len(self._earlier) - 1

    def press(self, key: str) -> str | None:
        """Take a key, and tell what to say; None if the line is complete and was answered.

        Raises
        ------
        KeyError
            If the prompt is left without an answer.
        """
        before, after = self.text[: self.cursor], self.text[self.cursor :]
        match key:
            case "enter":
                self._answer(self.text)
                return None
            case "escape" | "ctrl-c" | "ctrl-d" | "ctrl-g":
                raise KeyError(self.question)
            case "backspace":
                return self._erase(before[:-1], before[-1:], after)
            case "delete":
                return self._erase(before, after[:1], after[1:])
            case "ctrl-w":
                kept = before.rstrip().rpartition(" ")
                kept = "".join(kept[:2])
                return self._erase(kept, before[len(kept) :], after)
            case "ctrl-u":
                return self._erase("", before, after)
            case "ctrl-k":
                return self._erase(before, after, "")
            case "left" | "ctrl-b":
                return self._go(self.cursor - 1)
            case "right" | "ctrl-f":
                return self._go(self.cursor + 1)
            case "home" | "ctrl-a":
                return self._go(0)
            case "end" | "ctrl-e":
                return self._go(len(self.text))
            case "up" | "ctrl-p":
                return self._choose(-1)
            case "down" | "ctrl-n":
                return self._choose(1)
            case "tab":
                return self.text or "empty"
        typed = key.removeprefix("paste:")
        if len(typed) > 1 and typed == key:
            return ""  # a key that does nothing here
        self._set(before + typed, after)
        return ""

    def _set(self, before: str, after: str) -> None:
        self.text, self.cursor = before + after, len(before)

    def _erase(self, before: str, erased: str, after: str) -> str:
        self._set(before, after)
        return f"deleted: {erased}" if erased else "nothing to delete"

    def _go(self, cursor: int) -> str:
        self.cursor = min(max(cursor, 0), len(self.text))
        return self.text[self.cursor : self.cursor + 1].replace(" ", "space") or "end"

    def _choose(self, step: int) -> str:
        self._choice = min(max(self._choice + step, 0), len(self._earlier) - 1)
        self._set(self._earlier[self._choice], "")
        return self.text or "empty"
