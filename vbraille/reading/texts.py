# ruff: noqa: D101, D102, D103, B018
"""Stand-in for the door of the text's rooms, until they have it themselves."""

from __future__ import annotations

from bisect import bisect_right
from dataclasses import dataclass
from typing import NamedTuple

from vbraille.layout.pages import Layout as _Layout
from vbraille.translate import BlockKind
from vbraille.translate import Book as _Book
from vbraille.translate.source import Mark


class Heading(NamedTuple):
    level: int
    title: str
    place: int
    page: str


@dataclass(frozen=True)
class Block:
    old: object
    number: int
    start: int
    text: str
    marks: tuple

    def __getattr__(self, name):
        return getattr(self.old, name)

    @property
    def end(self):
        return self.start + len(self.text)

    @property
    def words(self):
        return " ".join(self.text.split())

    @property
    def heading(self):
        if self.kind is BlockKind.HEADING and not self.continues:
            return self.level, self.words
        return None


class Source:
    def __init__(self, old):
        self.old = old
        self._blocks = []
        self._starts = []
        self._end = 0
        self.complete = False
        self._whole = ""

    def __getattr__(self, name):
        return getattr(self.old, name)

    def gather(self, blocks):
        for _ in range(blocks):
            if self.complete:
                break
            old = self.old.block(len(self._blocks))
            if old is None:
                self.complete = True
                break
            text = str(old.text)
            marks = tuple(
                Mark(m.kind, old.text.index(m.start), old.text.index(m.end), m.target)
                for m in old.marks
            )
            self._blocks.append(Block(old, len(self._blocks), self._end, text, marks))
            self._starts.append(self._end)
            self._end += len(text) + 1
        return self.complete

    @property
    def end(self):
        return self._end

    def block(self, number):
        while number >= len(self._blocks) and not self.gather(100):
            pass
        return self._blocks[number] if 0 <= number < len(self._blocks) else None

    def blocks(self, number=0, step=1):
        while number >= 0 and (block := self.block(number)) is not None:
            yield block
            number += step

    def block_at(self, place):
        while place >= self._end and not self.gather(100):
            pass
        number = bisect_right(self._starts, place) - 1
        return self._blocks[number] if place < self._end and number >= 0 else None

    @property
    def text(self):
        while not self.gather(1000):
            pass
        if len(self._whole) < self._end:
            self._whole = "\n".join(b.text for b in self._blocks) + "\n"
        return self._whole

    def anchor(self, name):
        old = self.old.anchor(name)
        return None if old is None else self.new(old)

    def new(self, old_place):
        number = self.old.block_at(old_place)
        if number is None:
            return self._end
        block = self.block(number)
        return block.start + min(block.old.text.index(old_place), len(block.text))

    def before(self, place):
        block = self.block_at(place)
        if block is None:
            return None
        text, at = block.old.text, place - block.start
        return int(text.places[at]) if at < len(text) else text.end

    def progress(self, place):
        if self.complete:
            return min(place / max(self._end, 1), 1)
        block = self.block_at(place)
        return 1.0 if block is None else self.old.progress(block.number)

    def headings(self):
        self.text
        found, page = [], ""
        for b in self._blocks:
            page = b.page_number or page
            if b.heading:
                found.append(Heading(*b.heading, b.start, page))
        return found

    def notes(self):
        note = self.old.note()
        return [note] if note else []

    def file(self, address):
        return self.old.member(address.removeprefix("#"))


class Book:
    def __init__(self, source, table=None, *, language="", grade=None, switch=True):
        self.source, self.table, self.language = source, table, language
        self.grade, self.switch = grade, switch
        self.old = (
            _Book(source.old, table, language=language, grade=grade, switch=switch)
            if table
            else _Book(source.old)
        )

    def notes(self):
        return list(self.old.notes())


def wrapped(old):
    made = Book.__new__(Book)
    made.source, made.table, made.old = Source(old.source), old.table, old
    made.language, made.grade, made.switch = "", None, old.switch
    return made


class Line:
    def __init__(self, layout, old):
        self.layout, self.old = layout, old
        self.id = old.number
        self.block = layout.book.source.block(layout.old.block_of(old))
        for name in ("indent", "masks", "printed", "text", "word", "cells", "first", "after"):
            setattr(self, name, getattr(old, name))

    def __eq__(self, other):
        return isinstance(other, Line) and self.id == other.id

    def __len__(self):
        return len(self.old)

    @property
    def place(self):
        return self.layout.book.source.new(self.old.place)

    @property
    def end(self):
        return self.block.start + self.old.after

    def source(self, cell):
        span = self.old.source(cell)
        if span is None:
            return None
        text = self.old.block.text
        return tuple(self.block.start + text.index(p) for p in span)

    def cell_of(self, place):
        return self.old.cell_of(self.layout.book.source.before(place))


class Layout:
    def __init__(self, book, width):
        self.book, self.width = book, width
        self.old = _Layout(book.old, width)

    def _line(self, old):
        return None if old is None else Line(self, old)

    def first(self):
        return self.line(1)

    def last(self):
        return self.line(self.count())

    def beside(self, line, step=1):
        return self._line(self.old.line(line.old.number + step))

    def line(self, number):
        return self._line(self.old.line(number))

    def count(self):
        return self.old.count()

    def number(self, line):
        return self.old.number_of(line.old)

    def place(self, place):
        old = self.book.source.before(place)
        found = None if old is None else self.old.place(old)
        return None if found is None else (self._line(found[0]), found[1])

    def progress(self, line):
        return self.book.source.progress(line.place)
