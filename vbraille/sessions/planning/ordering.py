"""Order of trials: the table ``[order]``, which orders the blocks, and catch trials."""

from __future__ import annotations

from typing import Literal

from vbraille.errors import check_range
from vbraille.toml.tomlfile import Table


class Catch(Table, frozen=True, kw_only=True):
    """Trials that keep watch over the participant; they belong to no item.

    Parameters
    ----------
    every
        Number of trials among which there is one catch trial, at a random place; None if the
        share is given.
    share
        Share of catch trials among all, above 0 and at most 0.5; None if ``every`` is given.
    show
        What a catch trial shows: "blank" for cells without dots, "repeat" for what the trial
        before it has shown.

    Raises
    ------
    ValueError
        If a number is out of range, or both or neither of the two is given.
    """

    every: int | None = None
    share: float | None = None
    show: Literal["blank", "repeat"] = "blank"

    def __post_init__(self) -> None:
        check_range("every", self.every, 2, 1000)
        check_range("share", self.share, 0.001, 0.5)
        if (self.every is None) == (self.share is None):
            raise ValueError("every and share say the same; give one of the two")

    def number(self, trials: int) -> int:
        """Number of catch trials beside so many others."""
        if self.every is not None:
            # One of every n trials is a catch trial, and so there are n - 1 others for each.
            return trials // (self.every - 1)
        assert self.share is not None
        return max(1, round(trials * self.share / (1 - self.share)))


class BlockOrder(Table, frozen=True, kw_only=True):
    """The table ``[order]``: in which order participants have the blocks of the conditions.

    Parameters
    ----------
    kind
        "williams" or "balanced" for Williams squares over participants, "listed" for the order of
        the file, "random" for an order of each participant's own, "table" for the order that a
        file gives each participant.
    file
        Name of the file of orders, which stands beside the protocol.

    Raises
    ------
    ValueError
        If a table has no file, or something else has one.
    """

    kind: Literal["williams", "balanced", "listed", "random", "table"]
    file: str | None = None

    def __post_init__(self) -> None:
        if self.kind == "table" and self.file is None:
            raise ValueError('file is missing; give the file of orders, such as "orders.csv"')
        if self.kind != "table" and self.file is not None:
            raise ValueError("file is of kind = 'table'; leave it out")

    @property
    def of_blocks(self) -> Literal["balanced", "listed", "shuffled"]:
        """Name that ``[design] order`` has for this order; that of a table counts as listed."""
        if self.kind == "random":
            return "shuffled"
        return "balanced" if self.kind in ("williams", "balanced") else "listed"
