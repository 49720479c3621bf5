"""Orders that an experimenter may type beside answers."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Generic, TypeVar

if TYPE_CHECKING:
    from collections.abc import Callable

To = TypeVar("To")


@dataclass(frozen=True, slots=True)
class Order(Generic[To]):
    """An order that an experimenter may type.

    Parameters
    ----------
    word
        Word that the order is typed as.
    handler
        Does it: it is given whom the order is to, and what stands after the word.
    help
        What the order does, in words for people.
    takes
        Whether more text may follow the word.
    """

    word: str
    handler: Callable[[To, str], None]
    help: str
    takes: bool = False
