"""Messages between a program and the process that drives a conventional display."""

from __future__ import annotations

import msgspec


class CellsWanted(msgspec.Struct, frozen=True):
    """What is to stand on the display.

    Parameters
    ----------
    number
        Number of what is shown; it grows.
    cells
        Dot masks of the cells from the left, as many as there are; the others are blank. None to
        give the display back to whoever else shows something on it, until cells are wanted again.
    """

    number: int
    cells: bytes | None


class DisplayStands(msgspec.Struct, frozen=True, tag=True):
    """The display is there, and takes cells.

    Parameters
    ----------
    driver
        Name of its driver, such as HandyTech.
    model
        What the driver calls its model; empty if it does not say it.
    columns, rows
        Number of its cells in a row, and of its rows.
    """

    driver: str
    model: str
    columns: int
    rows: int = 1

    @property
    def title(self) -> str:
        """Name of the display for people."""
        return f"{self.driver} {self.model}".strip()


class DisplayAway(msgspec.Struct, frozen=True, tag=True):
    """The display is not there, or takes no cells.

    Parameters
    ----------
    why
        Why, and what helps, in words for people.
    """

    why: str


class CellsTaken(msgspec.Struct, frozen=True, tag=True):
    """Cells have been given to what drives the display's pins.

    Parameters
    ----------
    number
        Number of what was shown.
    at_ns
        Time of that by the machine's monotonic clock, in ns.
    """

    number: int
    at_ns: int


class KeyPressed(msgspec.Struct, frozen=True, tag=True):
    """A key of the display was pressed.

    Parameters
    ----------
    name
        Name of the command that it stands for, as BRLTTY has it, such as FWINRT or ROUTE.
    argument
        Number that belongs to it: of ROUTE the cell, from 0.
    """

    name: str
    argument: int = 0


class KeyTyped(msgspec.Struct, frozen=True, tag=True):
    """Something was typed on the keyboard of the display.

    Parameters
    ----------
    key
        The character, or the name of the key, as a terminal's keys are named.
    """

    key: str


FromDisplay = DisplayStands | DisplayAway | CellsTaken | KeyPressed | KeyTyped
