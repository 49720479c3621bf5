"""Text of a block as its pieces come in: white space folded, emphasis and languages kept."""

from __future__ import annotations

from dataclasses import dataclass, replace

from vbraille.translate.levels import small_number
from vbraille.translate.source import Mark, MarkKind

LONGEST = 65_536  # characters; a longer block is passed on in passages that continue each other
# White space that HTML folds: not the no-break space, which is a character as any other.
_BLANKS = "\n\t\r\f"
# Hints to a typesetter, which would split contractions.
_DROPPED = str.maketrans("", "", "\u00ad\u200b\ufeff")
_SMALL = (MarkKind.SUPERSCRIPT, MarkKind.SUBSCRIPT)


@dataclass(slots=True)
class _Held:
    """A mark that is not closed yet; it starts at -1 as long as it has no text."""

    depth: int
    start: int
    target: str


@dataclass(frozen=True, slots=True)
class FoldedText:
    """Text of a block, with its marks and its language, for which see `Block`."""

    text: str
    marks: tuple[Mark, ...]
    language: str


class Flow:
    """The text of the block that is being read.

    Attributes
    ----------
    length : int
        Number of characters so far.
    language : str
        Tag of the language that the next text is in; empty if the source does not say.
    """

    def __init__(self) -> None:
        self.length = 0
        self.language = ""
        self._parts: list[str] = []
        self._between = ""  # what stands before the next text if any stands before that
        self._held: dict[MarkKind, _Held] = {}
        self._unstarted = False
        self._bracket = ""  # that is still to be set around a reference to a note
        self._marks: list[Mark] = []
        self._runs: list[tuple[int, str]] = []  # where each language begins
        self._most = LONGEST

    def add(self, text: str) -> None:
        """Add characters of the source, with runs of white space as one blank."""
        folded = _folded(text)
        words = folded.strip(" ")
        if folded[:1] == " ":
            self.blank()
        if words:
            self.write(words)
            if folded[-1] == " ":
                self.blank()

    def blank(self) -> None:
        """Set a blank between what was added and what will be, unless there is one already."""
        self._between = self._between or " "

    def gap(self, between: str) -> None:
        """Set what separates cells of a table between what was added and what will be."""
        self._between = between

    def write(self, text: str) -> None:
        """Add text as it is, but for small numbers and for the number of a note."""
        small = [kind for kind in _SMALL if kind in self._held]
        if self._bracket == "[":
            before = self._between or (self._parts[-1] if self._parts else "")
            self._bracket = "" if before.endswith(("[", "(")) or not text[:1].isalnum() else "]"
            text = f"[{text}" if self._bracket else text
        elif len(small) == 1 and MarkKind.NOTE not in self._held:
            text = small_number(text, small[0])
        if self._between:
            if self.length:
                self._parts.append(self._between)
                self.length += len(self._between)
            self._between = ""
        if self._unstarted:
            for held in self._held.values():
                held.start = self.length if held.start < 0 else held.start
            self._unstarted = False
        if (self._runs[-1][1] if self._runs else None) != self.language:
            self._runs.append((self.length, self.language))
        self._parts.append(text)
        self.length += len(text)

    def say(self, text: str, kind: MarkKind, target: str = "") -> None:
        """Add text that stands for something else, and mark it."""
        self.write(text)
        self._marks.append(Mark(kind, self.length - len(text), self.length, target))

    def open(self, kind: MarkKind, target: str = "") -> None:
        """Begin a part with a mark; one of the same kind inside of it is a part of it.

        A reference to a note is set apart by square brackets, unless it has others or is a sign.
        """
        held = self._held.get(kind)
        if held is not None:
            held.depth += 1
        else:
            self._held[kind] = _Held(1, -1, target)
            self._unstarted = True
            if kind is MarkKind.NOTE:
                self._bracket = "["

    def close(self, kind: MarkKind) -> None:
        """End the part that was begun last with a mark of a kind."""
        held = self._held[kind]
        held.depth -= 1
        if not held.depth:
            if kind is MarkKind.NOTE:
                between, self._between = self._between, ""
                if self._bracket == "]":
                    self.write("]")
                self._between, self._bracket = between, ""
            del self._held[kind]
            if held.start >= 0:
                self._marks.append(Mark(kind, held.start, self.length, held.target))

    def since(self, start: int) -> str:
        """Text from an index on; to be asked for where the part is short."""
        parts, length = [], self.length
        for part in reversed(self._parts):
            if length <= start:
                break
            parts.append(part)
            length -= len(part)
        return "".join(reversed(parts))[max(start - length, 0) :]

    def cut(self, start: int) -> None:
        """Take back the text from an index on."""
        text = "".join(self._parts)[:start].rstrip(" ")
        self._parts, self.length = [text], len(text)
        self._marks = _clipped(self._marks, 0, self.length)
        self._runs = [run for run in self._runs if run[0] < self.length]
        for held in self._held.values():
            if held.start >= self.length:
                held.start, self._unstarted = -1, True

    @property
    def ends_blank(self) -> bool:
        """Tell whether what was added last ends with a blank."""
        return bool(self._between)

    @property
    def is_full(self) -> bool:
        """Tell whether the text is so long that a part of it should be taken."""
        return self.length > self._most

    def take_part(self, language: str) -> FoldedText | None:
        """Take the text up to its last blank; None if it should rather grow on."""
        text = "".join(self._parts)
        self._parts = [text]
        stop = text.rfind(" ") + 1
        if not stop and self._most < 4 * LONGEST:
            self._most *= 2
            return None
        return self._take(text, stop or len(text), language)

    def take(self, language: str) -> FoldedText:
        """Take the whole text; the next block begins, with the same marks open.

        Parameters
        ----------
        language
            Tag of the block's language.
        """
        self._between = ""
        if self._bracket == "]":
            self.write("]")
        self._bracket = ""
        text = "".join(self._parts)
        return self._take(text, len(text), language)

    def _take(self, text: str, stop: int, language: str) -> FoldedText:
        marks = list(self._marks)
        marks += (
            Mark(kind, held.start, self.length, held.target)
            for kind, held in self._held.items()
            if held.start >= 0
        )
        ends = [start for start, _ in self._runs[1:]] + [self.length]
        runs = [(start, end, tag) for (start, tag), end in zip(self._runs, ends, strict=False)]
        tags = {tag for start, _, tag in runs if start < stop}
        if len(tags) == 1:
            language = tags.pop()
        foreign = [
            Mark(MarkKind.LANGUAGE, start, start + len(text[start:end].rstrip(" ")), tag)
            for start, end, tag in runs
            if tag and tag != language
        ]
        shown = _clipped(_besides_notes(marks, text) + foreign, 0, stop)
        shown.sort(key=lambda mark: (mark.start, -mark.end))
        self._marks = _clipped(self._marks, stop, self.length)
        for held in self._held.values():
            held.start = -1 if held.start < 0 or stop == self.length else max(held.start - stop, 0)
        self._unstarted = bool(self._held)
        self._runs = [(max(start - stop, 0), tag) for start, end, tag in runs if end > stop]
        self._parts = [text[stop:]]
        self.length -= stop
        self._most = LONGEST
        return FoldedText(text[:stop], tuple(shown), language)


