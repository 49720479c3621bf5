"""A view under the hand: what keys, buttons and pages tell it, and the signals that it gives."""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import Enum
from typing import TYPE_CHECKING, ClassVar

import msgspec

from vbraille.cli.old.reading.keys import LONGEST, PASTE, Context, pasted, spoken

if TYPE_CHECKING:
    from collections.abc import Callable

    import numpy as np
    from numpy.typing import NDArray

    from vbraille.cli.old.reading.keys import Bound, Command
    from vbraille.engine.engine import Engine

_MOST_EARLIER = 50  # texts that are kept to be brought again


class Cue(Enum):
    """Something easily missed that a short signal stands for, beside the sentence that says it."""

    LINE_END = "line end"
    PAGE_END = "page end"
    NOT_FOUND = "not found"
    LIMIT = "limit reached"


class SoundFile(msgspec.Struct, frozen=True):
    """A file of sound that is to be played: its path."""

    path: str


@dataclass(slots=True)
class Prompt:
    """A question that is answered by typing.

    Parameters
    ----------
    label
        What the answer is, as in "text: …", when it is said at the end.
    then
        Function that is called with the answer, without blanks around it.
    again
        The answer if nothing is typed; empty if there is none.
    others
        Texts that can be brought instead of being typed, such as earlier answers.
    at
        Index of the text that is brought next by going on; past the last if None.
    longest
        Most characters that are typed.

    Attributes
    ----------
    typed : str
        What has been typed so far.
    cursor : int
        Place in it where the next character goes.
    """

    label: str
    then: Callable[[str], None]
    again: str = ""
    others: list[str] = field(default_factory=list)
    at: int | None = None
    longest: int = LONGEST
    typed: str = ""
    cursor: int = 0

    def press(self, key: str) -> None:
        """Take a key that is a character; others are passed over."""
        if len(key) == 1 and key.isprintable() and len(self.typed) < self.longest:
            self.typed = self.typed[: self.cursor] + key + self.typed[self.cursor :]
            self.cursor += 1

    def paste(self, text: str) -> None:
        """Take those characters of a pasted line that could have been typed."""
        for character in text:
            self.press(character)

    def erase_before(self) -> str:
        """Erase the character before the cursor, without a word."""
        self._erase(self.cursor - 1, self.cursor)
        return ""

    def erase_next(self) -> str:
        """Erase the character at the cursor, and give a sentence on the one that is there then."""
        self._erase(self.cursor, self.cursor + 1)
        return self._at_cursor()

    def erase_word(self) -> str:
        """Erase the word before the cursor, and give a sentence on it."""
        start = self.typed[: self.cursor].rstrip().rfind(" ") + 1
        return f"erased: {self._erase(start, self.cursor).strip() or 'nothing'}"

    def erase_start(self) -> str:
        """Erase all before the cursor, and give a sentence on it."""
        return f"erased: {self._erase(0, self.cursor).strip() or 'nothing'}"

    def move(self, steps: int) -> str:
        """Move the cursor as far as there is text, and give a sentence on what is there."""
        self.cursor = min(max(self.cursor + steps, 0), len(self.typed))
        return self._at_cursor()

    def bring(self, step: int) -> str:
        """Take one of the others for what is typed, and give a sentence on it."""
        at = step + (len(self.others) if self.at is None else self.at)
        if not 0 <= at < len(self.others):
            return f"{self.label}: none {'before' if step < 0 else 'after'} this"
        self.at, self.typed = at, self.others[at]
        self.cursor = len(self.typed)
        return self.say_typed()

    def say_typed(self) -> str:
        """Give a sentence on what is typed so far."""
        return f"{self.label}: {self.typed or 'nothing'}"

    def _erase(self, start: int, end: int) -> str:
        """Take away, and give, what stands between two places."""
        start = max(start, 0)
        erased = self.typed[start:end]
        self.typed = self.typed[:start] + self.typed[end:]
        self.cursor = min(self.cursor, start)
        return erased

    def _at_cursor(self) -> str:
        key = self.typed[self.cursor : self.cursor + 1]
        return f"cursor: {spoken(key, typed=True) if key else 'end'}"

    def keep(self, answer: str) -> None:
        """Keep an answer among the others, for the next time."""
        if answer in self.others:
            self.others.remove(answer)
        self.others.append(answer)
        del self.others[:-_MOST_EARLIER]


