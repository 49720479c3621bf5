"""Textures of OpenLatero's files, which cover the whole surface: gratings and all others."""

from __future__ import annotations

import math
from functools import partial
from typing import TYPE_CHECKING, Any

from msgspec.structs import replace

from vbraille.scene.measures import LEAST_FREQUENCY_HZ, LEAST_MM, MOST_FREQUENCY_HZ, MOST_MM
from vbraille.scene.openlatero.context import changed, timed, travelled, vibration
from vbraille.scene.openlatero.groups import joined, reacting
from vbraille.scene.openlatero.shapes import speed_of
from vbraille.scene.patterns import Circle, Group, Moving, Tile
from vbraille.scene.strokes import Stroke, Vibration
from vbraille.scene.textures import (
    AxialGrating,
    Gradual,
    LinearGrating,
    Peak,
    RadialGrating,
    TurnPeak,
    Uniform,
    UniformVibration,
)
from vbraille.wording import nearest

if TYPE_CHECKING:
    from collections.abc import Callable

    from vbraille.scene.openlatero.context import GenContext
    from vbraille.scene.openlatero.elements import GenElement
    from vbraille.scene.patterns import AnyPattern


_LEAST_DEG = 0.5
_MOST_DEG_S = 3600.0
_MOST_MM_S = 1000.0
_FACTORS = (0.05, 20.0)
_EVEN = ("Null", "Plain", "Vibration")  # which are the same everywhere
_STILL = 1e-3  # mm/s, below which OpenLatero takes a projected speed as none


# Bands of a cue: those of the thesis that are best felt (9.7), at what OpenLatero weakens them to.
_BAND_MM, _BAND_GAP_MM, _BAND_AMPLITUDE = 2.0, 30.0, 0.2
_CUES = (
    "none",
    "vibration bands",
    "superposed bands",
    "superposed vibration bands",
    "disabling bands",
    "blending bands",
)


def read_texture(element: GenElement, context: GenContext) -> AnyPattern | None:
    """Texture of an element; None if there is nothing to show.

    Raises
    ------
    ValueError
        If there can be no such texture.
    """
    kind = element.attribute("subtype")
    reader = _READERS.get(kind)
    if reader is None:
        what = f'"{kind}"' if kind else "missing"
        near = nearest(kind, _READERS)
        element.forget()
        element.say(f"the subtype of this texture is {what}, which is not known{near}; left out")
        return None
    element.skip("icon")
    if kind in _EVEN:
        element.skip("motion", "td_centric")
    pattern = reader(element, context)
    if pattern is None:
        element.forget()
    return pattern


def _null(element: GenElement, context: GenContext) -> AnyPattern:
    """Nothing, which has no changes either."""
    del context
    element.forget()
    return Uniform(level=0.0)


def _plain(element: GenElement, context: GenContext) -> AnyPattern:
    return _changed(Uniform(), element, context)


def _vibration(element: GenElement, context: GenContext) -> AnyPattern:
    hertz = element.number("freq", MOST_FREQUENCY_HZ, LEAST_FREQUENCY_HZ, MOST_FREQUENCY_HZ, "Hz")
    return _changed(UniformVibration(frequency_hz=timed(hertz, context)), element, context)


def _linear(element: GenElement, context: GenContext) -> AnyPattern | None:
    angle = turned(element.number("angle", 0.0, -1e6, 1e6, "°"))
    seed = element.point("seed", (0.0, 0.0))
    make = partial(LinearGrating, wave_angle_deg=angle or None, start_mm=seed)
    return _graded(make, _wave(element, 8.0, "mm", context), element, context)


def _radial(element: GenElement, context: GenContext) -> AnyPattern | None:
    make = partial(RadialGrating, center_mm=element.point("seed", (0.0, 0.0)))
    return _graded(make, _wave(element, 8.0, "mm", context), element, context)


