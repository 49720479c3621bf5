"""What keys are pressed for: a reader, or whoever else is told what to do by them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from vbraille.reading.bindings import Bound
    from vbraille.reading.context import Context
    from vbraille.reading.prompt import Prompt


class Keyed(Protocol):
    """Somebody who is told what to do by keys; see `vbraille.reading.commands.table.press`.

    Attributes
    ----------
    context : Context
        Meaning of the keys at the moment.
    prompt : Prompt or None
        What is being typed.
    bound : Bound or None
        Commands with their keys; None for those of reading.
    """

    context: Context
    prompt: Prompt | None
    bound: Bound | None

    def say(self, sentence: str) -> None:
        """Say a sentence."""
        ...

    def key(self, name: str, usual: str) -> str:
        """Key that calls a command, for a sentence."""
        ...
