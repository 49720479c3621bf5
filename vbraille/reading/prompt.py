"""A line that is typed: a question, the text so far, and the keys that change it.

Keys come from the one decoder, so that a line can be typed at the terminal or at the keyboard of a
conventional display, and Escape leaves it at once.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

# Keys that do the same as others.
_ALSO = {
    "ctrl-c": "escape", "ctrl-d": "escape", "ctrl-g": "escape", "ctrl-b": "left",
    "ctrl-f": "right", "ctrl-a": "home", "ctrl-e": "end", "ctrl-p": "up", "ctrl-n": "down",
}  # fmt: skip


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
        key = _ALSO.get(key, key)
        text, at = self.text, self.cursor
        before, after = text[:at], text[at:]
        word = before.rstrip().rpartition(" ")
        kept = {
            "backspace": (before[:-1], after),
            "delete": (before, after[1:]),
            "ctrl-w": ("".join(word[:2]), after),
            "ctrl-u": ("", after),
            "ctrl-k": (before, ""),
        }
        places = {"left": at - 1, "right": at + 1, "home": 0, "end": len(text)}
        if key == "enter":
            self._answer(text)
            return None
        if key == "escape":
            raise KeyError(self.question)
        if key in kept:
            self._set(*kept[key])
            erased = text[self.cursor : self.cursor + len(text) - len(self.text)]
            return f"deleted: {erased}" if erased else "nothing to delete"
        if key in places:
            self.cursor = min(max(places[key], 0), len(text))
            return text[self.cursor : self.cursor + 1].replace(" ", "space") or "end"
        if key in ("up", "down"):
            step = 1 if key == "down" else -1
            self._choice = min(max(self._choice + step, 0), len(self._earlier) - 1)
            self._set(self._earlier[self._choice], "")
        if key in ("up", "down", "tab"):
            return self.text or "empty"
        typed = key.removeprefix("paste:")
        if len(typed) == 1 or typed != key:  # others do nothing here
            self._set(before + typed, after)
        return ""

    def _set(self, before: str, after: str) -> None:
        self.text, self.cursor = before + after, len(before)
