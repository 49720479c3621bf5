"""Pages to be embossed: a book by BANA's literary layout, or braille as its file has it."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from itertools import islice
from typing import TYPE_CHECKING

import numpy as np

from vbraille.layout.embossed_flow import BlockFlow, blank
from vbraille.layout.embossed_rules import BEFORE_NUMBER, CENTRED_MARGIN, PlacingRule, placing
from vbraille.layout.wrapping import breaks_of, wrap
from vbraille.translate.source import BlockKind
from vbraille.translate.text import Text, to_codes

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator

    from numpy.typing import NDArray

    from vbraille.braille.cells import Cells
    from vbraille.layout.pages import Line
    from vbraille.translate.book import Book
    from vbraille.translate.source import Block

    Row = NDArray[np.uint8]

LEAST_CELLS, LEAST_LINES = 20, 6
_DASH = 0x24  # dots 3-6
_NUMBER_SIGN, _DIGITS = 0x3C, (0x1A, 0x01, 0x03, 0x09, 0x19, 0x11, 0x0B, 0x1B, 0x13, 0x0A)
_LETTERS = (
    *(0x01, 0x03, 0x09, 0x19, 0x11, 0x0B, 0x1B, 0x13, 0x0A, 0x1A, 0x05, 0x07, 0x0D),
    *(0x1D, 0x15, 0x0F, 0x1F, 0x17, 0x0E, 0x1E, 0x25, 0x27, 0x3A, 0x2D, 0x3D, 0x35),
)
_LONGEST_LIST = 1_000  # blocks that are looked at for the deepest level of a list


def rows_of(lines: Iterable[Line]) -> Iterator[Row]:
    """Rows of laid lines, which is all that a file of braille keeps of them."""
    return (line.masks for line in lines)


def cut_pages(rows: Iterable[Row], lines: int) -> Iterator[list[Row]]:
    """Cut rows into pages of so many lines, the last of which may be shorter."""
    rows = iter(rows)
    while page := list(islice(rows, lines)):
        yield page


def kept_pages(book: Book, width: int | None = None) -> Iterator[list[Row]]:
    """Pages of a book that is in braille already, with the lines that its file has.

    Parameters
    ----------
    book
        Book of ready cells.
    width
        Number of cells in a line, beyond which a line runs over, two cells in; None for lines of
        any width.
    """
    page: list[Row] | None = None
    for block, cells in blocks_of(book):
        if block.kind is BlockKind.PAGE:
            if page is not None:
                yield page
            page = []
            continue
        page = [] if page is None else page
        if block.continues and page and width is None:
            page[-1] = np.concatenate((page[-1], cells.masks))
        elif width is None or len(cells) <= width:
            page.append(cells.masks)
        else:
            breaks = breaks_of(block.text, cells)
            for start, stop, indent in wrap(breaks, width, 0, min(2, width // 2)):
                page.append(np.concatenate((blank(indent), cells.masks[start:stop])))
    if page is not None:
        yield page


def blocks_of(book: Book) -> Iterator[tuple[Block, Cells]]:
    """All blocks of a book with their cells, in order."""
    number = 0
    while (found := book.block(number)) is not None:
        yield found
        number += 1


def numbers_by(book: Book) -> Callable[[int], Row]:
    """How a book's braille writes a page's number: by its table, otherwise with the number sign."""
    table = book.table

    def number(value: int) -> Row:
        if table is None:
            return np.array([_NUMBER_SIGN, *(_DIGITS[int(d)] for d in str(value))], np.uint8)
        codes = to_codes(str(value))
        text = Text(codes, np.arange(codes.size), codes.size, frozenset(codes.tolist()))
        return table.translate(text).masks

    return number


@dataclass(slots=True)
class _PrintPage:
    """Page of the printed book that a braille page shows."""

    number: Row
    shown: int = 0  # braille pages on which it has been shown at the top

    def label(self) -> Row:
        """Number for the top of the next braille page: 12, then a12, b12 and so on.

        This is the rule on print page numbers.
        """
        self.shown += 1
        if self.shown == 1:
            return self.number
        times, letter = divmod(self.shown - 2, len(_LETTERS))
        prefix = np.full(times + 1, _LETTERS[letter], np.uint8)
        return np.concatenate((prefix, self.number))


@dataclass(slots=True)
class _Sheet:
    """A page that is being filled."""

    top: Row
    bottom: Row
    rows: list[Row] = field(default_factory=list)


class BanaPages:
    """A book on pages by BANA's literary layout; iterating lays it out, a page at a time.

    Headings, paragraphs, lists, tables, quotes, verse and notes are placed as the table in
    `vbraille.layout.embossed_rules` says. The last line of a page ends with the number of the
    braille page, and the first line with that of the print page, if the source knows it. Where a
    print page begins within a braille page, a line of dots 3-6 leads to its number.

    Parameters
    ----------
    book
        Cells of the book.
    cells, lines
        Numbers of cells in a line and of lines on a page.
    see
        Function that is told of each block whose cells are placed.

    Raises
    ------
    ValueError
        If a page is too small for the layout.
    """

    def __init__(
        self,
        book: Book,
        cells: int,
        lines: int,
        see: Callable[[Block], None] | None = None,
    ) -> None:
        for what, size, least in (("cells", cells, LEAST_CELLS), ("lines", lines, LEAST_LINES)):
            if size < least:
                raise ValueError(f"{what} is {size}; the layout needs at least {least}")
        self._book = book
        self._width = cells
        self._lines = lines
        self._see = see
        self._number = numbers_by(book)
        self._made = 0
        self._print: _PrintPage | None = None
        self._sheet: _Sheet | None = None
        self._full: list[list[Row]] = []
        self._wants_blank = False
        self._before: tuple[BlockKind, int] | None = None
        self._deepest: tuple[int, int] = (0, 0)  # group of a list, and its deepest level

    def __iter__(self) -> Iterator[list[Row]]:
        flow: BlockFlow | None = None
        number = 0
        while (found := self._book.block(number)) is not None:
            block, cells = found
            if self._see is not None:
                self._see(block)
            following = self._book.source.block(number + 1)
            goes_on = following is not None and following.continues
            if block.kind is BlockKind.PAGE:
                self._turn(cells.masks)
            elif block.continues and flow is not None:
                flow.add(block, cells)
                self._fill(flow, final=not goes_on)
            else:
                place = self._placing(block, number)
                flow = BlockFlow(place)
                flow.add(block, cells)
                if flow.breaks.strip(b"\0"):
                    self._begin(block, place, number, flow)
                    self._fill(flow, final=not goes_on)
                    self._wants_blank = place.after
            yield from self._full
            self._full.clear()
            number += 1
        if self._sheet is not None:
            self._finish()
        yield from self._full
        self._full.clear()

    def _placing(self, block: Block, number: int) -> PlacingRule:
        deepest = block.level
        if block.kind is BlockKind.ITEM and block.group:
            if self._deepest[0] != block.group:
                self._deepest = (block.group, self._look_deep(block.group, number))
            deepest = max(deepest, self._deepest[1])
        made = placing(block, deepest)
        most = self._width // 2  # deep levels must leave room for words
        if max(made.first, made.others) <= most:
            return made
        return replace(made, first=min(made.first, most), others=min(made.others, most))

    def _look_deep(self, group: int, number: int) -> int:
        """Deepest level of a list that begins at a block."""
        deepest = 1
        for n in range(number, number + _LONGEST_LIST):
            block = self._book.source.block(n)
            if block is None or (block.group != group and block.kind is not BlockKind.PAGE):
                break
            if block.kind is BlockKind.ITEM:
                deepest = max(deepest, block.level)
        return deepest

    def _begin(self, block: Block, place: PlacingRule, number: int, flow: BlockFlow) -> None:
        """Put the blank line before a block, on a page that has room for what must keep with it."""
        same = self._before == (block.kind, block.group) and place.apart
        after_heading = self._before is not None and self._before[0] is BlockKind.HEADING
        if same:
            self._wants_blank = False
        elif place.before and not (after_heading and place.apart):
            self._wants_blank = True
        self._before = (block.kind, block.group)
        if place.keeps:
            needed = self._needed(place, flow, number)
            if self._room < needed + self._wants_blank and self._room < self._lines:
                self._finish()
        if self._wants_blank and self._sheet is not None:
            if self._sheet.rows and self._room > 1:
                self._sheet.rows.append(blank(0))
            elif self._sheet.rows:
                self._finish()
        self._wants_blank = False

    def _needed(self, place: PlacingRule, flow: BlockFlow, number: int) -> int:
        """Lines that a heading needs with one line of what follows it, itself without blanks."""
        needed = flow.count(self._within(place)) + place.after
        following = self._book.block(number + 1)
        skip = 1
        while following is not None and following[0].kind is BlockKind.PAGE:
            needed += 1
            skip += 1
            following = self._book.block(number + skip)
        if following is None:
            return needed - place.after
        block, cells = following
        if block.kind is BlockKind.HEADING and skip < 16:
            under = placing(block)
            inner = BlockFlow(under)
            inner.add(block, cells)
            more = self._needed(under, inner, number + skip)
            return min(needed + (not place.after) + more, self._lines)
        return min(needed + 1, self._lines)

    @property
    def _room(self) -> int:
        """Number of lines that are left on the page."""
        return self._lines - (0 if self._sheet is None else len(self._sheet.rows))

    def _within(self, place: PlacingRule) -> int:
        """Number of cells that a line has for text, wherever it is on the page."""
        return self._width - 2 * CENTRED_MARGIN * place.centred

    def _open(self) -> _Sheet:
        """Page that is being filled."""
        if self._sheet is None:
            top = blank(0) if self._print is None else self._print.label()
            self._made += 1
            self._sheet = _Sheet(self._fit(top), self._fit(self._number(self._made)))
        return self._sheet

    def _fit(self, number: Row) -> Row:
        """Number of a page, or nothing if there is no room for it beside a few words."""
        return number if number.size <= self._width // 3 else blank(0)

    def _finish(self) -> None:
        """End the page, with its numbers."""
        sheet = self._open()
        last = self._lines - 1
        rows = [np.zeros(self._width, np.uint8) for _ in range(self._lines)]
        for row, made in zip(rows, sheet.rows, strict=False):
            row[: made.size] = made
        for at, number in ((0, sheet.top), (last, sheet.bottom)):
            if number.size:
                rows[at][-number.size :] = number
        self._full.append(rows)
        self._sheet = None

    def _turn(self, number: Row) -> None:
        """Begin a page of the printed book."""
        if not number.size:  # a page of braille, which its file keeps
            if self._sheet is not None:
                self._finish()
            return
        number = number[np.flatnonzero(number)[0] :] if number.any() else blank(0)
        self._print = _PrintPage(self._fit(number))
        if self._sheet is None or not self._sheet.rows:
            if self._sheet is not None:
                self._sheet.top = self._print.label()
            return
        if self._room <= 2:  # neither on the last line nor right above it
            self._finish()
            return
        dashes = np.full(self._width, _DASH, np.uint8)
        dashes[self._width - self._print.number.size :] = self._print.number
        self._sheet.rows.append(dashes)
        self._print.shown = 1  # the top of the next braille page has a letter

    def _fill(self, flow: BlockFlow, *, final: bool) -> None:
        """Put the lines of a block on the page, and on as many as it needs."""
        while flow.has_line(self._width, final=final):
            sheet = self._open()
            at = len(sheet.rows)
            number = sheet.top if at == 0 else sheet.bottom if at == self._lines - 1 else blank(0)
            taken = number.size + BEFORE_NUMBER if number.size else 0
            sheet.rows.append(flow.take(self._width - taken, self._width))
            if len(sheet.rows) == self._lines:
                self._finish()