def _folded(text: str) -> str:
    """Text with runs of white space as one blank."""
    for blank in _BLANKS:
        text = text.replace(blank, " ")
    while "  " in text:
        text = text.replace("  ", " ")
    return text if text.isascii() else text.translate(_DROPPED)


def _besides_notes(marks: list[Mark], text: str) -> list[Mark]:
    """Marks of which none says that a reference to a note is raised: brackets tell it apart."""
    notes = [mark for mark in marks if mark.kind is MarkKind.NOTE]
    if not notes:
        return marks
    found: list[Mark] = []
    for mark in marks:
        parts = [mark]
        for note in notes if mark.kind in _SMALL else ():
            before = [replace(part, end=min(part.end, note.start)) for part in parts]
            after = [replace(part, start=max(part.start, note.end)) for part in parts]
            parts = [part for part in before + after if part.start < part.end]
        whole = parts == [mark]
        found += [p for p in parts if whole or any(map(str.isalnum, text[p.start : p.end]))]
    return found


def _clipped(marks: list[Mark], start: int, stop: int) -> list[Mark]:
    """Parts of marks that are within a part of the text, counted from its start."""
    return [
        Mark(mark.kind, max(mark.start - start, 0), min(mark.end, stop) - start, mark.target)
        for mark in marks
        if mark.end > start and mark.start < stop
    ]
