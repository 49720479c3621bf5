"""Passages as they are written: what role the next text has, and what is still to be said of it."""

from __future__ import annotations

import re
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from vbraille.translate.documents.chapters import Passage
from vbraille.translate.documents.markup.flow import Flow
from vbraille.translate.documents.markup.tables import BETWEEN, BULLET, TableState
from vbraille.translate.source import BlockKind, Mark, MarkKind

if TYPE_CHECKING:
    from collections.abc import Callable

    from vbraille.translate.documents.markup.tables import ListNumbers

BREAK = "* * *"  # a break in the text, which print shows by a line or by stars
_LONGEST_LEAD = 40  # characters before an item: its number, and those of the items it begins
_TAB = 8
_BLANK = re.compile(r"[ \t\n\r\f]")


@dataclass(frozen=True, slots=True)
class Role:
    """Role of the text that is being read, by the elements around it.

    Parameters
    ----------
    kind, level, group
        As in `Passage`.
    language
        Tag of the language of a block.
    quotes, items, sections
        Numbers of quotations, of lists and of DTBook's sections around the text.
    numbering
        How the items of the list are numbered.
    table
        The table around the text.
    is_note
        Whether the text is in a note.
    in_notes
        Whether it is in a section of notes, which are the items of its list.
    in_caption
        Whether it is in the caption of a figure, which is not said if it says the same as what
        stands for the picture.
    keeps_lines
        Whether the white space is to be kept, as in `pre`.
    refers
        Whether links are references to notes.
    """

    kind: BlockKind = BlockKind.PARAGRAPH
    level: int = 0
    group: int = 0
    language: str = ""
    quotes: int = 0
    items: int = 0
    sections: int = 0
    numbering: ListNumbers | None = None
    table: TableState | None = None
    is_note: bool = False
    in_notes: bool = False
    in_caption: bool = False
    keeps_lines: bool = False
    refers: bool = False


