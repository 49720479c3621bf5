"""A text of a program's own as lines of a page, and sentences on what cannot be shown of one."""

from __future__ import annotations

import unicodedata
from collections import Counter
from typing import TYPE_CHECKING

from vbraille.errors import InputError
from vbraille.layout.pages import Layout
from vbraille.translate import Book, BrailleTable, Document, Undefined, find_table
from vbraille.translate.source import MarkKind, Text
from vbraille.translate.substitutes import describe, is_emoji
from vbraille.wording import count, setting

if TYPE_CHECKING:
    from vbraille.braille.cells import Cells
    from vbraille.braille.geometry import Geometry
    from vbraille.display import Display
    from vbraille.layout.pages import Line


def cells_per_line(geometry: Geometry, display: Display) -> int:
    """Number of cells that a line has on a display.

    Raises
    ------
    InputError
        If there is no room for a single cell.
    """
    try:
        return geometry.cells_per_line(display.span_mm)
    except ValueError as error:
        raise InputError(str(error)) from None


def choose_table(
    language: str | None = None,
    grade: int | None = None,
    table: str | None = None,
    undefined: Undefined | str = Undefined.MARK,
) -> BrailleTable:
    """Table by its name, or by a language and a grade.

    Parameters
    ----------
    language
        Language, such as "fr" or "pt-BR"; English if nothing is given.
    grade
        0 or 1 for uncontracted braille, 2 and up for contracted; None for what is usual.
    table
        Name of a liblouis table, in place of a language and grade.
    undefined
        What is written for a character that the table does not know.

    Raises
    ------
    InputError
        If there is no such table, or both a table and a language are given.
    """
    try:
        how = Undefined(undefined)
    except ValueError:
        ways = " or ".join(Undefined)
        raise InputError(f"undefined is {undefined!r:.40}; it must be {ways}") from None
    if table is None:
        return BrailleTable(find_table("en" if language is None else language, grade), how)
    if language is not None or grade is not None:
        raise InputError(
            f"a table has its language and grade; give either {setting('table')} or those"
        )
    return BrailleTable(table, how)


def translate_text(
    text: str,
    language: str | None = None,
    grade: int | None = None,
    table: str | None = None,
    undefined: Undefined | str = Undefined.MARK,
) -> Cells:
    """Translate a text to cells, each of which knows the characters that it stands for.

    Parameters
    ----------
    text
        Text of one paragraph.
    language, grade, table, undefined
        As of `choose_table`.

    Raises
    ------
    InputError
        If something cannot be used.

    Examples
    --------
    >>> import vbraille
    >>> cells = vbraille.translate_text("the world", language="en", grade=2)
    >>> cells.to_unicode(), cells.source(0), cells.of_source(4)
    ('⠮⠀⠸⠺', (0, 3), (2, 4))
    """
    return choose_table(language, grade, table, undefined).translate(Text.of(text))


def lay_out_text(text: str, width: int, table: BrailleTable, *, keep_lines: bool = False) -> Layout:
    """Lay out a string.

    Parameters
    ----------
    text
        Text to lay out; blank lines separate its paragraphs.
    width
        Number of cells in a line.
    table
        Table by which the text is translated.
    keep_lines
        Whether each line of the text stays a line, at the margin; otherwise paragraphs are filled,
        each with an indent.

    Raises
    ------
    InputError
        If the text has nothing to show.
    """
    layout = None
    if text:
        document = Document.from_text(text, keep_lines=keep_lines)
        layout = Layout(Book(document, table), width)
    if layout is None or layout.line(1) is None:
        raise InputError("the text has nothing to read in it; give some")
    return layout


_NAMED = 5  # at most so many kinds are named in the sentence, the most frequent


class Unshown:
    """Count what lines have remarks on, because it cannot be shown; each once."""

    def __init__(self) -> None:
        self._seen: set[tuple[int, str]] = set()  # places and targets of what was counted
        self._counts: Counter[str] = Counter()

    def see(self, line: Line) -> None:
        """Count the remarks that begin on a line, each once, however often the line comes."""
        block = line.block
        if not block.marks or line.first >= line.after:
            return
        places = block.text.places
        first, after = int(places[line.first]), int(places[line.after - 1]) + 1
        for mark in block.marks:
            place = mark.start, mark.target
            if mark.kind is not MarkKind.UNSHOWN or not first <= mark.start < after:
                continue
            if place not in self._seen:
                self._seen.add(place)
                self._counts[mark.target or "other thing"] += 1

    @property
    def sentence(self) -> str | None:
        """Sentence on how many there were, and of what kinds; None if there were none."""
        total = self._counts.total()
        if not total:
            return None
        named = [count(n, what) for what, n in self._counts.most_common(_NAMED)]
        others = total - sum(n for _, n in self._counts.most_common(_NAMED))
        if others:
            named.append(count(others, "other thing"))
        return (
            f"not shown: {count(total, 'thing')} ({', '.join(named)}); "
            f"each is marked where it stands"
        )


_CHARACTERS_NAMED = 3  # at most so many characters are named in the sentence, the most frequent


class Unknown:
    """Count the characters on lines that the table does not know, each line once.

    Parameters
    ----------
    table
        Table that translates the lines; it knows which characters it does not know.
    how
        What was written for these characters.
    """

    def __init__(self, table: BrailleTable, how: Undefined) -> None:
        self._table = table
        self._how = how
        self._last = 0
        self._counts: Counter[str] = Counter()

    def see(self, line: Line) -> None:
        """Count the unknown characters of a line, unless it or a later one was counted before."""
        if line.number > self._last:
            self._last = line.number
            if self._table.undefined:
                composed = unicodedata.normalize("NFC", line.text)
                self._counts.update(c for c in composed if ord(c) in self._table.undefined)

    @property
    def sentence(self) -> str | None:
        """Sentence on how many there were and what stands for them; None if there were none."""
        sentences = [self._of_unknown(), self._of_endless()]
        return "; ".join(filter(None, sentences)) or None

    def _of_endless(self) -> str:
        words = sorted(self._table.endless)
        if not words:
            return ""
        named = ", ".join(map(repr, words[:_CHARACTERS_NAMED]))
        others = "" if len(words) <= _CHARACTERS_NAMED else ", and others"
        return (
            f"liblouis does not come to an end with {count(len(words), 'word')} ({named}{others}), "
            f"marked {self._table.marker}"
        )

    def _of_unknown(self) -> str:
        total = self._counts.total()
        if not total:
            return ""
        named = [f"{n} of {describe(c)}" for c, n in self._counts.most_common(_CHARACTERS_NAMED)]
        others = total - sum(n for _, n in self._counts.most_common(_CHARACTERS_NAMED))
        if others:
            named.append(f"{others} of others")
        return (
            f"the table {self._table.name} does not know {total} "
            f"character{'' if total == 1 else 's'} ({', '.join(named)}), {self._written()}; "
            f"{setting('undefined')} chooses mark, name, code or drop"
        )

    def _written(self) -> str:
        match self._how:
            case Undefined.MARK:
                if not any(map(is_emoji, self._counts)):
                    return f"marked {self._table.marker}"
                others = not all(map(is_emoji, self._counts))
                return "emoji by their names" + (f", others {self._table.marker}" if others else "")
            case Undefined.NAME:
                return "written as names in brackets"
            case Undefined.CODE:
                return "written as numbers in brackets"
            case Undefined.DROP:
                return "left out"
