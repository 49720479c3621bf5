"""Orders of trials: shuffles that are the same on every machine, and balanced orders."""

from __future__ import annotations

import random
from collections import Counter
from hashlib import sha256
from typing import TYPE_CHECKING, TypeVar

if TYPE_CHECKING:
    from collections.abc import Callable, Hashable, Iterable

_Item = TypeVar("_Item")


class Chance:
    """Shuffles that are the same on every machine and for every Python.

    Python promises only that `random.Random.random` gives the same numbers for a seed in every
    version. So the shuffle is made of these numbers alone, and the seed is the SHA-256 of a text.

    Parameters
    ----------
    seed
        Any text; equal texts give equal shuffles.
    """

    def __init__(self, seed: str) -> None:
        self._random = random.Random(int.from_bytes(sha256(seed.encode()).digest(), "big")).random

    def below(self, number: int) -> int:
        """Whole number from 0 to one less than the given one, all equally likely."""
        return int(self._random() * number)

    def shuffled(self, items: Iterable[_Item]) -> list[_Item]:
        """Items in random order, in which every order is equally likely (Fisher and Yates)."""
        order = list(items)
        for last in range(len(order) - 1, 0, -1):
            other = self.below(last + 1)
            order[last], order[other] = order[other], order[last]
        return order

    def apart(
        self,
        items: Iterable[_Item],
        content: Callable[[_Item], Hashable],
        before: Hashable = None,
    ) -> list[_Item]:
        """Items in an order in which no two neighbours have the same content.

        Each item is drawn from the items left whose content differs from the one before, and all
        of these are equally likely. But a content that more than half of the items left have
        comes next, since otherwise it would have to come twice in a row later. So contents that
        are equally frequent are equally likely at every place.

        Parameters
        ----------
        items
            The items, in any order.
        content
            Function that gives the content of an item.
        before
            Content of the item that comes before all of these; None if there is no such item.

        Raises
        ------
        ValueError
            If there is no such order.
        """
        left = [(content(item), item) for item in items]
        counts = Counter(kind for kind, _ in left)
        order: list[_Item] = []
        while left:
            must = next((kind for kind, n in counts.items() if n > len(left) // 2), None)
            if must is not None and must == before:
                raise ValueError("something is in more than half of them")
            while True:
                at = self.below(len(left))
                kind, item = left[at]
                if kind == must if must is not None else kind != before:
                    break
            left[at] = left[-1]
            left.pop()
            counts[kind] -= 1
            order.append(item)
            before = kind
        return order


def balanced_orders(number: int) -> list[tuple[int, ...]]:
    """Orders of a number of conditions, balanced for place and for what goes before.

    Over all orders together, each condition is equally often in each place, and follows each
    other condition equally often (E. J. Williams, 1949). There are as many orders as conditions;
    if that number is odd, their mirror images are added.

    Parameters
    ----------
    number
        Number of conditions, at least 1.

    Returns
    -------
    list of tuple of int
        Orders of the numbers 0 … number - 1, each of which is in every order once.
    """
    # The first order is 0, 1, n-1, 2, n-2, …: its neighbours differ by each of 1 … n-1 once if n
    # is even, and twice together with the mirror image if n is odd.
    first = [(place + 1) // 2 if place % 2 else -(place // 2) for place in range(number)]
    square = [tuple((row + step) % number for step in first) for row in range(number)]
    if number % 2 and number > 1:
        square += [order[::-1] for order in square]
    return square
