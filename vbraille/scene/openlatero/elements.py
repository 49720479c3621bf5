"""Elements of OpenLatero's files, read by the table leniently.

What is not understood, or is taken otherwise, is said.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from contextlib import suppress
from copy import copy
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from vbraille.errors import InputError
from vbraille.scene.measures import LEAST_FREQUENCY_HZ, MOST_FREQUENCY_HZ, MOST_MM
from vbraille.scene.openlatero.table import rows_of
from vbraille.scene.signals import MOST_SIGNALS
from vbraille.wording import nearest, printable

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path

    from vbraille.scene.measures import Point
    from vbraille.scene.openlatero.table import Row
    from vbraille.scene.patterns import AnyPattern
    from vbraille.scene.signals import AnySignal

MOST_BYTES = 20_000_000
MOST_ELEMENTS = 200_000
_MOST_FAULTS = 5  # of broken XML that are said
_MOST_LINES = 5  # that one remark names, when it holds for many places


class Remarks(dict[tuple[str, str], list[int]]):
    """Lines of a file by the element, such as "Circle", and the sentence that is said about it."""

    def listed(self) -> tuple[str, ...]:
        """All remarks, in the order of their first lines; what holds at many places is said once.

        >>> Remarks({("Circle", "its icon is ignored"): [9, 4]}).listed()
        ('line 4, Circle: its icon is ignored (and line 9)',)
        """
        found = sorted((sorted(set(lines)), *key) for key, lines in self.items())
        return tuple(
            f"line {lines[0]}, {element}: {text}{_others(lines[1:])}"
            for lines, element, text in found
        )


def _others(lines: list[int]) -> str:
    """Other lines for which a remark holds."""
    if not lines:
        return ""
    more = len(lines) - _MOST_LINES
    rest = f" and {more} more" if more > 0 else ""
    named = ", ".join(map(str, lines[:_MOST_LINES]))
    return f" (and line{'s' if len(lines) > 1 else ''} {named}{rest})"


@dataclass(frozen=True, slots=True)
class Context:
    """Facts of a file while it is read.

    Parameters
    ----------
    folder
        Folder of the file, from which the names of pictures are seen.
    as_shown
        Whether the picture is to be as OpenLatero shows it, where that is not what the file says.
    remarks
        What is said about the file.
    signals
        Signals of the scene, as they come.
    usual
        Values of elements that are not there, by their names and rows.
    made
        Patterns that were made, with the lines of their elements, by their ids.
    """

    folder: Path
    as_shown: bool
    remarks: Remarks = field(default_factory=Remarks)
    signals: dict[str, AnySignal] = field(default_factory=dict)
    usual: dict[tuple[str, Row], Any] = field(default_factory=dict)
    made: dict[int, tuple[AnyPattern, int]] = field(default_factory=dict)

    def signal(self, name: str, signal: AnySignal) -> str:
        """Name of a signal, which is called by a name and a number if others have that name."""
        for known, other in self.signals.items():
            if other == signal:
                return known
        if len(self.signals) == MOST_SIGNALS:
            raise ValueError(f"a scene has at most {MOST_SIGNALS} signals")
        own = f"{name}-{len(self.signals) + 1}" if name in self.signals else name
        self.signals[own] = signal
        return own

    def truncated(self, rate: float, cycle: float = 1.0) -> float:
        """Frequency, or speed of cycles of a length, that is shown for one that is written.

        Periods have whole microseconds in OpenLatero.
        """
        period_us = math.floor(1e6 * cycle / abs(rate)) if rate else 0
        if not self.as_shown or period_us < 1:
            return rate
        return math.copysign(1e6 * cycle / period_us, rate)


class Element:
    """An element of a file, with the values that the table says it has, by their names in it.

    Attributes
    ----------
    here : dict
        Values that have a name in our scenes, by these.
    given : set of str
        Names of the elements in it.
    there : bool
        Whether it stands in the file.
    line, text
        Line at which it begins, from 1, and the text in it before its first element.
    owner, path
        What the pattern that it belongs to is, such as "Circle", and the names of the elements that
        lead to it from that pattern.

    Parameters
    ----------
    xml
        The element of the library.
    context
        What is known about the file.
    above
        The element that it is in; None for the root.
    tables
        Names by which the table tells what is in it; none if its text is all that counts.
    """

    def __init__(
        self, xml: Any, context: Context, above: Element | None = None, *tables: str
    ) -> None:
        self.xml, self.context = xml, context
        self.tag = printable(xml.tag.rpartition("}")[2])
        self.remarks = above.remarks if above else context.remarks
        self.line: int = xml.sourceline or (above.line if above else 1)
        self.text = (xml.text or "").strip().rstrip("\\").strip()  # which some files have astray
        self.owner, self.path = self.tag, ""
        if self.tag in ("Pattern", "Generator"):
            self.owner = self.attribute("subtype") or self.attribute("type") or self.tag
        elif above is not None:
            self.owner, self.path = above.owner, f"{above.path} {self.tag}".strip()
        self.there = xml.getparent() is not None
        self.given: set[str] = set()
        self.here: dict[str, Any] = {}
        if tables:
            self._fill({key: row for table in tables for key, row in rows_of(table).items()})

    if TYPE_CHECKING:

        def __getattr__(self, name: str) -> Any: ...

    def attribute(self, name: str) -> str:
        """Value of an attribute; empty if it is not there."""
        return printable(self.xml.get(name, "")).strip()

    def say(self, text: str) -> None:
        """Say something about the pattern, at the line of this element."""
        self.remarks.setdefault((self.owner, text), []).append(self.line)

    def word(self, text: str, words: Iterable[str], usual: str) -> str:
        """One of a few words for a text, or the usual one for others, which is said."""
        for known in (text, text.lower()):
            if known in words:
                return known
        near = nearest(text, words)
        self.say(f'{self.path} "{_short(text)}" is not known, so "{usual}" is taken{near}')
        return usual

    def _fill(self, rows: dict[str, Row]) -> None:
        """Read the elements in this one by their rows; parts that are not there are as usual."""
        from lxml import etree

        found: dict[str, list[Any]] = {}
        for xml in self.xml.iterchildren("*"):
            found.setdefault(etree.QName(xml).localname, []).append(xml)
        self.given |= found.keys()
        for name, row in rows.items():
            written = found.pop(name, [])
            if row.kind in _SEVERAL:
                kind = _SEVERAL[row.kind]
                setattr(self, name, [_value(self, xml, row._replace(kind=kind)) for xml in written])
                continue
            self._pass_over(written[1:], "another {} is ignored, since the first counts")
            value = _value(self, written[0], row) if written else self._usual(name, row)
            setattr(self, name, value)
            if row.here:
                self.here[row.here] = value
            if name == "enable" and not value:
                self.remarks = Remarks()  # no more is said of what is off
        for written in found.values():
            self._pass_over(written, "{} is not known here, and ignored")

    def _usual(self, name: str, row: Row) -> Any:
        """Value of an element that is not there, which is made once; a part stands at this one."""
        from lxml import etree

        known = self.context.usual
        if (name, row) not in known:
            known[name, row] = _value(self, etree.Element(name), row)
        value = known[name, row]
        if isinstance(value, Element):
            value = copy(value)
            value.owner, value.line, value.remarks = self.owner, self.line, self.remarks
            value.path = f"{self.path} {name}".strip()
        return value

    def _pass_over(self, written: list[Any], text: str) -> None:
        for xml in written:
            other = Element(xml, self.context, self)
            other.say(text.format(other.path or f"{other.tag} {other.attribute('type')}".strip()))


# Kinds of elements of which there may be several, and what each of them is.
_SEVERAL = {"patterns": "text", "places": "place", "sounds": "sound"}
# Ranges of numbers, by their units.
_LIMITS = {
    "mm": (0.0, MOST_MM),
    "°": (-1e6, 1e6),
    "Hz": (LEAST_FREQUENCY_HZ, MOST_FREQUENCY_HZ),
    "mm/s": (-1000.0, 1000.0),
    "ms": (0.0, 20_000.0),
    "share": (0.0, 1.0),
    "number": (0.0, MOST_MM),
}
# Units by which OpenLatero writes the same thing.
_SAME = {"°": ("degree", "deg", "degrees"), "°/s": ("degree/s",), "share": ("%",)}


def _value(above: Element, xml: Any, row: Row) -> Any:
    """Value of an element by its row: what is usual, if it does not stand in the file."""
    kind, (usual, *more) = row.kind, row.usual.split(" ")
    leaf = Element(xml, above.context, above)
    if kind in ("pattern", "text", "unused"):
        return leaf
    if not leaf.there:
        leaf.text = usual
    if kind == "yesno":
        return _yes_no(leaf)
    if kind == "words":
        words = [word.strip() for word in row.usual.split("|")]
        return leaf.word(leaf.text if leaf.there else words[0], words, words[0])
    if kind == "place":
        x, y = map(float, usual.split(","))
        return place(leaf, (x, y))
    if kind == "speed":
        in_hertz = leaf.attribute("units") == "Hz"
        return number(leaf, 0.0, "Hz" if in_hertz else more[-1], -1e6, 1e6), in_hertz
    if kind in _LIMITS:
        low, high = map(float, more[-1].split("..")) if more else _LIMITS[kind]
        return number(leaf, float(usual), kind, low, high)
    return Element(xml, above.context, above, kind)


# Numbers as C reads them, which is independent of the locale here.
_NUMBER = r"[+-]?(?:\d+(?:\.\d*)?|\.\d+)(?:[eE][+-]?\d{1,3})?"
_LEADING = re.compile(_NUMBER)
_DECIMAL_COMMA = re.compile(r"([+-]?\d+),(\d+)(?![\d,.])")
_POINT = re.compile(rf"({_NUMBER})\s*,\s*({_NUMBER})")
_COMMAS = re.compile(r"([+-]?\d+),(\d+),([+-]?\d+)(?:,(\d+))?")
_LONGEST = 40  # characters of a quoted text


def number(
    leaf: Element, usual: float, unit: str, low: float = 0.0, high: float = MOST_MM
) -> float:
    """Read a number; one that is out of range is put to its nearest end.

    Parameters
    ----------
    leaf
        The element.
    usual
        What counts if there is none.
    unit
        Unit that counts: "mm", "°", "Hz", "share" for a fraction of 1, or empty for none.
    low, high
        The range of it here.
    """
    _check_units(leaf, unit)
    value = _leading(leaf, usual)
    if low <= value <= high:
        return value
    clamped = min(max(value, low), high)
    must = "shares are" if unit == "share" and value > 1 else "it must be"
    leaf.say(f"{leaf.path} is {value:g}, and {must} {low:g} to {high:g}; {clamped:g} is taken")
    return clamped


def _check_units(leaf: Element, unit: str) -> None:
    """Say so if the units that are named are not those that count."""
    named = leaf.attribute("units")
    if named and named not in (unit, *_SAME.get(unit, ())):
        counts = {"share": "a share from 0 to 1", "number": "a plain number"}.get(unit, unit)
        leaf.say(f"{leaf.path} is in {counts}, although its units say {_short(named)}")


def _leading(leaf: Element, usual: float) -> float:
    """Number that the text of an element begins with."""
    comma = _DECIMAL_COMMA.match(leaf.text)
    found = comma or _LEADING.match(leaf.text)
    if found is None:
        what = f'"{_short(leaf.text)}", which is no number' if leaf.text else "empty"
        leaf.say(f"{leaf.path} is {what}; {usual:g} is taken")
        return usual
    value = float(found[0].replace(",", "."))
    if not math.isfinite(value):
        leaf.say(f"{leaf.path} is too large a number; {usual:g} is taken")
        return usual
    if comma:
        leaf.say(f'{leaf.path} "{_short(leaf.text)}" has a decimal comma; {value:g} is taken')
    else:
        _say_rest(leaf, found[0])
    return value


def _say_rest(leaf: Element, read: str) -> None:
    """Say so if there is more in an element than what was read."""
    rest = leaf.text.removeprefix(read).strip()
    if rest:
        leaf.say(f'{leaf.path} has "{_short(rest)}" after its number, which is ignored')


def _yes_no(leaf: Element) -> bool:
    """Read a yes or no; what is neither is a no."""
    word = leaf.text.lower()
    if word not in ("yes", "true", "no", "false"):
        leaf.say(f'{leaf.path} is "{_short(leaf.text)}", neither yes nor no; no is taken')
    return word in ("yes", "true")


def place(leaf: Element, usual: Point) -> Point:
    """Read a place.

    The comma is between x and y. Programs whose language has decimal commas wrote some files so,
    too: four numbers are two with decimals, and three are taken as that program would read them.
    """
    _check_units(leaf, "mm")
    said = f'{leaf.path} "{_short(leaf.text)}"'
    commas = _COMMAS.fullmatch(leaf.text)
    if commas:
        x, y = float(f"{commas[1]}.{commas[2]}"), float(f"{commas[3]}.{commas[4] or 0}")
        leaf.say(f"{said} has decimal commas; {x:g}, {y:g} is taken")
        return (x, y)
    found = _POINT.match(leaf.text)
    if found is None or not math.isfinite(float(found[1]) + float(found[2])):
        leaf.say(f'{said} is no place "x,y"; {usual[0]:g},{usual[1]:g} is taken')
        return usual
    _say_rest(leaf, found[0])
    return float(found[1]), float(found[2])


def _short(text: str) -> str:
    said = printable(" ".join(text.split()))
    return said if len(said) <= _LONGEST else f"{said[:_LONGEST]}…"


Maker = Callable[[Element], "AnyPattern | None"]
# What makes patterns of elements by their types, and textures, which are all over the surface. It
# makes None, and says so, where there is nothing to show, and raises ValueError where there can be
# no such pattern.
PATTERNS: dict[str, Maker] = {}
TEXTURES: dict[str, Maker] = {}
_DEEPEST = 32  # patterns within one another


def makes(kinds: dict[str, Maker], *names: str) -> Callable[[Maker], Maker]:
    """Put a function among those that make patterns."""

    def keep(make: Maker) -> Maker:
        kinds.update(dict.fromkeys(names, make))
        return make

    return keep


def pattern_of(leaf: Element) -> AnyPattern | None:
    """Pattern that an element tells of; None if there is nothing to show, which is said.

    Whatever a pattern refuses is said and left out, so that one mistake costs one pattern.
    """
    of, kinds, name = "type of this pattern", PATTERNS, leaf.attribute("type")
    if name == "Texture":
        of, kinds, name = "subtype of this texture", TEXTURES, leaf.attribute("subtype")
    if name not in kinds:
        what = f'"{name}"' if name else "missing"
        leaf.say(f"the {of} is {what}, which is not known{nearest(name, kinds)}; left out")
        return None
    if len(list(leaf.xml.iterancestors("{*}Pattern"))) >= _DEEPEST:
        leaf.say(f"this is in {_DEEPEST} other patterns; left out")
        return None
    try:
        tables = ("texture", name) if kinds is TEXTURES else (name,)
        pattern = kinds[name](Element(leaf.xml, leaf.context, leaf, *tables))
    except ValueError as error:
        leaf.say(f"{error}; left out")
        return None
    if pattern is not None:
        leaf.context.made[id(pattern)] = (pattern, leaf.line)
    return pattern


def read_root(content: bytes, name: str, context: Context) -> Element:
    """Read a text of XML as an element.

    Nothing is looked up elsewhere, and no entity is expanded.

    Parameters
    ----------
    content
        The text.
    name
        Name of its file, for messages.
    context
        Where it is said what was broken.

    Raises
    ------
    InputError
        If it is no XML, declares entities, or is far too large.
    """
    from lxml import etree

    # Broken files are read as far as they can be; what was broken is said.
    parser = etree.XMLParser(
        recover=True, resolve_entities=False, no_network=True, load_dtd=False, huge_tree=False,
        remove_comments=True, remove_pis=True,
    )  # fmt: skip
    root: Any = None
    has_entities = b"<!ENTITY" in content
    if not has_entities:
        with suppress(etree.XMLSyntaxError, ValueError):
            root = etree.fromstring(content, parser)
    if root is not None:
        declared: Any = root.getroottree().docinfo.internalDTD
        has_entities = declared is not None and any(True for _ in declared.iterentities())
    if has_entities:
        raise InputError(
            f"{name} declares entities, which OpenLatero's files have none of; remove it"
        )
    if root is None:
        raise InputError(f"{name} is no XML; give a file that OpenLatero wrote")
    if root.xpath("count(//*)") > MOST_ELEMENTS:
        raise InputError(f"{name} has more than {MOST_ELEMENTS} elements; split the picture in two")
    made = Element(root, context, None, "file")
    for fault in parser.error_log[:_MOST_FAULTS]:
        said = f"it is broken here, and read as far as it can be: {printable(fault.message)}"
        context.remarks.setdefault(("XML", said), []).append(fault.line)
    return made