def _axial(element: GenElement, context: GenContext) -> AnyPattern | None:
    seed = element.point("seed", (0.0, 0.0))
    start = turned(element.number("seed_angle", 0.0, -1e6, 1e6, "°"))
    make = partial(AxialGrating, center_mm=seed, start_deg=start, whole_cycles=False)
    wave = _wave(element, 36.0, "°", context)
    if isinstance(wave, dict):
        if wave["ridge_deg"] + wave["gap_deg"] > 360.0:
            wave["gap_deg"] = 360.0 - wave["ridge_deg"]
            gap = f"{wave['gap_deg']:g}°"
            element.say(f"its ridge and gap are more than a turn; a gap of {gap} is taken")
        if wave["inverted"]:
            element.say("its middle is down here, where the grating is inverted, and up there")
    return _graded(make, wave, element, context)


def _graded(
    make: Callable[..., AnyPattern],
    wave: dict[str, Any] | Uniform | None,
    element: GenElement,
    context: GenContext,
) -> AnyPattern | None:
    """Grating of a waveform, with its motion and its changes."""
    if wave is None:
        return None
    if isinstance(wave, Uniform):
        element.skip("motion", "td_centric")  # the same everywhere
        return _changed(wave, element, context)
    pattern = make(**wave)
    moved = travelling(pattern, element) if isinstance(pattern, LinearGrating) else None
    return _changed(_carried(moved or pattern, element, moves=moved is None), element, context)


def _wave(
    element: GenElement, usual: float, unit: str, context: GenContext
) -> dict[str, Any] | Uniform | None:
    """Waveform of a grating, by the names of its fields here.

    It is what is the same everywhere if it is off, and None if it has no ridges.
    """
    grating = element.part("Grating")
    inverted = grating.switch("invert", False)
    if not grating.switch("enable", True):
        grating.forget()
        return Uniform(level=float(inverted))
    turning = unit == "°"
    least, most = (_LEAST_DEG, 360.0) if turning else (LEAST_MM, MOST_MM)
    ridge = grating.number("ridge_size", usual, 0.0, most, unit)
    gap = grating.number("gap_size", 0.0, 0.0, most, unit)
    if ridge < least:
        grating.say(f"its ridges are {ridge:g} {unit}, and must be {least:g} or more; left out")
        return None
    distortion = _distortion(grating, unit)
    speed = speed_of(grating, unit, ridge + gap, _MOST_DEG_S if turning else _MOST_MM_S)
    name = "deg" if turning else "mm"
    return {
        f"ridge_{name}": ridge,
        f"gap_{name}": gap,
        # OpenLatero ignores it where the frequency changes, too.
        f"velocity_{name}_s": (
            travelled(speed, ridge + gap, context) if distortion is None else 0.0
        ),
        "distortion": distortion,
        "inverted": inverted,
    }


def _distortion(grating: GenElement, unit: str) -> Gradual | Peak | TurnPeak | None:
    """Change of the frequency along a grating; None for none."""
    element = grating.one("PitchModulator")
    if element is None:
        return None
    if not element.switch("enable", False):
        element.forget()
        return None
    kind = element.chosen(element.attribute("type"), ("slope", "peak"), "slope")
    factor = element.number("factor", 5.0, *_FACTORS, "")
    if unit == "mm":
        length = element.number("length", 113.0, LEAST_MM, MOST_MM)
        place = element.number("position", 0.0, -MOST_MM, MOST_MM)
        if kind == "peak":
            return Peak(factor=factor, center_mm=place, length_mm=length)
        return Gradual(factor=factor, start_mm=place, length_mm=length)
    length = element.number("length", 113.0, _LEAST_DEG, 360.0, unit)
    place = element.number("position", 0.0, 0.0, 360.0, unit)
    if kind == "peak":
        return TurnPeak(factor=factor, center_deg=place, length_deg=length)
    element.say("the frequency of an axial grating has no slope here; it is the same all round")
    return None


