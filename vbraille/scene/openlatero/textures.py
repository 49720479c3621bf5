"""Textures of OpenLatero's files, which cover the whole surface, and patterns put together."""

from __future__ import annotations

import math
from functools import partial
from typing import TYPE_CHECKING, Any, Final, Literal

from msgspec.structs import replace

from vbraille.scene.measures import LEAST_MM, MOST_MM
from vbraille.scene.openlatero.elements import TEXTURES, Element, makes, pattern_of, place
from vbraille.scene.openlatero.shapes import operation_of, speed_of, vibration_of
from vbraille.scene.patterns import Circle, Dots, Group, Image, Moving, Shape, Tile
from vbraille.scene.signals import Direction, Speed
from vbraille.scene.strokes import Stroke, Vibration
from vbraille.scene.textures import (
    AxialGrating,
    Gradual,
    LinearGrating,
    Peak,
    RadialGrating,
    SignalLevel,
    TurnPeak,
    Uniform,
    UniformVibration,
)

if TYPE_CHECKING:
    from collections.abc import Callable

    from vbraille.scene.measures import Point
    from vbraille.scene.patterns import AnyPattern, Operation

_STILL_MM_S = 1e-3  # below which OpenLatero takes a projected speed as none
_NOTHING = Uniform(level=0.0)
_USUAL = LinearGrating(ridge_mm=8.0)  # the texture where none is given
_AT_REST: Final[dict[str, Literal["high", "low", "keep"]]] = {
    "high": "high",
    "low": "low",
    "toggle": "keep",
}
OPERATIONS: dict[str, Operation] = {
    "multiply": "multiply",
    "add": "add",
    "max": "maximum",
    "blend": "blend",
    "overwrite": "overwrite",
}


def joined(operation: Element, parts: list[AnyPattern | None]) -> AnyPattern | None:
    """Parts put together as an element says, of which None are left out; None for nothing."""
    felt = _joined(operation, [part for part in parts if not _sounds(part)])
    sounds = tuple(sound for part in parts for sound in _sounds(part))
    if not sounds:
        return felt
    if isinstance(felt, Group) and felt.operation in ("maximum", "add"):
        return replace(felt, parts=felt.parts + sounds)
    shown = () if felt is None else (felt,)
    return Group(operation="maximum", parts=shown + sounds)


def _sounds(part: AnyPattern | None) -> tuple[AnyPattern, ...]:
    """Masks of sounds, which change nothing of what is felt, if a part is of these alone."""
    found = part.parts if isinstance(part, Group) else () if part is None else (part,)
    return found if all(one.sound for one in found) else ()


def _joined(operation: Element, parts: list[AnyPattern | None]) -> AnyPattern | None:
    """Parts that are felt, put together."""
    name = operation_of(operation, "max")
    if name == "reactive":
        if len(parts) != 2:
            operation.say(f"a reactive group is of 2 patterns, and this has {len(parts)}")
        first, second = (*parts, None, None)[:2]
        return _reacting(operation.Modulator, first, second)
    if name == "blend":
        if len(parts) != 3:
            lost = "; left out" if len(parts) < 3 else ""
            operation.say(f"a blend is of 3 patterns, and this has {len(parts)}{lost}")
        if len(parts) < 3:
            return None
        # Theirs weighs the first, and ours the second.
        first, second, by = (part or _NOTHING for part in parts[:3])
        return Group(operation="blend", parts=(second, first), by=by)
    if name == "multiply" and None in parts:
        operation.say("a part of a product is left out, and so is all of it")
        return None
    found = [part for part in parts if part is not None]
    if name == "overwrite" and any(map(_hides_otherwise, found[1:])):
        operation.say("its layers hide a little more or less of what is below them here than there")
    if len(found) < 2:
        return found[0] if found else None
    return Group(operation=OPERATIONS[name], parts=tuple(found))


def _hides_otherwise(part: AnyPattern) -> bool:
    """Tell whether a part hides something else of what is below it than it does there."""
    if isinstance(part, Group) and part.by is None:
        return part.operation == "overwrite" or any(map(_hides_otherwise, part.parts))
    if isinstance(part, Image):
        return not part.nearest
    if isinstance(part, Dots):
        return part.dot.across is not None
    if isinstance(part, Shape):
        stroke = part.stroke
        return stroke is None or stroke.across is not None or part.is_cued_over
    return True  # a texture, which hides all here, and there as far as it is up


def _reacting(
    modulator: Element, first: AnyPattern | None, second: AnyPattern | None
) -> AnyPattern:
    """Blend of two patterns by the hand's movement; it is the first where the modulator is 1."""
    kind = modulator.word(modulator.attribute("type"), ("Directional", "Velocity"), "Directional")
    if kind == "Velocity":
        name, signal = "slow", Speed(
            below_mm_s=modulator.limit,
            transition_mm_s=modulator.transition,
            # Theirs is the time until it has risen: half of it waits.
            delay_s=modulator.delay / 2000.0,
        )  # fmt: skip
    else:
        name, signal = "way", Direction(
            **modulator.here,
            angle_deg=_turned(modulator.direction),
            at_rest=_AT_REST[modulator.low_velocity_mode],
        )  # fmt: skip
    by = SignalLevel(name=modulator.context.signal(name, signal))
    return Group(operation="blend", parts=(second or _NOTHING, first or _NOTHING), by=by)


