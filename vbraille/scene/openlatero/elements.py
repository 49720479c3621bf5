"""Elements of OpenLatero's files, read leniently by a table of what may stand in each.

There is a remark on each value that is not understood, or is not taken as it is written. A row of
the table has the name of an element, its kind, its default, its range where the kind has another,
and after ``>`` its name in our scenes. The kinds:

- a unit, or ``number``: a number; ``turn``: an angle; ``speed``: in a unit per second or in Hz;
- ``yesno``, ``text``, ``place``, ``pattern``; ``patterns``, ``places``, ``sounds``: any number;
- ``words``: one of some words, the first by default; after ``=`` our word;
- ``unused``: read and left out; ``unshown``: left out with a remark;
- any other: the name of a part of the table. A part or a type may stand in several blocks of it.
"""

from __future__ import annotations

import math
import re
from contextlib import suppress
from dataclasses import dataclass, field
from functools import cache
from typing import TYPE_CHECKING, Any, NamedTuple

from vbraille.errors import InputError
from vbraille.scene.locations import Remarks
from vbraille.scene.measures import LEAST_FREQUENCY_HZ, MOST_FREQUENCY_HZ, MOST_MM
from vbraille.scene.signals import MOST_SIGNALS
from vbraille.wording import nearest, printable

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path

    from vbraille.scene.measures import Point
    from vbraille.scene.patterns import AnyPattern
    from vbraille.scene.signals import AnySignal


TABLE = """
file
  Generator            generator
  Pattern              pattern
generator
  Pattern              pattern

Group
  operation            operation
  Pattern              patterns
Toggle
  Pattern              patterns
Line
  start_point          place     0,0                  > start_mm
  end_point            place     289.9,230.1875       > end_mm
  stroke               stroke
Circle
  center               place     0,0                  > center_mm
  radius               mm        100                  > radius_mm
Circle Polygon
  stroke               stroke
  fill_texture         fill_texture
Polygon
  vertices             vertices
  join                 join
  corner               corner
Dot Dots
  dot                  places    0,0
  dot_radius           mm        100                  > radius_mm
  height               share     1                    > amplitude
  ridge                dot_ridge
  vibration            vibration
  operation            operation
Image
  Pattern              pattern
  mask                 mask
Audio
  sound                sounds

texture                                               # of every type
  amplitude            share     1
  invert               yesno     no
  vibration            vibration
  td_centric           text
  motion               movement
  icon                 unused
Vibration
  freq                 Hz        50
LinearGrating
  angle                turn      0                    > wave_angle_deg
  seed                 place     0,0                  > start_mm
  Grating              wave
RadialGrating
  seed                 place     0,0                  > center_mm
  Grating              wave
AxialGrating
  seed                 place     0,0                  > center_mm
  seed_angle           turn      0                    > start_deg
  Grating              turning_wave
DoubleLinearGrating
  seed                 place     0,0
  angle                °         0
  primary_ridge_size   mm        8
  primary_gap_size     mm        0
  secondary_scale      number    1
  constraint           words     orthogonal | parallel
  primary_amplitude    share     1
  secondary_amplitude  share     1
  operation            operation
Combo
  operation            operation
  Pattern              patterns
Blend
  Modulator            modulator
  Pattern              patterns
Motion
  cue_type             words     none | vibration bands | superposed bands | superposed vibration bands | disabling bands | blending bands
  direction            turn      0
  velocity             mm/s      50
  Pattern              pattern
Pattern
  grid_width           mm        20      0.1..10000  > width_mm
  grid_height          mm        20      0.1..10000  > height_mm
  Pattern              pattern

operation
  Modulator            modulator
modulator                                             # Velocity
  limit                mm/s      5       0..1000
  transition           mm/s      5       0.1..1000
  delay                ms        500
modulator                                             # Directional
  low_velocity_mode    words     toggle=keep | high | low       > at_rest
  direction            turn      0                              > angle_deg
  symmetric            yesno     no                             > axis
  direction_tolerance  °         30      0..180       > tolerance_deg
  direction_transition °         20      0.1..180     > transition_deg
  velocity_tolerance   mm/s      0       0..1000      > below_mm_s
  velocity_transition  mm/s      5       0.1..1000    > slow_transition_mm_s
movement
  enable               yesno     no
  velocity             mm/s      50
  direction            °         0
wave
  enable               yesno     yes
  ridge_size           mm        8                    > ridge_mm
  gap_size             mm        0                    > gap_mm
  velocity             speed     0 mm/s
  invert               yesno     no                             > inverted
  PitchModulator       pitch
turning_wave
  enable               yesno     yes
  ridge_size           °         36      0..360       > ridge_deg
  gap_size             °         0       0..360       > gap_deg
  velocity             speed     0 °/s
  invert               yesno     no                             > inverted
  PitchModulator       turning_pitch
pitch
  enable               yesno     no
  factor               number    5       0.05..20     > factor
  length               mm        113     0.05..10000  > length_mm
  position             mm        0       -10000..10000
turning_pitch
  enable               yesno     no
  factor               number    5       0.05..20     > factor
  length               °         113     0.5..360     > length_deg
  position             °         0       0..360
vibration
  enable               yesno     yes
  frequency            Hz        50
  amplitude            share     1                    > amplitude
  blend_mode           words     high | low

stroke
  width                mm        10
  intensity            share     1
  ridge                ridge
  dots                 dots
  fill                 fill
  motion               cue
ridge dot_ridge
  width                mm        0                    # that of the stroke, if it is not there
  texture              ripples
ridge
  edge_width           mm        1       0.1..10000
dot_ridge
  edge_width           mm        0.2     0.1..10000
ripples
  enable               yesno     no
  amplitude            share     0                    > amplitude
  nb_cycles            number    3       0..49        # on one side of a stroke
dots
  enable               yesno     no
  height               share     1
  min_spacing          mm        1                    > separation_mm
  ridge                ridge
  vibration            vibration
fill
  gutter               yesno     no
  Grating              along
  vibration            vibration
along
  enable               yesno     no
  ridge_size           mm        2                    > ridge_mm
  gap_size             mm        0                    > gap_mm
  velocity             speed     0 mm/s
  invert               unshown
  PitchModulator       unshown
cue
  cue                  words     none | inherent | superposed=add | suppressed=mask | vibration=vibrate | blend
  velocity             mm/s      50
  superposed_ratio     share     0.2                 > share
  blend_value          share     0.5
  min_width            mm        10                  > width_mm
  Grating              bands
  vibration            vibration
bands
  enable               yesno     yes
  ridge_size           mm        2                    > ridge_mm
  gap_size             mm        30                   > gap_mm
  velocity             speed     0 mm/s
  invert               unshown
fill_texture
  enable               yesno     no
  gap                  mm        0       -10000..10000
  edge_size            mm        1                    > fade_mm
  Pattern              pattern
vertices
  vertex               places    0,0
join
  type                 words     round=rounded | straight       > join
  rounding_offset      mm        0                    > rounding_offset_mm
corner
  enable               yesno     no
  span                 words     circle intercept=edges | user specified=angle | arc | right-angled=square > span
  type                 words     solid | invert vib
  user_angle           °         30      1..180
  blend                words     out | in
  blend_size           mm        1       0.05..10000  > blend_mm
  motion               yesno     yes
  vibration            vibration

sound
  audiofile            text
  mask                 mask
mask
  imgfile              text
  blur                 yesno     no                             # of 2 pixels
  position             text                           # a place, or "centered"
  lock_aspect_ratio    unused                         # while the user changes the size
  reference_maximized  yesno     yes
  width                text                           # in mm, or a share of the largest
  height               text
  default_alpha        share     0                    > outside
"""  # noqa: E501


