"""Text of a book, whatever file it comes from: numbered blocks of text or of ready cells."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from typing import TYPE_CHECKING, Protocol

import msgspec
import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from vbraille.braille.cells import Cells


SPACE = 0x20
NO_BREAK_SPACE = 0xA0


@dataclass(frozen=True, slots=True, eq=False)
class Text:
    """A run of characters that know where they stand in the source.

    Parameters
    ----------
    codes : uint32[n]
        The characters as code points, as they are to be read: white space folded, lines joined.
    places : int64[n]
        Place of each character in the source, counted in characters from the first.
    end : int
        One past the last character of the source that belongs to the run.
    alphabet : frozenset of int
        Code points among which all of its own are. They are gathered once for
        many texts: array scans between calls of liblouis slow it by a
        fifth on processors that lower their clock for wide vectors.
    """

    codes: NDArray[np.uint32]
    places: NDArray[np.int64]
    end: int
    alphabet: frozenset[int]

    @classmethod
    def empty(cls, end: int = 0) -> Text:
        """A run of no characters, at a place of the source."""
        return cls(np.empty(0, np.uint32), np.empty(0, np.int64), end, frozenset())

    @classmethod
    def of(cls, text: str) -> Text:
        """A string that stands for itself: character i is at place i."""
        codes = to_codes(text)
        return cls(codes, np.arange(codes.size), codes.size, frozenset(codes.tolist()))

    def __str__(self) -> str:
        return to_text(self.codes)

    def __len__(self) -> int:
        return self.codes.size

    def __add__(self, other: Text) -> Text:
        return Text(
            np.concatenate((self.codes, other.codes)),
            np.concatenate((self.places, other.places)),
            other.end,
            self.alphabet | other.alphabet,
        )

    def index(self, character: int) -> int:
        """Index of the first character that stands at a place of the source or after it."""
        return int(np.searchsorted(self.places, character))

    def since(self, character: int) -> Text:
        """Part from a source character on; nothing of the rest is kept in memory."""
        at = self.index(character)
        return Text(self.codes[at:].copy(), self.places[at:].copy(), self.end, self.alphabet)


def to_codes(text: str) -> NDArray[np.uint32]:
    """Code points of a string, lone surrogates included."""
    return np.frombuffer(text.encode("utf-32-le", "surrogatepass"), np.uint32)


def to_text(codes: NDArray[np.uint32]) -> str:
    """String of code points, lone surrogates included."""
    return codes.astype("<u4").tobytes().decode("utf-32-le", "surrogatepass")


class BlockKind(Enum):
    """Role of a block in its text."""

    PARAGRAPH = "paragraph"
    HEADING = "heading"
    """The title of a part; its level is 1 for the largest parts."""
    ITEM = "item"
    """An item of a list; its level is 1 in a list that stands in no other."""
    ROW = "row"
    """A row of a table."""
    LINE = "line"
    """A line that begins where the source begins it: of verse, of code, of a braille file."""
    QUOTE = "quote"
    """A paragraph that is quoted; its level is 1 where no other quotation is around it."""
    NOTE = "note"
    """A footnote or an endnote, at the place where its format has it."""
    PAGE = "page"
    """The place where a page begins, of print or of a braille file; `page_number` is its number."""


_LEVELLED = (BlockKind.HEADING, BlockKind.ITEM, BlockKind.QUOTE)


class MarkKind(Enum):
    """Kind of a mark on a part of a block's text."""

    ITALIC = "italic"
    BOLD = "bold"
    UNDERLINE = "underline"
    SUPERSCRIPT = "superscript"
    SUBSCRIPT = "subscript"
    CODE = "code"
    """Computer code."""
    LANGUAGE = "language"
    """Text in another language than the block's; the target is its tag, such as "fr"."""
    LINK = "link"
    """A link; the target is an address, or "#" and the name of an anchor of this source."""
    NOTE = "note"
    """A reference to a note; the target is "#" and the name of the note's anchor."""
    IMAGE = "image"
    """The text that stands for a picture; of a tactile one that the source shows as a figure, the
    target says which file that is, in the way of the source."""
    UNSHOWN = "unshown"
    """A remark on something that cannot be shown; the target is what it is, such as "formula"."""


@dataclass(frozen=True, slots=True)
class Mark:
    """Something that is so about a part of a text.

    Parameters
    ----------
    kind
        What is so.
    start, end
        First character of the part and one past its last, as places of the source.
    target
        Address, anchor, language, file or thing that the kind speaks of; empty for other kinds.
    """

    kind: MarkKind
    start: int
    end: int
    target: str = ""