def _turned(angle_deg: float) -> float:
    """Angle within a turn."""
    return math.fmod(angle_deg, 360.0)


def _changed(
    part: AnyPattern, amplitude: float, inverted: bool = False, vibration: Vibration | None = None
) -> AnyPattern:
    """Pattern whose deflections are changed, by itself or by a group around it."""
    if amplitude == 1.0 and not inverted and vibration is None:
        return part
    if part.amplitude != 1.0 or part.inverted or part.vibration is not None:
        part = Group(operation="maximum", parts=(part,))
    return replace(part, amplitude=amplitude, inverted=inverted, vibration=vibration)


def _across(motion: Element, grating: LinearGrating) -> LinearGrating:
    """Grating whose ridges move by the part of a motion that goes across them."""
    if not motion.enable:
        return grating
    turn = math.radians(motion.direction - (grating.wave_angle_deg or 0.0))
    across = motion.velocity * math.cos(turn)
    total = grating.velocity_mm_s + (across if abs(across) >= _STILL_MM_S else 0.0)
    return replace(grating, velocity_mm_s=max(-1000.0, min(1000.0, total)))


def _texture(*names: str, unread: bool = False) -> Callable[[Any], Any]:
    """Put a function among those that make textures, which are then placed and changed.

    Parameters
    ----------
    names
        Their types.
    unread
        Whether OpenLatero does not read the amplitude, inversion and vibration of these.
    """

    def keep(alone: Callable[[Element], AnyPattern | None]) -> Callable[..., Any]:
        def make(element: Element) -> AnyPattern | None:
            pattern = alone(element)
            if pattern is None:
                return None
            carried = _carried(pattern, element)
            vibration = vibration_of(element.vibration)
            made = _changed(carried, element.amplitude, element.invert, vibration)
            if made is carried or not unread:
                return made
            changes = "its amplitude, invert and vibration are"
            if element.context.as_shown:
                element.say(f"{changes} ignored, as OpenLatero does")
                return carried
            element.say(f"{changes} as the file says; OpenLatero does not read them here")
            return made

        return makes(TEXTURES, *names)(make)

    return keep


def _carried(part: AnyPattern, element: Element) -> AnyPattern:
    """Texture that moves as a whole (eq. 9.1), or stands where the array is."""
    if isinstance(part, Uniform | UniformVibration):
        return part
    motion, velocity = element.motion, (0.0, 0.0)
    if isinstance(part, LinearGrating) and part.distortion is None:
        part = _across(motion, part)
    elif motion.enable:
        way = math.radians(motion.direction)
        velocity = motion.velocity * math.cos(way), motion.velocity * math.sin(way)
    center: Point | None = None
    if element.td_centric.there:
        center = place(element.td_centric, (0.0, 0.0))
    if center is None and velocity == (0.0, 0.0):
        return part
    return Moving(part=part, velocity_mm_s=velocity, array_at_mm=center)


@makes(TEXTURES, "Null")
def _null(element: Element) -> AnyPattern:
    """Nothing, which has no changes either."""
    del element
    return Uniform(level=0.0)


@_texture("Plain")
def _plain(element: Element) -> AnyPattern:
    del element
    return Uniform()


@_texture("Vibration")
def _vibration(element: Element) -> AnyPattern:
    return UniformVibration(frequency_hz=element.context.truncated(element.freq))


@_texture("LinearGrating")
def _linear(element: Element) -> AnyPattern | None:
    angle = _turned(element.angle) or None
    make = partial(LinearGrating, **element.here, wave_angle_deg=angle)
    return _grating(element.Grating, make)


@_texture("RadialGrating")
def _radial(element: Element) -> AnyPattern | None:
    return _grating(element.Grating, partial(RadialGrating, **element.here))


@_texture("AxialGrating")
def _axial(element: Element) -> AnyPattern | None:
    wave = element.Grating
    if wave.ridge_size + wave.gap_size > 360.0:
        wave.gap_size = wave.here["gap_deg"] = 360.0 - wave.ridge_size
        wave.say(f"its ridge and gap are more than a turn; a gap of {wave.gap_size:g}° is taken")
    make = partial(
        AxialGrating,
        **element.here,
        start_deg=_turned(element.seed_angle),
        whole_cycles=False,
        middle=float(not wave.invert),  # it is inverted with the grating
    )
    return _grating(wave, make, "°", "deg", 0.5, 3600.0)