class Row(NamedTuple):
    """A row of the table.

    Parameters
    ----------
    kind
        Kind of the element.
    usual
        What is usual, and the range if there is one, as they are written.
    here
        Name that the value has in our scenes; empty for none of its own.
    """

    kind: str
    usual: str
    here: str


@cache
def rows_of(*names: str) -> dict[str, Row]:
    """Rows of a part by its name, of a pattern or a texture by its type; none if it has none."""
    rows: dict[str, Row] = {}
    owners: tuple[str, ...] = ()
    for line in TABLE.splitlines():
        written, _, here = line.partition("#")[0].partition(">")
        if not line.startswith(" "):
            owners = tuple(written.split())
        elif any(owner in names for owner in owners):
            name, kind, *usual = written.split(None, 2)
            rows[name] = Row(kind, "".join(usual).strip(), here.strip())
    return rows


MOST_BYTES = 20_000_000
MOST_ELEMENTS = 200_000
_MOST_FAULTS = 5  # of broken XML that are said
_LONGEST = 40  # characters of a quoted text

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
# Units by which OpenLatero writes the same thing, and words for units that are none.
_SAME = {"°": ("degree", "deg", "degrees"), "°/s": ("degree/s",), "share": ("%",)}
_WORDS = {"share": "a share from 0 to 1", "number": "a plain number"}
# Numbers as C reads them, which is independent of the locale here.
_NUMBER = r"[+-]?(?:\d+(?:\.\d*)?|\.\d+)(?:[eE][+-]?\d{1,3})?"
_LEADING = re.compile(_NUMBER)
_DECIMAL_COMMA = re.compile(r"([+-]?\d+),(\d+)(?![\d,.])")
_POINT = re.compile(rf"({_NUMBER})\s*,\s*({_NUMBER})")
_COMMAS = re.compile(r"([+-]?\d+),(\d+),([+-]?\d+)(?:,(\d+))?")


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
    made
        Patterns that were made, with the lines of their elements, by their ids.
    """

    folder: Path
    as_shown: bool
    remarks: Remarks = field(default_factory=Remarks)
    signals: dict[str, AnySignal] = field(default_factory=dict)
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
    """An element of a file; its attributes are the values that the table lists for it.

    Values are read when they are asked for. Those that are not in the file are as usual.

    Attributes
    ----------
    line, text
        Line at which it begins, from 1, and the text in it before its first element.
    owner, path
        What the pattern that it belongs to is, such as "Circle", and the names of the elements that
        lead to it from that pattern.

    Parameters
    ----------
    xml
        The element of the library; None for one that is not in the file.
    context
        What is known about the file.
    above
        The element that it is in; None for the root.
    tag
        Name of the element.
    tables
        Names by which the table tells what is in it; none if its text is all that counts.
    """

    def __init__(
        self, xml: Any, context: Context, above: Element | None, tag: str, *tables: str
    ) -> None:
        self.xml, self.context, self.above = xml, context, above
        self.line: int = (0 if xml is None else xml.sourceline) or (above.line if above else 1)
        # Some files have a backslash astray.
        self.text = "" if xml is None else (xml.text or "").strip().rstrip("\\").strip()
        self.owner, self.path = tag, ""
        if tag in ("Pattern", "Generator"):
            self.owner = self.attribute("subtype") or self.attribute("type") or tag
        elif above is not None:
            self.owner, self.path = above.owner, f"{above.path} {tag}".strip()
        self._rows = rows_of(*tables)
        self._found: dict[str, list[Any]] = {}
        for inner in () if xml is None else xml.iterchildren("*"):
            self._found.setdefault(inner.tag.rpartition("}")[2], []).append(inner)
        if tables and getattr(self, "enable", True):  # no more is said of what is off
            for name, written in self._found.items():
                row = self._rows.get(name)
                if row is None:
                    self._pass_over(name, written, "{} is not known here, and ignored")
                elif row.kind == "unshown":
                    shown = (one.findtext("{*}enable") or one.text or "" for one in written)
                    if any(text.strip() in ("yes", "true") for text in shown):
                        self._pass_over(name, written, "{} is not shown here, and ignored")
                elif row.kind not in _SEVERAL:
                    text = "another {} is ignored, since the first counts"
                    self._pass_over(name, written[1:], text)

    def __getattr__(self, name: str) -> Any:
        row = vars(self).get("_rows", {}).get(name)
        if row is None:
            raise AttributeError(name)
        written = self._found.get(name, [])
        if row.kind in _SEVERAL:
            value = [self._read(name, xml, row, _SEVERAL[row.kind]) for xml in written]
        else:
            value = self._read(name, written[0] if written else None, row, row.kind)
        setattr(self, name, value)
        return value

    def _read(self, name: str, xml: Any, row: Row, kind: str) -> Any:
        """Value of an element in this one, by its kind."""
        leaf = Element(xml, self.context, self, name, *([kind] if rows_of(kind) else []))
        usual, *more = row.usual.split(" ")
        if kind == "yesno":
            return leaf.yes_no(usual)
        if kind == "words":
            pairs = (word.strip().partition("=") for word in row.usual.split("|"))
            words = {theirs: ours or theirs for theirs, _, ours in pairs}
            return words[leaf.word(leaf.text, words, next(iter(words)))]
        if kind == "place":
            x, y = map(float, usual.split(","))
            return leaf.place((x, y))
        if kind == "speed":
            in_hertz = leaf.attribute("units") == "Hz"
            return leaf.number(0.0, "Hz" if in_hertz else more[-1], -1e6, 1e6), in_hertz
        if kind == "turn":
            return math.fmod(leaf.number(float(usual), "°", *_LIMITS["°"]), 360.0)
        if kind in _LIMITS:
            low, high = map(float, more[-1].split("..")) if more else _LIMITS[kind]
            return leaf.number(float(usual), kind, low, high)
        return leaf

    @property
    def there(self) -> bool:
        """Tell whether it stands in the file."""
        return self.xml is not None

    @property
    def here(self) -> dict[str, Any]:
        """Values that have a name in our scenes, by these."""
        return {row.here: getattr(self, name) for name, row in self._rows.items() if row.here}

    def has(self, *names: str) -> bool:
        """Tell whether one of some elements stands in it."""
        return any(name in self._found for name in names)

    def attribute(self, name: str) -> str:
        """Value of an attribute; empty if it is not there."""
        return "" if self.xml is None else printable(self.xml.get(name, "")).strip()

    def say(self, text: str) -> None:
        """Say something about the pattern, at the line of this element."""
        self.context.remarks.note(text, self.line, self.owner)

    def _pass_over(self, name: str, written: list[Any], text: str) -> None:
        for xml in written:
            other = Element(xml, self.context, self, printable(name))
            other.say(text.format(other.path or f"{name} {other.attribute('type')}".strip()))

    def word(self, text: str, words: Iterable[str], usual: str) -> str:
        """One of a few words for a text, or the usual one for others, which is said."""
        if not self.there:
            return usual
        for known in (text, text.lower()):
            if known in words:
                return known
        near = nearest(text, words)
        self.say(f'{self.path} "{_short(text)}" is not known, so "{usual}" is taken{near}')
        return usual

    def yes_no(self, usual: str) -> bool:
        """Read a yes or no; what is neither is a no."""
        word = self.text.lower() if self.there else usual
        if word not in ("yes", "true", "no", "false"):
            self.say(f'{self.path} is "{_short(self.text)}", neither yes nor no; no is taken')
        return word in ("yes", "true")

    def number(self, usual: float, unit: str, low: float = 0.0, high: float = MOST_MM) -> float:
        """Read a number; one that is out of range is put to its nearest end.

        Parameters
        ----------
        usual
            What counts if there is none.
        unit
            Unit that counts, "share" for a fraction of 1, or "number" for none.
        low, high
            The range of it here.
        """
        if not self.there:
            return usual
        self._check_units(unit)
        comma = _DECIMAL_COMMA.match(self.text)
        found = comma or _LEADING.match(self.text)
        value = float(found[0].replace(",", ".")) if found else math.nan
        if found is None or not math.isfinite(value):
            what = f'"{_short(self.text)}", which is no number' if self.text else "empty"
            what = "too large a number" if found else what
            self.say(f"{self.path} is {what}; {usual:g} is taken")
            return usual
        if comma:
            self.say(f'{self.path} "{_short(self.text)}" has a decimal comma; {value:g} is taken')
        else:
            self._say_rest(found)
        if low <= value <= high:
            return value
        taken = min(max(value, low), high)
        must = "shares are" if unit == "share" and value > 1 else "it must be"
        self.say(f"{self.path} is {value:g}, and {must} {low:g} to {high:g}; {taken:g} is taken")
        return taken

    def place(self, usual: Point) -> Point:
        """Read a place.

        The comma is between x and y. Programs whose language has decimal commas wrote some files
        so, too: four numbers are two with decimals, and three are taken as that program would read
        them.
        """
        if not self.there:
            return usual
        self._check_units("mm")
        said = f'{self.path} "{_short(self.text)}"'
        commas = _COMMAS.fullmatch(self.text)
        if commas:
            x, y = float(f"{commas[1]}.{commas[2]}"), float(f"{commas[3]}.{commas[4] or 0}")
            self.say(f"{said} has decimal commas; {x:g}, {y:g} is taken")
            return (x, y)
        found = _POINT.match(self.text)
        if found is None or not math.isfinite(float(found[1]) + float(found[2])):
            self.say(f'{said} is no place "x,y"; {usual[0]:g},{usual[1]:g} is taken')
            return usual
        self._say_rest(found)
        return float(found[1]), float(found[2])

    def _check_units(self, unit: str) -> None:
        """Say so if the units that are named are not those that count."""
        named = self.attribute("units")
        if named and named not in (unit, *_SAME.get(unit, ())):
            counts = _WORDS.get(unit, unit)
            self.say(f"{self.path} is in {counts}, although its units say {_short(named)}")

    def _say_rest(self, found: re.Match[str]) -> None:
        """Say so if there is more than what was read."""
        rest = self.text[found.end() :].strip()
        if rest:
            self.say(f'{self.path} has "{_short(rest)}" after its number, which is ignored')


def _short(text: str) -> str:
    said = printable(" ".join(text.split()))
    return said if len(said) <= _LONGEST else f"{said[:_LONGEST]}…"


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
    with suppress(etree.XMLSyntaxError, ValueError):
        root = None if b"<!ENTITY" in content else etree.fromstring(content, parser)
    declared: Any = None if root is None else root.getroottree().docinfo.internalDTD
    if b"<!ENTITY" in content or (declared is not None and any(declared.iterentities())):
        raise InputError(
            f"{name} declares entities, which OpenLatero's files have none of; remove it"
        )
    if root is None:
        raise InputError(f"{name} is no XML; give a file that OpenLatero wrote")
    if root.xpath("count(//*)") > MOST_ELEMENTS:
        raise InputError(f"{name} has more than {MOST_ELEMENTS} elements; split the picture in two")
    for fault in parser.error_log[:_MOST_FAULTS]:
        said = f"it is broken here, and read as far as it can be: {printable(fault.message)}"
        context.remarks.note(said, fault.line, "XML")
    return Element(root, context, None, "file", "file")