@dataclass(frozen=True, slots=True, eq=False)
class Block:
    """A block of a source, or a piece of a very long one.

    Parameters
    ----------
    text : Text
        Characters of the block. If the cells are ready, these are the source's way to write them.
    kind : BlockKind
        Role of the block in its text.
    level : int
        Depth of a heading or an item, from 1; 0 for all other kinds.
    cells : Cells or None
        The block in braille, if the source has it in braille; None if its text is to be translated.
    continues : bool
        Whether this piece goes on where the block before it broke off.
    marks : tuple of Mark
        Emphasis, links, languages and the like, by where they begin, outer ones first.
    language : str
        Tag of the block's language, such as "fr"; empty if the source does not say.
    anchors : tuple of str
        Names by which links and references to notes find the block.
    group : int
        Number of the list or table that the block is part of, from 1 in the order of the source.
        Where a page begins that the source counts without writing its number, as braille files do
        with pages between form feeds, that number. 0 for others.
    headers : tuple of str
        For a row of a table: the header of each of its cells, if the source has headers.

    Raises
    ------
    ValueError
        If a heading, an item or a quote has no level, or another block has one.
    """

    text: Text
    kind: BlockKind = BlockKind.PARAGRAPH
    level: int = 0
    cells: Cells | None = None
    continues: bool = False
    marks: tuple[Mark, ...] = ()
    language: str = ""
    anchors: tuple[str, ...] = ()
    group: int = 0
    headers: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        levelled = self.kind in _LEVELLED
        if (self.level > 0) != levelled or self.level < 0:
            wanted = "1 or more" if levelled else "0"
            raise ValueError(
                f"level of kind {self.kind.value} is {self.level}; it must be {wanted}"
            )

    @property
    def page_number(self) -> str:
        """Number of the page that begins here, as the source writes or counts it; empty if none."""
        if self.kind is not BlockKind.PAGE:
            return ""
        return str(self.text).strip() or (str(self.group) if self.group else "")


class Index(msgspec.Struct, frozen=True):
    """Places of a source's blocks, so that a later opening need not find them again.

    Parameters
    ----------
    form
        Name of the source's class and of the form of its rows, with a version.
    fits
        Values that must be the same for the index to be taken over, such as the file's size.
    rows
        What is known, in the source's own form; each row is numbers and text.
    complete
        Whether the index reaches to the end.
    """

    form: str
    fits: tuple[str | int, ...]
    rows: tuple[tuple[int | str, ...], ...]
    complete: bool = False


class Source(Protocol):
    """A text as blocks, read only as far as its blocks are asked for.

    Its characters are counted from 0; a block knows which of them it stands for.
    """

    @property
    def name(self) -> str:
        """Name of the source in messages."""
        ...

    @property
    def title(self) -> str:
        """Title of the book, as the source has it; empty if it has none."""
        ...

    @property
    def language(self) -> str:
        """Tag of the language that most of the source is in; empty if it does not say."""
        ...

    @property
    def in_cells(self) -> bool:
        """Tell whether all blocks have ready cells, so that no table is needed."""
        ...

    def block(self, number: int) -> Block | None:
        """Block of a number, from 0; None past the end.

        Raises
        ------
        InputError
            If the source cannot be read any more.
        """
        ...

    def block_at(self, character: int) -> int | None:
        """Number of the block that holds a character, or of the next block; None past the end."""
        ...

    def anchor(self, name: str) -> int | None:
        """Place of the first character of the block with an anchor; None if there is none."""
        ...

    def index(self) -> Index:
        """Tell what is known so far of where blocks are, to be kept for another time."""
        ...

    def adopt(self, index: Index) -> None:
        """Take over what was known of the same file at another time; of another file, nothing."""
        ...

    @property
    def complete(self) -> bool:
        """Tell whether all blocks are known, so that the source's end is."""
        ...

    @property
    def end(self) -> int:
        """One past the last character that is known; of a complete source, past its last."""
        ...

    def progress(self, number: int) -> float:
        """About how much of the source stands before a block that was read, 0 to 1."""
        ...

    def note(self) -> str | None:
        """Note on the source, given once after its cause is found; None if there is none."""
        ...

    def sha256(self) -> str:
        """SHA-256 of the bytes that the source was read from, in hexadecimal."""
        ...

    def close(self) -> None:
        """Let go of the file, after which no block can be read; further calls do nothing."""
        ...


def share_before(source: Source, character: int) -> float:
    """Share of a source before a character, 0 to 1: the measure of all places in a book.

    It is counted in characters of the text, which are the same in whatever form the book is; about,
    by the size of what was read, as long as the source is not complete.
    """
    if source.complete:
        return min(character / max(source.end, 1), 1.0)
    number = source.block_at(character)
    return 1.0 if number is None else source.progress(number)
