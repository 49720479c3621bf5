"""An option: its value, its help, and the places where it may hold."""

from __future__ import annotations

from copy import copy
from importlib import import_module

TYPE_CHECKING = False  # importing typing, for its constant, takes as long as all the rest
if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from typing import Any, Self

    from vbraille.render.braille.style import BrailleStyle

    Reading = Callable[[str], object]

# Where an option may hold, beside the command line.
FILE = "settings file"  # under [read]
BOOK = "book"  # kept with each book, and taken when it is read again
PROFILE = "profile"  # of the settings file, for a display

_PLACES = 6  # decimal places, so that ten steps of 0.1 are 1


class Names:
    """Names in a table of the program, which is loaded when they are asked for.

    Parameters
    ----------
    module, table
        Module, and the table in it.
    more
        Further names.
    """

    def __init__(self, module: str, table: str, *more: str) -> None:
        self._module, self._table, self._more = module, table, more

    def __iter__(self) -> Iterator[str]:
        yield from getattr(import_module(self._module), self._table)
        yield from self._more

    def __contains__(self, name: object) -> bool:
        return name in tuple(self)


class Option:
    """An option of the command line, and perhaps of files.

    Parameters
    ----------
    name
        Name, with underscores for blanks.
    help
        Sentence on what it does, without what is usual.
    kind
        bool for one that is given or not; str, int or float; the values that it may have; or a
        function that reads the value.
    metavar
        Sign for the value in help.
    default
        Value where nothing gives another.
    usual
        Words for that, where there is no value, or it does not speak for itself.
    holds
        Where it may hold beside the command line, of `FILE`, `BOOK` and `PROFILE`.
    low, high, unit
        Bounds of a number, None for none, and its unit.
    required
        Whether a command cannot do without.
    pairs
        Whether it is given once for each NAME=VALUE, all of which are gathered.
    """

    def __init__(
        self,
        name: str,
        help: str,  # noqa: A002 - argparse's own word
        kind: type | tuple[str, ...] | Names | Reading = str,
        metavar: str | None = None,
        *,
        default: object = None,
        usual: str = "",
        holds: tuple[str, ...] = (),
        low: float | None = None,
        high: float | None = None,
        unit: str = "",
        required: bool = False,
        pairs: bool = False,
    ) -> None:
        self.name, self.kind, self.metavar, self.holds = name, kind, metavar, holds
        self.default = False if kind is bool else default
        self.required, self.pairs = required, pairs
        self.low, self.high, self.unit = low, high, unit
        self._help, self._usual = help, usual

    @property
    def flag(self) -> str:
        """Name on the command line, such as "--keep-lines"."""
        return f"--{self.name.replace('_', '-')}"

    @property
    def label(self) -> str:
        """Name in sentences, such as "keep lines"."""
        return self.name.replace("_", " ")

    @property
    def key(self) -> str:
        """Name in files, with the unit of a length."""
        return f"{self.name}_mm" if self.unit == "mm" else self.name

    @property
    def choices(self) -> tuple[str, ...] | Names | None:
        """Values that it may have; None if any of its type."""
        return None if callable(self.kind) else self.kind

    @property
    def usual(self) -> str:
        """Words for what holds where nothing is said; empty for a flag."""
        if self._usual or self.default is None or self.kind is bool:
            return self._usual
        return f"{self.default:g}" if isinstance(self.default, float) else str(self.default)

    @property
    def sentence(self) -> str:
        """Sentence of help, with what is usual."""
        return f"{self._help[:-1]} (default: {self.usual})." if self.usual else self._help

    @property
    def does(self) -> str:
        """Sentence on what it does, without what is usual."""
        return self._help

    def of(self, **changes: Any) -> Self:
        """Give the option as one command has it: with another default, usual words, or kind."""
        changed = copy(self)
        for name, value in changes.items():
            setattr(changed, "_usual" if name == "usual" else name, value)
        return changed

    def unset(self) -> Self:
        """Give the option without a value where it is not given, which is known then."""
        return self.of(default=None, usual=self.usual)

    def check(self, value: object, name: str) -> None:
        """Check that a number, which a message calls by a name, is within the bounds.

        Raises
        ------
        ValueError
            If it is not.
        """
        if not isinstance(value, int | float):
            return
        low, high, unit = self.low, self.high, f" {self.unit}" * bool(self.unit)
        if low is not None and not low <= value <= (value if high is None else high):
            wanted = f"{low:g} or more" if high is None else f"{low:g} to {high:g}{unit}"
            raise ValueError(f"{name} is {value:g}{unit}; it must be {wanted}")


class Argument(Option):
    """A value of a command that stands without an option's name.

    Parameters
    ----------
    name, help, kind, metavar, default
        As for an `Option`.
    times
        "" for one value, "?" for one or none, "*" and "+" for several, "..." for all that follow.
    """

    def __init__(
        self,
        name: str,
        help: str,  # noqa: A002
        metavar: str | None = None,
        kind: type | tuple[str, ...] | Names | Reading = str,
        *,
        times: str = "",
        default: object = None,
    ) -> None:
        super().__init__(name, help, kind, metavar)
        self.default, self.times = default, times

    @property
    def sentence(self) -> str:
        """Sentence of help, which says itself what is usual."""
        return self.does


class StyleKnob(Option):
    """An option that is a number of the style, which a reader turns by keys, knobs and pages.

    Parameters
    ----------
    name, help, kind, metavar, usual, unit
        As for an `Option`; a profile has it.
    low, high
        Bounds, which are those of `vbraille.Tuning` and `vbraille.Geometry`.
    step
        Number that a turn adds.
    field
        Field of `vbraille.BrailleStyle` where that has another name.
    keys
        Keys that turn it up and down; empty for none.
    turns
        Words for the two, such as "more texture".
    """

    def __init__(
        self,
        name: str,
        help: str,  # noqa: A002
        kind: type = float,
        metavar: str = "MM",
        *,
        usual: str = "the geometry's",
        unit: str = "mm",
        low: float,
        high: float,
        step: float,
        field: str = "",
        keys: str = "",
        turns: tuple[str, str] = ("", ""),
    ) -> None:
        super().__init__(name, help, kind, metavar, usual=usual, unit=unit, holds=(PROFILE,))
        self.low, self.high, self.step = low, high, step
        self.keys, self.turns = keys, turns
        self.field = field or self.key

    def applied(self, style: BrailleStyle, value: float) -> BrailleStyle:
        """Give a style in which the knob has another value."""
        changes: Any = {self.field: value}
        return style.replace(**changes)

    def value(self, style: BrailleStyle) -> float:
        """Give the value that a style has."""
        return getattr(style.geometry if self.unit else style.tuning, self.field)

    def said(self, value: float) -> str:
        """Say a value, as in "dot width: 2.2 mm"."""
        return f"{self.label}: {value:g} {self.unit}".rstrip()

    def turned(self, value: float, steps: int) -> float:
        """Turn a value so many steps up, or down if negative; it stops at the bounds."""
        return self.nearest(value + steps * self.step)

    def nearest(self, value: float) -> float:
        """Give the value that the knob can have and that is nearest to another."""
        within = min(max(value, self.low), self.high)
        if self.kind is int:  # only whole steps make sense
            return round(self.low + self.step * round((within - self.low) / self.step))
        return round(within, _PLACES)
