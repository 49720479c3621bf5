"""Orders: by chance that is the same on every machine, and balanced over participants."""

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

    Python promises the same numbers for a seed of `random.Random.random` alone:
    so the shuffle is made of these, and a text becomes a seed by its SHA-256.

    Parameters
    ----------
    seed
        Any text.
    """

    def __init__(self, seed: str) -> None:
        self._random = random.Random(int.from_bytes(sha256(seed.encode()).digest(), "big")).random

    def shuffled(self, items: Iterable[_Item]) -> list[_Item]:
        """Items in one of all their orders, each as likely (Fisher and Yates)."""
        order = list(items)
        for last in range(len(order) - 1, 0, -1):
            other = int(self._random() * (last + 1))
            order[last], order[other] = order[other], order[last]
        return order

    def apart(
        self,
        items: Iterable[_Item],
        content: Callable[[_Item], Hashable],
        before: Hashable = None,
    ) -> list[_Item]:
        """Items in an order in which no two neighbours have the same content.

        Each is drawn from those left that differ from the one before, all as likely; but
        what more than half of those left have comes next, since it would come twice
        running else. So items that come equally often are equally likely at every place.

        Parameters
        ----------
        items
            In any order.
        content
            Tells the content of an item.
        before
            Content of what comes before them; None if nothing does.

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
                at = int(self._random() * len(left))
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
    """Orders of so many conditions, balanced for place and for what goes before.

    Over all of them each condition is equally often in each place, and follows
    each other one equally often (E. J. Williams, 1949): a square of as many
    orders as conditions, and with its mirror image if their number is odd.

    Parameters
    ----------
    number
        How many conditions there are, at least 1.

    Returns
    -------
    list of tuple of int
        Each of 0 … number - 1, once.
    """
    # 0, 1, n-1, 2, n-2, …: neighbours differ by each of 1 … n-1 once (n even), or twice with the
    # mirror image (n odd).
    first = [(place + 1) // 2 if place % 2 else -(place // 2) for place in range(number)]
    square = [tuple((row + step) % number for step in first) for row in range(number)]
    if number % 2 and number > 1:
        square += [order[::-1] for order in square]
    return square
