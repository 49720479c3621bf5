"""The question which of some names a picture has."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar

from vbraille.sessions.planning.pace import MOST_BUTTONS, check_name
from vbraille.sessions.planning.questiontable import RIGHT, WRONG, CellSpelling, QuestionTable
from vbraille.sessions.planning.scales import quoted
from vbraille.tomlfile import Table, which

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from vbraille.sessions.planning.stimuli import Trial


class Naming(Table, frozen=True, kw_only=True):
    """One of the names that a picture is given.

    Parameters
    ----------
    of
        Column of the file of items that has the right name, such as "shape"; None if the picture's
        own name is right.
    names
        Names that may be given, by the keys that stand for them, such as 1 or s.

    Raises
    ------
    ValueError
        If there are fewer than two, a name is given twice, or one cannot be typed.
    """

    names: dict[str, str]
    of: str | None = None

    def __post_init__(self) -> None:
        if len(self.names) < 2:
            raise ValueError(f"names are {len(self.names)}; give two or more to choose from")
        for key, name in self.names.items():
            check_name("names: one", name)
            if len(key) != 1 or not key.isprintable() or key.isspace():
                raise ValueError(f"names have the key {key!r}; a key must be one character")
            if [*self.names.values()].count(name) > 1:
                raise ValueError(f"names have {name!r} twice; give each its own")

    @property
    def words(self) -> str:
        """Words for the keys and their names."""
        return ", ".join(f"{key} {name}" for key, name in self.names.items())


class NameQuestion(QuestionTable, frozen=True, kw_only=True, tag="name"):
    """The question which of some names a picture has; or several, such as its shape and its size.

    Parameters
    ----------
    choices
        The names to choose from, in the order in which answers keep them.
    confirm
        Whether a typed answer is said back, and counts only when it is typed again, or by Enter.
        Until then another one takes its place.
    buttons
        Whether the buttons of the device stand for the keys, in their order.

    Raises
    ------
    ValueError
        If there is no choice, a key or a name is in two, or the device cannot have so many buttons.
    """

    stimuli: ClassVar[tuple[int, ...]] = (1,)
    outcomes: ClassVar[frozenset[str]] = frozenset((RIGHT, WRONG))
    asked_of: ClassVar[str] = "pictures"

    choices: tuple[Naming, ...]
    confirm: bool = True
    buttons: bool = False

    def __post_init__(self) -> None:
        super().__post_init__()
        if not self.choices:
            raise ValueError("choices are none; give one or more")
        marks = [mark for each in self.choices for mark in (*each.names, *each.names.values())]
        for mark in marks:
            if sum(mark in (*one.names, *one.names.values()) for one in self.choices) > 1:
                raise ValueError(f"choices have {mark!r} twice; give each its own")
        if self.buttons and len(self.keys) > MOST_BUTTONS:
            raise ValueError(
                f"buttons would be {len(self.keys)}, and a device has up to {MOST_BUTTONS}; leave "
                f"it out"
            )

    def check_items(self, columns: Sequence[str], rows: Sequence[Mapping[str, str]], /) -> None:
        """Check that each choice has the names of its column; see `QuestionTable.check_items`."""
        for choice in self.choices:
            if choice.of is None:
                continue
            if choice.of not in columns:
                raise ValueError(
                    f"[question] choices of is {choice.of!r}{which(choice.of, columns)}"
                )
            named = {row[choice.of] for row in rows}
            if unknown := sorted(named - set(choice.names.values())):
                raise ValueError(
                    f"[question] choices of {choice.of} have no name {unknown[0]!r}, which an item "
                    f"has; add it"
                )

    @property
    def keys(self) -> tuple[str, ...]:
        """All keys, in their order."""
        return tuple(key for each in self.choices for key in each.names)

    def by_button(self, number: int, /) -> str:
        """Key that a button stands for."""
        return self.keys[number - 1] if self.buttons and number <= len(self.keys) else ""

    def prompt(self) -> str:
        """Name the keys of each choice."""
        return "; ".join(each.words for each in self.choices)

    def right_of(self, picture: str, columns: dict[str, str], /) -> str:
        """Right answer about a picture, by the columns of the file of items."""
        return " ".join(picture if each.of is None else columns[each.of] for each in self.choices)

    def marked(self, text: str, before: Sequence[str | None] = ()) -> list[str | None]:
        """Names that a line gives, in the order of the choices, over those given before.

        Raises
        ------
        ValueError
            If the line has something else.
        """
        found = list(before) or [None] * len(self.choices)
        words = text.replace(",", " ").split()
        if not words:
            raise ValueError(f"nothing was typed; type {self.prompt()}")
        for word in words:
            known = any(word in (*one.names, *one.names.values()) for one in self.choices)
            for mark in (word,) if known else word:  # keys may stand without a blank between them
                for number, one in enumerate(self.choices):
                    name = one.names.get(mark, mark)
                    if name in one.names.values():
                        found[number] = name
                        break
                else:
                    raise ValueError(f"{quoted(word)}type {self.prompt()}")
        return found

    def missing(self, names: Sequence[str | None]) -> str:
        """Words for the keys of the first choice that has no name yet; empty if all have one."""
        return next((o.words for o, n in zip(self.choices, names, strict=True) if n is None), "")

    def parse(self, text: str, _trial: Trial, _spelling: CellSpelling, /) -> str:
        """Read keys or names, one for each choice, in any order."""
        names = self.marked(text)
        if missing := self.missing(names):
            raise ValueError(f"a name is missing; type one of {missing} as well")
        return " ".join(map(str, names))

    def outcome(self, trial: Trial, answer: str, /) -> str:
        """Right if all names are."""
        right = trial.stimuli[0].answer
        return "" if right is None else RIGHT if answer == right else WRONG

    def was(self, trial: Trial, _keys: dict[str, int], /) -> str:
        """Words for the right names."""
        return trial.stimuli[0].answer or ""

    def describe(self, _rows: Sequence[dict[str, Any]], _knob: str | None, /) -> str:
        """Sentence on the names."""
        many = " and ".join(str(len(each.names)) for each in self.choices)
        return f"Of each picture it was said which of {many} names it has"
