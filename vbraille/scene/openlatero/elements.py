"""Elements of OpenLatero's files: trees of XML whose values are read one by one, leniently.

Whatever is not asked for by the time that all is read was not understood, and is said.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, NamedTuple

from vbraille.errors import InputError
from vbraille.scene.measures import MOST_MM
from vbraille.wording import count, nearest, printable

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator, Mapping
    from typing import Any

    from vbraille.scene.measures import Point


_MOST_LINES = 5  # that one remark names, when it holds for many places


@dataclass(slots=True)
class Remarks:
    """Remarks on places of a file, as they come."""

    _lines: dict[tuple[str, str], list[int]] = field(default_factory=dict)

    def add(self, line: int, element: str, text: str) -> None:
        """Say something about an element.

        Parameters
        ----------
        line
            Line at which it begins, from 1.
        element
            What it is, such as "Circle".
        text
            The rest of the sentence.
        """
        self._lines.setdefault((element, text), []).append(line)

    def listed(self) -> tuple[str, ...]:
        """All remarks, in the order of their first lines; what holds at many places is said once.

        >>> remarks = Remarks()
        >>> for line in (9, 4):
        ...     remarks.add(line, "Circle", "its icon is ignored")
        >>> remarks.listed()
        ('line 4, Circle: its icon is ignored (and line 9)',)
        """
        found = sorted((sorted(set(lines)), *key) for key, lines in self._lines.items())
        return tuple(
            f"line {lines[0]}, {element}: {text}{_others(lines[1:])}"
            for lines, element, text in found
        )


def _others(lines: list[int]) -> str:
    """Other lines for which a remark holds."""
    if not lines:
        return ""
    named = ", ".join(map(str, lines[:_MOST_LINES]))
    more = len(lines) - _MOST_LINES
    rest = f" and {more} more" if more > 0 else ""
    return f" (and line{'s' if len(lines) > 1 else ''} {named}{rest})"


MOST_BYTES = 20_000_000
MOST_ELEMENTS = 200_000
DEEPEST = 100
_MOST_FAULTS = 5  # of broken XML that are said one by one


def read_tree(content: bytes, name: str, remarks: Remarks) -> GenElement:
    """Read a text of XML as elements.

    Nothing is looked up elsewhere, and no entity is expanded.

    Parameters
    ----------
    content
        The text.
    name
        Name of its file, for messages.
    remarks
        Where it is said what was broken.

    Returns
    -------
    GenElement
        The root.

    Raises
    ------
    InputError
        If it is no XML, declares entities, or is far too large or deep.
    """
    from lxml import etree

    if b"<!ENTITY" in content:
        raise _entities(name)
    # Broken files are read as far as they can be; what was broken is said.
    parser = etree.XMLParser(
        recover=True, resolve_entities=False, no_network=True, load_dtd=False, huge_tree=False,
        remove_comments=True, remove_pis=True,
    )  # fmt: skip
    try:
        root: Any = etree.fromstring(content, parser)
    except (etree.XMLSyntaxError, ValueError):
        root = None
    if root is None:
        raise InputError(f"{name} is no XML; give a file that OpenLatero wrote")
    declared: Any = root.getroottree().docinfo.internalDTD
    if declared is not None and any(True for _ in declared.iterentities()):
        raise _entities(name)
    if root.xpath("count(//*)") > MOST_ELEMENTS:
        raise InputError(f"{name} has more than {MOST_ELEMENTS} elements; split the picture in two")
    _say_faults(parser, remarks)
    return _elements(root, name, remarks)


def _entities(name: str) -> InputError:
    return InputError(f"{name} declares entities, which OpenLatero's files have none of; remove it")


def _say_faults(parser: Any, remarks: Remarks) -> None:
    """Say where the XML is broken."""
    faults: dict[int, str] = {}
    for entry in parser.error_log:
        faults.setdefault(entry.line, printable(str(entry.message)))
    for line, message in sorted(faults.items())[:_MOST_FAULTS]:
        remarks.add(line, "XML", f"it is broken here, and read as far as it can be: {message}")
    if len(faults) > _MOST_FAULTS:
        more = count(len(faults) - _MOST_FAULTS, "more line")
        remarks.add(sorted(faults)[_MOST_FAULTS], "XML", f"it is broken here and in {more}")


def _elements(root: Any, name: str, remarks: Remarks) -> GenElement:
    """Elements for those of the library, without going through them by recursion."""
    top = _element(root, None, remarks)
    left: list[tuple[Any, GenElement, int]] = [(root, top, 1)]
    while left:
        xml, element, depth = left.pop()
        for inner in xml:
            if not isinstance(inner.tag, str):  # an entity that is declared nowhere
                element.say(f"the entity {printable(inner.text or '')} is ignored")
                continue
            if depth >= DEEPEST:
                raise InputError(f"{name} line {inner.sourceline}: its elements nest too deep")
            child = _element(inner, element, remarks)
            element.children.append(child)
            left.append((inner, child, depth + 1))
    return top


def _element(xml: Any, above: GenElement | None, remarks: Remarks) -> GenElement:
    name = printable(xml.tag.rpartition("}")[2])
    attributes = {key: printable(value) for key, value in xml.attrib.items()}
    owner, path = (above.owner, f"{above.path} {name}".strip()) if above else (name, "")
    if name in ("Pattern", "Generator"):
        owner, path = attributes.get("subtype") or attributes.get("type") or name, ""
    line = xml.sourceline or 1
    return GenElement(name, line, attributes, xml.text or "", remarks, owner, path)


# Numbers as C reads them, which is independent of the locale here.
_NUMBER = r"[+-]?(?:\d+(?:\.\d*)?|\.\d+)(?:[eE][+-]?\d{1,3})?"
_LEADING = re.compile(_NUMBER)
_DECIMAL_COMMA = re.compile(r"([+-]?\d+),(\d+)(?![\d,.])")
_POINT = re.compile(rf"({_NUMBER})\s*,\s*({_NUMBER})")
_COMMAS = re.compile(r"([+-]?\d+),(\d+),([+-]?\d+)(?:,(\d+))?")
_LONGEST = 40  # characters of a quoted text
_MEANT = {"degree": "°", "degree/s": "°/s"}  # units that the files name otherwise
# Units that OpenLatero writes, and that are the same thing to it where it reads.
_SAME = {"°": ("deg", "degrees", "°"), "share": ("%", "")}


class GenElement:
    """An element of a file, with what was asked of it.

    Attributes
    ----------
    fields : mapping of str to Field
        Table of the values that an element of its kind has in it.

    Parameters
    ----------
    name
        Name of the element, without a namespace.
    line
        Line at which it begins, from 1.
    attributes
        Attributes of the element.
    text
        Text in it before its first element.
    remarks
        What is said about the file.
    owner
        What the pattern that it belongs to is, such as "Circle".
    path
        Names of the elements that lead to it from that pattern.
    """

    __slots__ = (
        "_asked", "_attributes", "children", "fields", "line", "name", "owner", "path", "remarks",
        "text",
    )  # fmt: skip

    def __init__(
        self,
        name: str,
        line: int,
        attributes: dict[str, str],
        text: str,
        remarks: Remarks,
        owner: str = "",
        path: str = "",
    ) -> None:
        self.name = name
        self.line = line
        self.text = text
        self.owner = owner
        self.path = path
        self.remarks = remarks
        self.children: list[GenElement] = []
        self.fields: Mapping[str, Field] = {}
        self._attributes = attributes
        self._asked = False

    def attribute(self, name: str) -> str:
        """Value of an attribute; empty if it is not there."""
        return self._attributes.get(name, "").strip()

    def say(self, text: str) -> None:
        """Say something about the pattern, at the line of this element."""
        self.remarks.add(self.line, self.owner, text)

    def one(self, name: str, fields: Mapping[str, Field] | None = None) -> GenElement | None:
        """First element of a name in this one, with a table of its fields.

        OpenLatero ignores others, so they are said.
        """
        found = self.every(name)
        for other in found[1:]:
            other.forget()
            other.say(f"another {other.path} is ignored, since the first counts")
        if not found:
            return None
        found[0].fields = fields or {}
        return found[0]

    def part(self, name: str, fields: Mapping[str, Field] | None = None) -> GenElement:
        """First element of a name in this one, or one without anything in it."""
        found = self.one(name, fields)
        if found is None:
            path = f"{self.path} {name}".strip()
            found = GenElement(name, self.line, {}, "", self.remarks, self.owner, path)
            found.fields = fields or {}
        return found

    def every(self, name: str) -> list[GenElement]:
        """All elements of a name in this one."""
        found = [child for child in self.children if child.name == name]
        for child in found:
            child._asked = True
        return found

    def skip(self, *names: str) -> None:
        """Leave elements of some names out without a word, since nothing depends on them."""
        for name in names:
            for child in self.every(name):
                child.forget()

    def forget(self) -> None:
        """Leave out all that is in this element."""
        left: list[GenElement] = [self]
        while left:
            element = left.pop()
            element._asked = True
            left += element.children

    def unasked(self) -> Iterator[GenElement]:
        """Elements that no reader asked for, but not what is in them."""
        left: list[GenElement] = [self]
        while left:
            for child in left.pop().children:
                if child._asked:
                    left.append(child)
                else:
                    yield child

    def __getitem__(self, name: str) -> Any:
        """Value of a field that this element has by the table of its kind."""
        return self.read(name, self.fields[name])

    def read(self, name: str, field: Field) -> Any:
        """Value of a field; what OpenLatero takes if it is not there."""
        element = self.one(name)
        return field.default if element is None else field.read(element)

    def chosen(self, text: str, words: Collection[str], default: str) -> str:
        """One of a few words for a text, or what counts for others, which is said."""
        word = cleaned(text)
        for known in (word, word.lower()):
            if known in words:
                return known
        self.say(
            f'{self.path} "{_short(word)}" is not known, so "{default}" is taken'
            f"{nearest(word, words)}"
        )
        return default

    def units(self) -> str:
        """Units that this element names, as they are said here."""
        named = self.attribute("units")
        return _MEANT.get(named, named)

    def check_units(self, unit: str) -> None:
        """Say so if the units that are named are not those that count."""
        named = self.units()
        if named and named not in (unit, *_SAME.get(unit, ())):
            counts = "a share from 0 to 1" if unit == "share" else unit or "a plain number"
            self.say(f"{self.path} is in {counts}, although its units say {_short(named)}")


class NumberField(NamedTuple):
    """A number.

    Parameters
    ----------
    default
        What OpenLatero takes if it is not there.
    low, high
        The range of it here; what is outside is put to its nearest end, and said.
    unit
        Unit that counts: "mm", "°", "Hz", "share" for a fraction of 1, or empty for none.
    """

    default: float
    low: float = 0.0
    high: float = MOST_MM
    unit: str = "mm"

    def read(self, element: GenElement) -> float:
        """Number of an element, within the range."""
        element.check_units(self.unit)
        value = self._value(element)
        if self.low <= value <= self.high:
            return value
        clamped = min(max(value, self.low), self.high)
        share = self.unit == "share" and value > 1
        element.say(
            f"{element.path} is {value:g}, and {'shares are' if share else 'it must be'} "
            f"{self.low:g} to {self.high:g}; {clamped:g} is taken"
        )
        return clamped

    def _value(self, element: GenElement) -> float:
        """Number that the text of an element begins with."""
        text = cleaned(element.text)
        comma = _DECIMAL_COMMA.match(text)
        found = comma or _LEADING.match(text)
        if found is None:
            what = f'"{_short(text)}", which is no number' if text else "empty"
            element.say(f"{element.path} is {what}; {self.default:g} is taken")
            return self.default
        value = float(found[0].replace(",", "."))
        if not math.isfinite(value):
            element.say(f"{element.path} is too large a number; {self.default:g} is taken")
            return self.default
        if comma:
            element.say(f'{element.path} "{_short(text)}" has a decimal comma; {value:g} is taken')
        elif found[0] != text:
            rest = text[found.end() :].strip()
            element.say(f'{element.path} has "{_short(rest)}" after its number, which is ignored')
        return value


SHARE = NumberField(1.0, 0.0, 1.0, "share")
ANGLE = NumberField(0.0, -1e6, 1e6, "°")


class YesNoField(NamedTuple):
    """A yes or no."""

    default: bool

    def read(self, element: GenElement) -> bool:
        """Tell whether an element says yes."""
        word = cleaned(element.text).lower()
        if word not in ("yes", "true", "no", "false"):
            said = _short(element.text)
            element.say(f'{element.path} is "{said}", neither yes nor no; no is taken')
        return word in ("yes", "true")


OFF, ON = YesNoField(False), YesNoField(True)


class WordField(NamedTuple):
    """One of a few words, and what counts for all others."""

    default: str
    words: Collection[str]

    def read(self, element: GenElement) -> str:
        """Word of an element."""
        return element.chosen(element.text, self.words, self.default)


class PlaceField(NamedTuple):
    """A place, x and y in mm."""

    default: Point = (0.0, 0.0)

    def read(self, element: GenElement) -> Point:
        """Place that an element gives.

        The comma is between x and y. Programs whose language has decimal commas wrote some files
        so, too: four numbers are two with decimals, and three are taken as that program would read
        them.
        """
        element.check_units("mm")
        text = cleaned(element.text)
        said = f'{element.path} "{_short(text)}"'
        commas = _COMMAS.fullmatch(text)
        if commas:
            x = float(f"{commas[1]}.{commas[2]}")
            y = float(f"{commas[3]}.{commas[4] or 0}")
            element.say(f"{said} has decimal commas; {x:g}, {y:g} is taken")
            return (x, y)
        found = _POINT.match(text)
        point = (float(found[1]), float(found[2])) if found else self.default
        if not found or not all(map(math.isfinite, point)):
            x, y = self.default
            element.say(f'{said} is no place "x,y"; {x:g},{y:g} is taken')
            return self.default
        if found[0] != text:
            rest = text[found.end() :]
            element.say(f'{element.path} has "{_short(rest)}" after its numbers, which is ignored')
        return point


ORIGIN = PlaceField()
Field = NumberField | YesNoField | WordField | PlaceField


def cleaned(text: str) -> str:
    r"""Text without blanks around it, and without the stray ``\`` that some files have."""
    return text.strip().rstrip("\\").strip()


def _short(text: str) -> str:
    said = printable(" ".join(text.split()))
    return said if len(said) <= _LONGEST else f"{said[:_LONGEST]}…"
