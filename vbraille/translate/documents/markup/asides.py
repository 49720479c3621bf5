"""Parts of a document that are not read as text, but looked through for what stands for them."""

from __future__ import annotations

from typing import Protocol

# HTML in a drawing, by which its author, or a parser that mends a mistake, leaves the drawing.
_HTML_NAMES = (
    "b big blockquote body br center code dd div dl dt em embed h1 h2 h3 h4 h5 h6 head hr i "
    "img li listing menu meta nobr ol p pre ruby s small span strong strike sub sup table tt "
    "u ul var"
)
_HTML = frozenset(_HTML_NAMES.split())
_LINEAR_NAMES = "math mrow mi mn mo mtext mspace mstyle semantics none"
_LINEAR = frozenset(_LINEAR_NAMES.split())
_MOST = 65_536  # characters of an aside


class Aside(Protocol):
    """A part of a document that is passed over."""

    def start(self, name: str) -> bool:
        """Take the start of an element within; tell whether it is to be read as text after all."""
        ...

    def end(self) -> None:
        """Take the end of the element that was begun last, unless that is read as text."""
        ...

    def text(self, text: str) -> None:
        """Take text of the elements that were begun."""
        ...


class Collected:
    """An aside that is all text, such as a title or the number of a page."""

    def __init__(self) -> None:
        self._parts: list[str] = []
        self._length = 0

    def start(self, name: str) -> bool:  # noqa: ARG002
        """Pass over an element."""
        return False

    def end(self) -> None:
        """Pass over the end of an element."""

    def text(self, text: str) -> None:
        """Keep the text."""
        if self._length < _MOST:
            self._parts.append(text)
            self._length += len(text)

    @property
    def found(self) -> str:
        """The text, with white space folded."""
        return " ".join("".join(self._parts).split())


class Drawing:
    """A drawing in SVG: its title stands for it, and HTML in it is read as text."""

    def __init__(self) -> None:
        self._path: list[str] = []
        self._title = Collected()

    def start(self, name: str) -> bool:
        """Take the start of an element of the drawing, or of HTML in it."""
        if name in _HTML:
            return True
        self._path.append(name)
        return False

    def end(self) -> None:
        """Take the end of an element of the drawing."""
        self._path.pop()

    def text(self, text: str) -> None:
        """Keep the drawing's title."""
        if self._path == ["title"]:
            self._title.text(text)

    @property
    def found(self) -> str:
        """Title of the drawing; empty if it has none."""
        return self._title.found


class Formula:
    """A formula in MathML: its TeX stands for it, or its text if that is one row of signs."""

    def __init__(self) -> None:
        self._tex = Collected()
        self._row = Collected()
        self._linear = True
        self._notes: list[str] = []  # of each open element: the note on the formula it is within

    def start(self, name: str) -> bool:
        """Take the start of an element of the formula."""
        within = self._notes[-1] if self._notes else ""
        self._notes.append(within or (name if name.startswith("annotation") else ""))
        self._linear = self._linear and (self._notes[-1] != "" or name in _LINEAR)
        return False

    def end(self) -> None:
        """Take the end of an element of the formula."""
        self._notes.pop()

    def text(self, text: str) -> None:
        """Keep the text."""
        within = self._notes[-1] if self._notes else ""
        if within != "annotation-xml":  # the same formula once more, by its meaning
            (self._tex if within else self._row).text(text)

    @property
    def found(self) -> str:
        """TeX of the formula, or its signs; empty if neither says what it is."""
        return self._tex.found or (self._row.found if self._linear else "")
