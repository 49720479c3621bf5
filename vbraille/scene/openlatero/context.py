"""Context of all readers of elements: how the file is read, and what patterns came of it."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from msgspec.structs import replace

from vbraille.scene.measures import LEAST_FREQUENCY_HZ, MOST_FREQUENCY_HZ
from vbraille.scene.patterns import Group
from vbraille.scene.signals import MOST_SIGNALS
from vbraille.scene.strokes import Vibration
from vbraille.wording import nearest

if TYPE_CHECKING:
    from pathlib import Path

    from vbraille.scene.openlatero.elements import GenElement
    from vbraille.scene.patterns import AnyPattern
    from vbraille.scene.signals import AnySignal

# The surface that the pictures stand on, which no file says.
SURFACE_MM = (289.9, 230.1875)
DEEPEST = 32  # patterns within one another

Reader = Callable[["GenElement", "GenContext"], "AnyPattern | None"]


@dataclass(frozen=True, slots=True)
class GenContext:
    """Options and state of the reading of a file.

    Parameters
    ----------
    folder
        Folder of the file, from which the names of pictures are seen.
    as_shown
        Whether the picture is to be as OpenLatero shows it, where that is not what the file says.
    readers
        What reads patterns, by their type.
    signals
        Signals of the scene, as they come.
    """

    folder: Path
    as_shown: bool
    readers: Mapping[str, Reader]
    signals: dict[str, AnySignal] = field(default_factory=dict)
    _found: dict[int, tuple[AnyPattern, GenElement]] = field(default_factory=dict)
    _way: list[GenElement] = field(default_factory=list)

    def pattern(self, element: GenElement) -> AnyPattern | None:
        """Pattern of an element; None if there is nothing to show, which is said.

        Whatever a pattern refuses is said and left out, so that one mistake costs one pattern.
        """
        kind = element.attribute("type")
        reader = self.readers.get(kind)
        if reader is None:
            what = f'"{kind}"' if kind else "missing"
            near = nearest(kind, self.readers)
            element.forget()
            element.say(f"the type of this pattern is {what}, which is not known{near}; left out")
            return None
        if len(self._way) >= DEEPEST:
            element.forget()
            element.say(f"this is in {DEEPEST} other patterns; left out")
            return None
        self._way.append(element)
        try:
            pattern = reader(element, self)
        except ValueError as error:
            element.forget()
            element.say(f"{error}; left out")
            return None
        finally:
            self._way.pop()
        if pattern is not None:
            self._found[id(pattern)] = (pattern, element)
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
    element = above.one("vibration")
    if element is None:
        return None
    if not element.switch("enable", True):
        element.forget()
        return None
    swing = swung(element, context)
    low = element.word("blend_mode", ("high", "low"), "high") == "low"
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
    hertz = element.number(
        "frequency", MOST_FREQUENCY_HZ, LEAST_FREQUENCY_HZ, MOST_FREQUENCY_HZ, "Hz"
    )
    amplitude = element.number("amplitude", 1.0, 0.0, 1.0, "share")
    return Vibration(frequency_hz=timed(hertz, context), amplitude=amplitude)


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