def travelling(grating: LinearGrating, element: GenElement) -> LinearGrating | None:
    """Linear grating with a texture's motion; None if that cannot be shown.

    A grating that is carried along is the same as one whose ridges move by the part of the motion
    that goes across them.
    """
    motion = element.one("motion")
    if motion is None:
        return grating
    if not motion.switch("enable", False):
        motion.forget()
        return grating
    if grating.distortion is not None:
        return None
    speed = motion.number("velocity", 50.0, -_MOST_MM_S, _MOST_MM_S, "mm/s")
    direction = motion.number("direction", 0.0, -1e6, 1e6, "°")
    across = speed * math.cos(math.radians(direction - (grating.wave_angle_deg or 0.0)))
    total = grating.velocity_mm_s + (across if abs(across) >= _STILL else 0.0)
    return replace(grating, velocity_mm_s=max(-_MOST_MM_S, min(_MOST_MM_S, total)))


def turned(angle_deg: float) -> float:
    """Angle within a turn."""
    return math.fmod(angle_deg, 360.0)


def _double(element: GenElement, context: GenContext) -> AnyPattern | None:
    seed = element.point("seed", (0.0, 0.0))
    angle = element.number("angle", 0.0, -1e6, 1e6, "°")
    ridge = element.number("primary_ridge_size", 8.0, 0.0, MOST_MM)
    gap = element.number("primary_gap_size", 0.0, 0.0, MOST_MM)
    scale = element.number("secondary_scale", 1.0, 0.0, MOST_MM, "")
    # OpenLatero takes whatever it does not know as parallel.
    parallel = "parallel"
    constraint = element.word("constraint", ("orthogonal", parallel), parallel)
    orthogonal = constraint == "orthogonal" or element.one("constraint") is None
    amplitudes = [
        element.number(f"{which}_amplitude", 1.0, 0.0, 1.0, "share")
        for which in ("primary", "secondary")
    ]
    if min(ridge, ridge * scale) < LEAST_MM:
        element.say(f"its ridges are below {LEAST_MM} mm; left out")
        return None
    made: list[AnyPattern | None] = []
    for number, amplitude in enumerate(amplitudes):
        times = scale if number else 1.0
        direction = turned(angle + (90.0 if number and orthogonal else 0.0))
        grating = LinearGrating(
            ridge_mm=ridge * times,
            gap_mm=min(gap * times, MOST_MM),
            wave_angle_deg=direction or None,
            start_mm=seed,
        )
        grating = travelling(grating, element) or grating
        made.append(changed(grating, amplitude, False, None))
    pattern = joined(element, made, context)
    return None if pattern is None else _unread(pattern, element, context)


def _combo(element: GenElement, context: GenContext) -> AnyPattern | None:
    parts = [context.pattern(part) for part in element.every("Pattern")]
    pattern = joined(element, parts, context)
    return None if pattern is None else _changed(_carried(pattern, element), element, context)


def _blend(element: GenElement, context: GenContext) -> AnyPattern | None:
    """A texture by the hand's movement."""
    parts = element.every("Pattern")
    if len(parts) == 2:
        first, second = map(context.pattern, parts)
    else:
        for part in parts:
            part.forget()
        element.say(f"it has {len(parts)} textures instead of 2; OpenLatero's own are taken")
        first = LinearGrating(ridge_mm=8.0, wave_angle_deg=90.0)
        second = LinearGrating(ridge_mm=8.0)
    pattern = reacting(first, second, element.part("Modulator"), context)
    return _changed(_carried(pattern, element), element, context)


def _motion(element: GenElement, context: GenContext) -> AnyPattern | None:
    cue = element.word("cue_type", _CUES, "none")
    angle = turned(element.number("direction", 0.0, -1e6, 1e6, "°"))
    speed = element.number("velocity", 50.0, -_MOST_MM_S, _MOST_MM_S, "mm/s")
    part = element.one("Pattern")
    pattern = LinearGrating(ridge_mm=8.0) if part is None else context.pattern(part)
    if pattern is None:
        return None
    if cue != "none":
        element.say(
            f'the moving bands of its cue "{cue}" are {_BAND_MM:g} mm wide here, {_BAND_GAP_MM:g} '
            "apart, and may be wider there"
        )
        pattern = _cued(pattern, cue, angle, speed)
    return _unread(_carried(pattern, element), element, context)