class Writing:
    """Passages that a reader of markup writes, one after the other.

    Parameters
    ----------
    anchors
        Names by which the first passage is found.
    language
        Tag of the language of the whole source; empty if it does not say.
    spell
        What spells the text that is not the document's own, such as an item's number, as the
        document is spelt.
    resolve
        What makes a mark's target of an address.

    Attributes
    ----------
    flow : Flow
        Text of the block that is being read.
    place : Role
        Role of the text that is being read.
    given : str
        Tag of the language of the whole source, of which no block says that it is in it.
    starts_lines : bool
        Whether white space that is kept has begun with the next text, so that a line break there
        is none.
    has_written : bool
        Whether there is text before.
    """

    def __init__(
        self,
        anchors: tuple[str, ...] = (),
        language: str = "",
        spell: Callable[[str], str] = str,
        resolve: Callable[[str], str] = str,
    ) -> None:
        self.spell = spell
        self._resolve = resolve
        self.flow = Flow()
        self.given = self.flow.language = language
        self.place = Role(language=language)
        self.starts_lines = False
        self._passages: list[Passage] = []
        self._anchors = list(anchors)
        self._groups = 0
        self._lead = ""  # number of the item that begins with the next text
        self._fresh = False  # whether that text is the item's first
        self._form: BlockKind | None = None  # of the next block, if not that of its place
        self._continues = False
        self._pages: list[tuple[str, tuple[str, ...]]] = []
        self._broken = False
        self.has_written = False
        self._pictures: tuple[str, ...] = ()  # texts of the pictures in the figure, and its caption

    def take(self) -> list[Passage]:
        """Take the passages that are finished, but for the last one."""
        passages, self._passages = self._passages[:-1], self._passages[-1:]
        return passages

    def take_last(self) -> list[Passage]:
        """Take the last passage, if there is one, after the end."""
        return self._passages

    def same(self, tag: str) -> str:
        """Give a language's tag, or the source's if the one only says more than the other."""
        one, other = tag.lower(), self.given.lower()
        related = one == other or one.startswith(f"{other}-") or other.startswith(f"{one}-")
        return self.given if related or one in ("", "und", "zxx") else tag

    def group(self) -> int:
        """Give the number of a new list or table."""
        self._groups += 1
        return self._groups

    def anchor(self, name: str) -> None:
        """Have the block that is being read, or the next, be found by a name."""
        self._anchors.append(name)

    def begin_block(self) -> None:
        """End the block that is being read; the next text begins another one."""
        if self._in_row:
            self.flow.blank()
            return
        if self.flow.length or self._pages:
            self._end_block()
        self._continues = False
        self._form = None

    def line_break(self) -> None:
        """Begin a line of the block, or another block if the line is empty."""
        if self.place.kind in (BlockKind.HEADING, BlockKind.ROW) or self._in_row:
            self.flow.blank()
        elif self.place.keeps_lines:
            self.write("\n")
        elif self.flow.length:
            self._end_block()
            if self.place.kind in (BlockKind.PARAGRAPH, BlockKind.ITEM):
                self._form = BlockKind.LINE
        else:
            self._form = None

    def write(self, text: str) -> None:
        """Add text of the source."""
        if self.place.keeps_lines and not self._in_row:
            self._write_lines(text)
            return
        if self._pages and (blank := _BLANK.search(text)):
            self.flow.add(text[: blank.start()])
            self._turn()
            text = text[blank.start() :]
        self.flow.add(text)
        if self.flow.is_full:
            self._relieve()

    def unshown(self, text: str, what: str) -> None:
        """Remark that something cannot be shown."""
        self.flow.blank()
        self.flow.say(self.spell(f"[{text}]"), MarkKind.UNSHOWN, what)
        self.flow.blank()

    def page(self, number: str, anchors: tuple[str, ...]) -> None:
        """Begin a page of the printed book, at the next blank if there is text before."""
        self._pages.append((number, anchors))
        if not self.flow.length:
            self._emit_pages()
        elif self.flow.ends_blank:
            self._turn()

    def divide(self) -> None:
        """Mark a break in the text, if there is text before and after it."""
        self.begin_block()
        self._broken = self.has_written and not self.place.in_notes

    def begin_item(self, marker: str) -> None:
        """Begin an item of a list with its number or bullet."""
        # An item that begins with a list shows both numbers, but not two bullets.
        marker = self.spell(marker)
        numbered = self._lead if self._fresh and self._lead != self.spell(BULLET) else ""
        self._lead = numbered + marker if len(numbered) < _LONGEST_LEAD else marker
        self._fresh = True

    def end_item(self) -> None:
        """End an item; the number of one without text is not shown."""
        self._fresh, self._lead = False, ""

    def begin_table(self) -> TableState:
        """Begin a table."""
        if self._in_row:
            self.lay_out_table()
        if self._fresh and self._lead:
            alone = self._formed(Passage(""), self.place.language)
            self._emit(replace(alone, text=alone.text.rstrip(" ")))
        return TableState(self.group())

    def begin_row(self) -> None:
        """Begin a row of the table, which ends the row before."""
        self.end_row()
        table = self.place.table
        if table is not None and not table.lays_out:
            self.begin_block()
            table.begin_row()

    def begin_cell(self, *, columns: int, rows: int, is_header: bool) -> None:
        """Begin a cell of the row, which ends the cell before."""
        table = self.place.table
        if table is None or table.lays_out:
            self.begin_block()
            return
        if not table.in_row:
            self.begin_row()
        table.begin_cell(self.flow.length, columns=columns, rows=rows, is_header=is_header)
        self.flow.gap(BETWEEN)

    def end_cell(self) -> None:
        """End the cell that was begun last."""
        table = self.place.table
        if table is not None and table.in_row:
            table.end_cell(self.flow.length)
            self.flow.gap(BETWEEN)
        else:
            self.begin_block()

    def end_row(self) -> None:
        """End the row of the table, if one has begun."""
        table = self.place.table
        if table is None or not table.in_row:
            return
        table.end_cell(self.flow.length)
        folded = self.flow.take(self.place.language)
        headers = table.end_row(folded.text)
        if folded.text:
            row = Passage(folded.text, BlockKind.ROW, 0, folded.marks, folded.language)
            self._emit(replace(row, group=table.group, headers=headers))
        self._emit_pages()

    def lay_out_table(self) -> None:
        """Take the table for one that lays out a page: what is in its cells are blocks."""
        table = self.place.table
        if table is not None and table.in_row:
            self.end_row()
            table.lays_out = True

    def swap_pictures(self, pictures: tuple[str, ...] = ("",)) -> tuple[str, ...]:
        """Begin a figure, within which nothing is said twice; or end it by what this returned."""
        before, self._pictures = self._pictures, pictures
        return before

    def picture(self, text: str) -> None:
        """Add the text that stands for a picture, unless the figure has said it."""
        if text and text in self._pictures:
            return
        self.flow.say(self.spell(text), MarkKind.IMAGE)
        if self._pictures:
            self._pictures = (*self._pictures[-7:], text)

    def figure(self, name: str, address: str) -> None:
        """Add the line that stands for a tactile picture, which is felt below it."""
        self.begin_block()
        if not self._in_row and self.place.kind is not BlockKind.NOTE:
            self._form = BlockKind.LINE
        self.flow.say(self.spell(f"figure: {name}"), MarkKind.IMAGE, self._resolve(address))
        self._pictures = (*self._pictures[-7:], name) if self._pictures else ()
        self.begin_block()

    def close(self) -> None:
        """End the document."""
        self.end_row()
        self.begin_block()
        self._emit_pages()
        if self._anchors and self._passages:  # they lead to the end then
            last = self._passages[-1]
            self._passages[-1] = replace(last, anchors=(*last.anchors, *self._anchors))
            self._anchors = []

    @property
    def _in_row(self) -> bool:
        table = self.place.table
        return table is not None and table.in_row

    def _end_block(self) -> None:
        """Write the block that was read, and then the pages that begin within its last word."""
        if self.flow.length:
            folded = self.flow.take(self.place.language)
            if not self.place.in_caption or folded.text not in self._pictures:
                self._emit(self._formed(Passage(folded.text, marks=folded.marks), folded.language))
            if self.place.in_caption:
                self._pictures = (*self._pictures[-7:], folded.text)
        self._continues = False
        self._emit_pages()

    def _turn(self) -> None:
        """Go on with the block on another page of the printed book."""
        if self.place.kind is BlockKind.HEADING or self._in_row:
            return
        self._end_block()
        if self.place.kind in (BlockKind.PARAGRAPH, BlockKind.ITEM):
            self._form = BlockKind.LINE

    def _relieve(self) -> None:
        """Write a part of a very long block."""
        if self._in_row:
            self.lay_out_table()
            return
        folded = self.flow.take_part(self.place.language)
        if folded is not None:
            part = self._formed(Passage(folded.text, marks=folded.marks), folded.language)
            self._emit(replace(part, continues=self._continues))
            self._continues = True

    def _formed(self, passage: Passage, language: str) -> Passage:
        """Give a passage the role of its place, and an item its number."""
        place = self.place
        kind, level = self._form or place.kind, place.level
        if self._form is not None:
            level = 0
        elif kind is BlockKind.ITEM and not self._fresh and not self._continues:
            kind, level = BlockKind.PARAGRAPH, 0
        text, marks = passage.text, passage.marks
        if self._fresh:
            text, marks = self._lead + text, _moved(marks, len(self._lead))
            self._fresh, self._lead = False, ""
        continues = self._continues
        return Passage(text, kind, level, marks, language, (), place.group, continues=continues)

    def _write_lines(self, text: str) -> None:
        """Add text whose lines are kept, each as a passage."""
        if self.starts_lines:
            self.starts_lines, text = False, re.sub(r"^\r?\n", "", text)
        lines = re.split(r"\r\n|\r|\n|\u2028", text.expandtabs(_TAB))
        for number, line in enumerate(lines):
            if number:
                self._end_line()
            if line:
                self.flow.write(line)
            if self.flow.is_full:
                self._relieve()

    def _end_line(self) -> None:
        if self.flow.length:
            self._end_block()
        elif self._passages and self._passages[-1].text and self.has_written:
            self._emit(Passage("", BlockKind.LINE, group=self.place.group))
            self._emit_pages()

    def _emit_pages(self) -> None:
        pages, self._pages = self._pages, []
        for number, anchors in pages:
            self._passages.append(Passage(self.spell(number), BlockKind.PAGE, anchors=anchors))

    def _emit(self, passage: Passage) -> None:
        if self._broken and passage.text:
            self._broken = False
            if passage.kind not in (BlockKind.HEADING, BlockKind.NOTE):
                self._passages.append(Passage(self.spell(BREAK)))
        self.has_written = True
        if passage.language and passage.language == self.given:
            passage = replace(passage, language="")
        if self._anchors:
            passage = replace(passage, anchors=tuple(dict.fromkeys(self._anchors)))
            self._anchors = []
        self._passages.append(passage)


def _moved(marks: tuple[Mark, ...], by: int) -> tuple[Mark, ...]:
    """Marks of a text that stands further on."""
    if not by:
        return marks
    return tuple(replace(mark, start=mark.start + by, end=mark.end + by) for mark in marks)
