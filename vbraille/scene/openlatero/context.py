"""Tables of OpenLatero's patterns and textures, and what is known while a file is read."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, NamedTuple

from msgspec.structs import replace

from vbraille.scene.measures import LEAST_FREQUENCY_HZ, MOST_FREQUENCY_HZ
from vbraille.scene.openlatero.elements import ON, SHARE, NumberField, WordField
from vbraille.scene.patterns import Group
from vbraille.scene.signals import MOST_SIGNALS
from vbraille.scene.strokes import Vibration
from vbraille.wording import nearest

if TYPE_CHECKING:
    from pathlib import Path

    from vbraille.scene.openlatero.elements import Field, GenElement
    from vbraille.scene.patterns import AnyPattern
    from vbraille.scene.signals import AnySignal

# The surface that the pictures stand on, which no file says.
SURFACE_MM = (289.9, 230.1875)
DEEPEST = 32  # patterns within one another

Maker = Callable[["GenElement", "GenContext"], "AnyPattern | None"]


class ElementKind(NamedTuple):
    """A kind of pattern: the fields that its element has, and what makes a pattern of them.

    That makes None, and says so, where there is nothing to show, and raises ValueError where there
    can be no such pattern.
    """

    fields: dict[str, Field]
    make: Maker


class Kinds(dict[str, ElementKind]):
    """Table of kinds by their names in a file."""

    def row(self, *names: str, **fields: Field) -> Callable[[Maker], Maker]:
        """Put into the table what the decorated function makes of elements with these fields."""

        def keep(make: Maker) -> Maker:
            self.update(dict.fromkeys(names, ElementKind(fields, make)))
            return make

        return keep


@dataclass(frozen=True, slots=True)
class GenContext:
    """Options and state of the reading of a file.

    Parameters
    ----------
    folder
        Folder of the file, from which the names of pictures are seen.
    as_shown
        Whether the picture is to be as OpenLatero shows it, where that is not what the file says.
    patterns, textures
        Kinds of patterns, and of textures, which are patterns all over the surface.
    signals
        Signals of the scene, as they come.
    """

    folder: Path
    as_shown: bool
    patterns: Kinds
    textures: Kinds
    signals: dict[str, AnySignal] = field(default_factory=dict)
    _found: dict[int, tuple[AnyPattern, GenElement]] = field(default_factory=dict)
    _way: list[GenElement] = field(default_factory=list)

    def pattern(self, element: GenElement) -> AnyPattern | None:
        """Pattern of an element; None if there is nothing to show, which is said.

        Whatever a pattern refuses is said and left out, so that one mistake costs one pattern.
        """
        named, kind = "type of this pattern", element.attribute("type")
        kinds, known = self.patterns, (*self.patterns, "Texture")
        if kind == "Texture":
            named, kind = "subtype of this texture", element.attribute("subtype")
            kinds, known = self.textures, tuple(self.textures)
        row = kinds.get(kind)
        if row is None:
            what = f'"{kind}"' if kind else "missing"
            near = nearest(kind, known)
            element.forget()
            element.say(f"the {named} is {what}, which is not known{near}; left out")
            return None
        if len(self._way) >= DEEPEST:
            element.forget()
            element.say(f"this is in {DEEPEST} other patterns; left out")
            return None
        self._way.append(element)
        element.fields = row.fields
        try:
            pattern = row.make(element, self)
        except ValueError as error:
            element.forget()
            element.say(f"{error}; left out")
            return None
        finally:
            self._way.pop()
        if pattern is not None:
            self._found[id(pattern)] = (pattern, element)
        elif kinds is self.textures:
            element.forget()
        return pattern

    def signal(self, name: str, signal: AnySignal) -> str:
        """Name of a signal, which is called by a name and a number if others have that name.

        Raises
        ------
        ValueError
            If a scene cannot have as many.
        """
        for known, other in self.signals.items():
            if other == signal:
                return known
        if len(self.signals) == MOST_SIGNALS:
            raise ValueError(f"a scene has at most {MOST_SIGNALS} signals")
        number = len(self.signals) + 1
        own = f"{name}-{number}" if name in self.signals else name
        self.signals[own] = signal
        return own

    def element_of(self, pattern: AnyPattern) -> GenElement | None:
        """Element that a pattern came from; None if it was made on the way."""
        return self._found.get(id(pattern), (None, None))[1]


FREQUENCY = NumberField(MOST_FREQUENCY_HZ, LEAST_FREQUENCY_HZ, MOST_FREQUENCY_HZ, "Hz")
VIBRATION = {
    "enable": ON,
    "frequency": FREQUENCY,
    "amplitude": SHARE,
    "blend_mode": WordField("high", ("high", "low")),
}


def vibration(above: GenElement, context: GenContext, always_up: str = "") -> Vibration | None:
    """Vibration in an element; None if there is none, or it is off.

    Parameters
    ----------
    above
        The element that it is in.
    context
        How the file is read.
    always_up
        What it is a vibration of, such as "dots", if that has nothing that is down.
    """
    element = above.one("vibration", VIBRATION)
    if element is None:
        return None
    if not element["enable"]:
        element.forget()
        return None
    swing = swung(element, context)
    low = element["blend_mode"] == "low"
    if low and always_up:
        element.say(f"{always_up} have nothing down that could vibrate; what is up does")
        low = False
    elif low and context.as_shown:
        element.say("blend_mode low is ignored, as OpenLatero does")
        low = False
    elif low:
        element.say("what is down vibrates, as the file says; OpenLatero ignores blend_mode low")
    return replace(swing, of="low") if low else swing


def swung(element: GenElement, context: GenContext) -> Vibration:
    """Vibration that an element tells of, whether it is on or off; of what is up."""
    hertz = timed(element["frequency"], context)
    return Vibration(frequency_hz=hertz, amplitude=element["amplitude"])


def timed(hertz: float, context: GenContext) -> float:
    """Frequency that is shown for one that is written: its period has whole microseconds there."""
    return 1e6 / math.floor(1e6 / hertz) if context.as_shown else hertz


def travelled(speed: float, cycle: float, context: GenContext) -> float:
    """Speed of ridges that is shown for one that is written, as `timed` does for vibrations."""
    period_us = math.floor(1e6 * cycle / abs(speed)) if speed else 0
    if not context.as_shown or period_us < 1:
        return speed
    return math.copysign(1e6 * cycle / period_us, speed)


def changed(
    pattern: AnyPattern, amplitude: float, inverted: bool, vibrating: Vibration | None
) -> AnyPattern:
    """Pattern whose deflections are changed, by itself or by a group around it."""
    if amplitude == 1.0 and not inverted and vibrating is None:
        return pattern
    if pattern.amplitude != 1.0 or pattern.inverted or pattern.vibration is not None:
        pattern = Group(operation="maximum", parts=(pattern,))
    return replace(pattern, amplitude=amplitude, inverted=inverted, vibration=vibrating)