def _cued(pattern: AnyPattern, cue: str, angle_deg: float, speed_mm_s: float) -> Group:
    """Texture over which bands move under the finger, whether the hand moves or not: 9.3."""
    wave = LinearGrating(
        ridge_mm=_BAND_MM,
        gap_mm=_BAND_GAP_MM,
        wave_angle_deg=angle_deg or None,
        velocity_mm_s=speed_mm_s,
    )
    bands = Moving(part=wave, array_at_mm=(0.0, 0.0))
    if cue in ("vibration bands", "blending bands"):
        to = UniformVibration() if cue == "vibration bands" else Uniform(level=0.5)
        return Group(operation="blend", parts=(pattern, to), by=bands)
    if cue == "disabling bands":
        return Group(operation="multiply", parts=(pattern, replace(bands, inverted=True)))
    swing = Vibration() if cue == "superposed vibration bands" else None
    weak = replace(bands, amplitude=_BAND_AMPLITUDE, vibration=swing)
    return Group(operation="add", parts=(pattern, weak))


def _tile(element: GenElement, context: GenContext) -> AnyPattern | None:
    width = element.number("grid_width", 20.0, 0.1, MOST_MM)
    height = element.number("grid_height", 20.0, 0.1, MOST_MM)
    found = element.one("Pattern")
    part: AnyPattern | None
    if found is None:
        part = Circle(center_mm=(10.0, 10.0), radius_mm=5.0, stroke=Stroke(width_mm=1.0))
    else:
        part = context.pattern(found)
    if part is None:
        return None
    tile = Tile(width_mm=width, height_mm=height, part=part)
    if context.as_shown and found is not None:
        # It reads the changes of its pattern as its own.
        tile = _changed(tile, found, context)
    if context.as_shown:
        element.skip("motion")
        return _unread(tile, element, context)
    return _unread(_carried(tile, element), element, context)


def _changed(pattern: AnyPattern, element: GenElement, context: GenContext) -> AnyPattern:
    """Pattern with the changes that an element names."""
    amplitude = element.number("amplitude", 1.0, 0.0, 1.0, "share")
    inverted = element.switch("invert", False)
    return changed(pattern, amplitude, inverted, vibration(element, context))


def _unread(pattern: AnyPattern, element: GenElement, context: GenContext) -> AnyPattern:
    """Pattern with changes that an element names, although OpenLatero does not read them there."""
    made = _changed(pattern, element, context)
    if made is not pattern:
        names = "its amplitude, invert and vibration"
        if context.as_shown:
            element.say(f"{names} are ignored, as OpenLatero does")
            made = pattern
        else:
            element.say(f"{names} are as the file says; OpenLatero does not read them here")
    return made


def _carried(pattern: AnyPattern, element: GenElement, *, moves: bool = True) -> AnyPattern:
    """Texture that moves as a whole (eq. 9.1), or stands where the array is, as an element says."""
    velocity = (0.0, 0.0)
    motion = element.one("motion") if moves else None
    if motion is not None and motion.switch("enable", False):
        speed = motion.number("velocity", 50.0, -_MOST_MM_S, _MOST_MM_S, "mm/s")
        direction = math.radians(motion.number("direction", 0.0, -1e6, 1e6, "°"))
        velocity = speed * math.cos(direction), speed * math.sin(direction)
    elif motion is not None:
        motion.forget()
    center = element.one("td_centric")
    if center is None and velocity == (0.0, 0.0):
        return pattern
    place = None if center is None else center.place((0.0, 0.0))
    return Moving(part=pattern, velocity_mm_s=velocity, array_at_mm=place)


_READERS: dict[str, Callable[[GenElement, GenContext], AnyPattern | None]] = {
    "Null": _null,
    "Plain": _plain,
    "Vibration": _vibration,
    "LinearGrating": _linear,
    "RadialGrating": _radial,
    "AxialGrating": _axial,
    "DoubleLinearGrating": _double,
    "Combo": _combo,
    "Blend": _blend,
    "Motion": _motion,
    "Pattern": _tile,
}
SUBTYPES = tuple(_READERS)