def _grating(
    wave: Element,
    make: Callable[..., AnyPattern],
    unit: str = "mm",
    ours: str = "mm",
    least: float = LEAST_MM,
    most: float = 1000.0,
) -> AnyPattern | None:
    """Grating; what is the same everywhere if it is off, and None if it has no ridges.

    Parameters
    ----------
    wave
        The element of its ridges.
    make
        What makes the grating with its ridges.
    unit, ours
        Unit of the lengths of its ridges, and how names in our scenes have it.
    least, most
        Shortest ridges, and largest speed.
    """
    if not wave.enable:
        return Uniform(level=float(wave.invert))
    ridge = wave.ridge_size
    if ridge < least:
        wave.say(f"its ridges are {ridge:g} {unit}, and must be {least:g} or more; left out")
        return None
    distortion = _distortion(wave.PitchModulator, unit) if wave.PitchModulator.enable else None
    # Where the frequency changes, ridges do not move in OpenLatero either.
    speed = wave.context.truncated(speed_of(wave, unit, most), ridge + wave.gap_size)
    moving = {f"velocity_{ours}_s": 0.0 if distortion else speed}
    return make(**wave.here, **moving, distortion=distortion)


def _distortion(pitch: Element, unit: str) -> Gradual | Peak | TurnPeak | None:
    """Change of the frequency along a grating."""
    kind = pitch.word(pitch.attribute("type"), ("slope", "peak"), "slope")
    if unit == "mm" and kind == "slope":
        return Gradual(**pitch.here, start_mm=pitch.position)
    if unit == "mm":
        return Peak(**pitch.here, center_mm=pitch.position)
    if kind == "peak":
        return TurnPeak(**pitch.here, center_deg=pitch.position)
    pitch.say("the frequency of an axial grating has no slope here; it is the same all round")
    return None


@_texture("DoubleLinearGrating", unread=True)
def _double(element: Element) -> AnyPattern | None:
    """Two gratings, each of which moves by itself."""
    ridge, gap = element.primary_ridge_size, element.primary_gap_size
    if min(ridge, ridge * element.secondary_scale) < LEAST_MM:
        element.say(f"its ridges are below {LEAST_MM} mm; left out")
        return None
    turn = 90.0 if element.constraint == "orthogonal" else 0.0
    both: list[AnyPattern | None] = []
    for scale, angle, amplitude in (
        (1.0, element.angle, element.primary_amplitude),
        (element.secondary_scale, element.angle + turn, element.secondary_amplitude),
    ):
        grating = LinearGrating(
            ridge_mm=ridge * scale,
            gap_mm=min(gap * scale, MOST_MM),
            wave_angle_deg=_turned(angle) or None,
            start_mm=element.seed,
        )
        both.append(_changed(_across(element.motion, grating), amplitude))
    element.motion.enable = False
    return joined(element.operation, both)


@_texture("Combo")
def _combo(element: Element) -> AnyPattern | None:
    return joined(element.operation, [pattern_of(part) for part in element.Pattern])


@_texture("Blend")
def _blend(element: Element) -> AnyPattern | None:
    """One of two textures by the movement of the hand."""
    found = [pattern_of(part) for part in element.Pattern]
    if len(found) != 2:
        element.say(f"it has {len(found)} textures instead of 2; OpenLatero's own are taken")
        found = [replace(_USUAL, wave_angle_deg=90.0), _USUAL]
    return _reacting(element.Modulator, *found)


@_texture("Motion", unread=True)
def _motion(element: Element) -> AnyPattern | None:
    """A texture over which bands move under the finger, whether the hand moves or not: 9.3."""
    cue, context = element.cue_type, element.context
    under = pattern_of(element.Pattern) if element.Pattern.there else _USUAL
    if under is None or cue == "none":
        return under
    ridge, gap = 5.0 if "vibration" in cue else 2.0, 30.0
    wave = LinearGrating(
        ridge_mm=ridge,
        gap_mm=gap,
        wave_angle_deg=_turned(element.direction) or None,
        velocity_mm_s=context.truncated(element.velocity, ridge + gap),
    )
    bands = Moving(part=wave, array_at_mm=(0.0, 0.0))
    if cue == "disabling bands":
        return Group(operation="multiply", parts=(under, replace(bands, inverted=True)))
    if cue == "vibration bands":
        return Group(operation="blend", parts=(under, UniformVibration()), by=bands)
    if cue == "blending bands":
        return Group(operation="blend", parts=(under, Uniform(level=0.5)), by=bands)
    vibration = None
    if cue == "superposed vibration bands" and not context.as_shown:
        element.say("its bands vibrate, as their name says; OpenLatero's do not")
        vibration = Vibration()
    # OpenLatero weakens bands that are added.
    return Group(operation="add", parts=(under, _changed(bands, 0.2, vibration=vibration)))


@_texture("Pattern", unread=True)
def _tile(element: Element) -> AnyPattern | None:
    ring = Circle(center_mm=(10.0, 10.0), radius_mm=5.0, stroke=Stroke(width_mm=1.0))
    part = pattern_of(element.Pattern) if element.Pattern.there else ring
    if part is None:
        return None
    if element.context.as_shown:  # which does not read it
        element.motion.enable = False
    return Tile(**element.here, part=part)