class View:
    """Something under the hand, which keys, buttons and pages tell what to do until it is done.

    Parameters
    ----------
    engine
        Engine that drives the device.
    say
        Function that is called with each thing to be said.
    bound
        Commands with their keys.
    cue
        Function that is called with short signals, beside the sentences.

    Attributes
    ----------
    does, doing : str
        Words for what the reader does here, such as "read" and "reading".
    context : Context
        Meaning of the keys at the moment.
    prompt : Prompt or None
        Question that is answered by typing.
    done : bool
        Whether there is no more to do.
    """

    does: ClassVar[str]
    doing: ClassVar[str]

    def __init__(
        self,
        engine: Engine,
        say: Callable[[str], None],
        bound: Bound,
        cue: Callable[[Cue], None],
    ) -> None:
        self.engine = engine
        self.say = say
        self.bound = bound
        self.cue = cue
        self.context = Context.READING
        self.prompt: Prompt | None = None
        self.done = False

    def listener(self) -> View:
        """Give the view that keys are for: this one, or another that stands in for a while."""
        return self

    def step(self, ticks: NDArray[np.void]) -> None:
        """Look where the hand was in ticks, which are all since the last call."""

    def steer(self) -> None:
        """Have a simulated hand go over what is here; a person's hand does so by itself."""

    def key(self, name: str, usual: str) -> str:
        """Name a key that calls a command, for a sentence."""
        keys = self.bound.keys_of(name)
        return keys[0] if keys else spoken(usual)

    def say_not_found(self, sentence: str) -> None:
        """Give the cue of what is not there, and say what that is."""
        self.cue(Cue.NOT_FOUND)
        self.say(sentence)

    def say_limit(self, sentence: str) -> None:
        """Give the cue of a limit, and say which was reached."""
        self.cue(Cue.LIMIT)
        self.say(sentence)

    def quit(self) -> None:
        """Do no more."""
        self.done = True

    def press(self, key: str) -> None:
        """Call the command that a key stands for in this context."""
        text = pasted(key)
        if text is not None:
            self._paste(key, text)
        elif self.context is Context.LEARNING:
            self._learn(spoken(key), self.bound.find(key, Context.READING))
        elif (command := self.bound.find(key, self.context)) is not None:
            command.handler(self)
        elif self.prompt is not None and self.context is Context.PROMPT:
            self.prompt.press(key)
        else:
            self.say(f"no command: {spoken(key)}; {self.key('HELP', 'h')} says the keys")

    def press_button(self, number: int) -> None:
        """Call the command that a button of the device stands for."""
        self.call(f"button {number}", self.bound.buttons.get(number))

    def call(self, name: str, command: Command | None) -> None:
        """Call the command of something with a name that is pressed and is no keyboard's key."""
        if self.context is Context.LEARNING:
            self._learn(name, command)
        elif command is None:
            self.say(f"{name}: no command; the settings file can give it one")
        elif self.context in command.contexts:
            command.handler(self)
        else:
            self.say(f"{name}: not now; answer first")

    def _paste(self, key: str, text: str) -> None:
        """Put pasted text into what is being typed; elsewhere it is no command."""
        if self.prompt is not None and self.context is Context.PROMPT:
            self.prompt.paste(text)
        elif key.startswith(PASTE):
            self.say("paste: text that is pasted is passed over; type the keys")

    def _learn(self, name: str, command: Command | None) -> None:
        """Say what something stands for, or end learning."""
        if command is not None and command.name in ("LEARN", "QUIT"):
            self.context = Context.READING
            self.say("learn: off")
        else:
            self.say(f"{name}: {'no command' if command is None else command.help}")
