"""Textures of OpenLatero's files, which cover the whole surface: gratings and all others."""

from __future__ import annotations

import math
from functools import partial
from typing import TYPE_CHECKING, Any

from msgspec.structs import replace

from vbraille.scene.measures import LEAST_MM, MOST_MM
from vbraille.scene.openlatero.context import (
    FREQUENCY,
    Kinds,
    changed,
    timed,
    travelled,
    vibration,
)
from vbraille.scene.openlatero.elements import ANGLE, OFF, ON, ORIGIN, SHARE, NumberField, WordField
from vbraille.scene.openlatero.groups import joined, reacting, read_group
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

if TYPE_CHECKING:
    from collections.abc import Callable

    from vbraille.scene.openlatero.context import GenContext
    from vbraille.scene.openlatero.elements import GenElement
    from vbraille.scene.patterns import AnyPattern

ROWS = Kinds()
_LEAST_DEG = 0.5
_MOST_DEG_S = 3600.0
_MOST_MM_S = 1000.0
_STILL = 1e-3  # mm/s, below which OpenLatero takes a projected speed as none


# Bands of a cue, which OpenLatero weakens where they are added.
_BAND_MM, _WIDE_BAND_MM, _BAND_GAP_MM, _BAND_AMPLITUDE = 2.0, 5.0, 30.0, 0.2
_WIDE = ("vibration bands", "superposed vibration bands")
_CUES = (
    "none",
    "vibration bands",
    "superposed bands",
    "superposed vibration bands",
    "disabling bands",
    "blending bands",
)


MOTION = {
    "enable": OFF,
    "velocity": NumberField(50.0, -_MOST_MM_S, _MOST_MM_S, "mm/s"),
    "direction": ANGLE,
}
_FACTOR = NumberField(5.0, 0.05, 20.0, "")
PITCH = {
    "enable": OFF,
    "factor": _FACTOR,
    "length": NumberField(113.0, LEAST_MM),
    "position": NumberField(0.0, -MOST_MM),
}
# That of an axial grating is in degrees.
PITCH_DEG = {
    "enable": OFF,
    "factor": _FACTOR,
    "length": NumberField(113.0, _LEAST_DEG, 360.0, "°"),
    "position": NumberField(0.0, 0.0, 360.0, "°"),
}
WAVE = {"enable": ON, "invert": OFF, "ridge_size": NumberField(8.0), "gap_size": NumberField(0.0)}
WAVE_DEG = {
    "enable": ON,
    "invert": OFF,
    "ridge_size": NumberField(36.0, 0.0, 360.0, "°"),
    "gap_size": NumberField(0.0, 0.0, 360.0, "°"),
}


@ROWS.row("Null")
def _null(element: GenElement, context: GenContext) -> AnyPattern:
    """Nothing, which has no changes either."""
    del context
    element.forget()
    return Uniform(level=0.0)


@ROWS.row("Plain")
def _plain(element: GenElement, context: GenContext) -> AnyPattern:
    return _even(Uniform(), element, context)


@ROWS.row("Vibration", freq=FREQUENCY)
def _vibration(element: GenElement, context: GenContext) -> AnyPattern:
    hertz = timed(element["freq"], context)
    return _even(UniformVibration(frequency_hz=hertz), element, context)


@ROWS.row("LinearGrating", angle=ANGLE, seed=ORIGIN)
def _linear(element: GenElement, context: GenContext) -> AnyPattern | None:
    angle = turned(element["angle"])
    make = partial(LinearGrating, wave_angle_deg=angle or None, start_mm=element["seed"])
    return _graded(make, _wave(element, "mm", context), element, context)


@ROWS.row("RadialGrating", seed=ORIGIN)
def _radial(element: GenElement, context: GenContext) -> AnyPattern | None:
    make = partial(RadialGrating, center_mm=element["seed"])
    return _graded(make, _wave(element, "mm", context), element, context)


@ROWS.row("AxialGrating", seed=ORIGIN, seed_angle=ANGLE)
def _axial(element: GenElement, context: GenContext) -> AnyPattern | None:
    start = turned(element["seed_angle"])
    make = partial(AxialGrating, center_mm=element["seed"], start_deg=start, whole_cycles=False)
    wave = _wave(element, "°", context)
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
        return _even(wave, element, context)
    pattern = make(**wave)
    moved = travelling(pattern, element) if isinstance(pattern, LinearGrating) else None
    return _changed(_carried(moved or pattern, element, moves=moved is None), element, context)


def _wave(element: GenElement, unit: str, context: GenContext) -> dict[str, Any] | Uniform | None:
    """Waveform of a grating, by the names of its fields here.

    It is what is the same everywhere if it is off, and None if it has no ridges.
    """
    turning = unit == "°"
    grating = element.part("Grating", WAVE_DEG if turning else WAVE)
    inverted = grating["invert"]
    if not grating["enable"]:
        grating.forget()
        return Uniform(level=float(inverted))
    least = _LEAST_DEG if turning else LEAST_MM
    ridge, gap = grating["ridge_size"], grating["gap_size"]
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
    element = grating.one("PitchModulator", PITCH if unit == "mm" else PITCH_DEG)
    if element is None:
        return None
    if not element["enable"]:
        element.forget()
        return None
    kind = element.chosen(element.attribute("type"), ("slope", "peak"), "slope")
    factor, length, place = element["factor"], element["length"], element["position"]
    if unit == "mm":
        if kind == "peak":
            return Peak(factor=factor, center_mm=place, length_mm=length)
        return Gradual(factor=factor, start_mm=place, length_mm=length)
    if kind == "peak":
        return TurnPeak(factor=factor, center_deg=place, length_deg=length)
    element.say("the frequency of an axial grating has no slope here; it is the same all round")
    return None


def travelling(grating: LinearGrating, element: GenElement) -> LinearGrating | None:
    """Linear grating with a texture's motion; None if that cannot be shown.

    A grating that is carried along is the same as one whose ridges move by the part of the motion
    that goes across them.
    """
    motion = element.one("motion", MOTION)
    if motion is None:
        return grating
    if not motion["enable"]:
        motion.forget()
        return grating
    if grating.distortion is not None:
        return None
    turn = math.radians(motion["direction"] - (grating.wave_angle_deg or 0.0))
    across = motion["velocity"] * math.cos(turn)
    total = grating.velocity_mm_s + (across if abs(across) >= _STILL else 0.0)
    return replace(grating, velocity_mm_s=max(-_MOST_MM_S, min(_MOST_MM_S, total)))


def turned(angle_deg: float) -> float:
    """Angle within a turn."""
    return math.fmod(angle_deg, 360.0)


@ROWS.row(
    "DoubleLinearGrating",
    seed=ORIGIN,
    angle=ANGLE,
    primary_ridge_size=NumberField(8.0),
    primary_gap_size=NumberField(0.0),
    secondary_scale=NumberField(1.0, unit=""),
    # OpenLatero takes whatever it does not know as parallel.
    constraint=WordField("parallel", ("orthogonal", "parallel")),
    primary_amplitude=SHARE,
    secondary_amplitude=SHARE,
)
def _double(element: GenElement, context: GenContext) -> AnyPattern | None:
    seed, angle = element["seed"], element["angle"]
    ridge, gap = element["primary_ridge_size"], element["primary_gap_size"]
    scale = element["secondary_scale"]
    orthogonal = element["constraint"] == "orthogonal" or element.one("constraint") is None
    amplitudes = element["primary_amplitude"], element["secondary_amplitude"]
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


@ROWS.row("Combo")
def _combo(element: GenElement, context: GenContext) -> AnyPattern | None:
    pattern = read_group(element, context)
    return None if pattern is None else _changed(_carried(pattern, element), element, context)


@ROWS.row("Blend")
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


@ROWS.row("Motion", cue_type=WordField("none", _CUES), direction=ANGLE, velocity=MOTION["velocity"])
def _motion(element: GenElement, context: GenContext) -> AnyPattern | None:
    cue, angle, speed = element["cue_type"], turned(element["direction"]), element["velocity"]
    part = element.one("Pattern")
    pattern = LinearGrating(ridge_mm=8.0) if part is None else context.pattern(part)
    if pattern is None:
        return None
    if cue != "none":
        if cue == "superposed vibration bands" and not context.as_shown:
            element.say("its bands vibrate, as their name says; OpenLatero's do not")
        pattern = _cued(pattern, cue, angle, speed, context)
    return _unread(_carried(pattern, element), element, context)


def _cued(
    pattern: AnyPattern, cue: str, angle_deg: float, speed_mm_s: float, context: GenContext
) -> Group:
    """Texture over which bands move under the finger, whether the hand moves or not: 9.3."""
    ridge = _WIDE_BAND_MM if cue in _WIDE else _BAND_MM
    wave = LinearGrating(
        ridge_mm=ridge,
        gap_mm=_BAND_GAP_MM,
        wave_angle_deg=angle_deg or None,
        velocity_mm_s=travelled(speed_mm_s, ridge + _BAND_GAP_MM, context),
    )
    bands = Moving(part=wave, array_at_mm=(0.0, 0.0))
    if cue in ("vibration bands", "blending bands"):
        to = UniformVibration() if cue == "vibration bands" else Uniform(level=0.5)
        return Group(operation="blend", parts=(pattern, to), by=bands)
    if cue == "disabling bands":
        return Group(operation="multiply", parts=(pattern, replace(bands, inverted=True)))
    swings = cue == "superposed vibration bands" and not context.as_shown
    swing = Vibration() if swings else None
    weak = replace(bands, amplitude=_BAND_AMPLITUDE, vibration=swing)
    return Group(operation="add", parts=(pattern, weak))


@ROWS.row("Pattern", grid_width=NumberField(20.0, 0.1), grid_height=NumberField(20.0, 0.1))
def _tile(element: GenElement, context: GenContext) -> AnyPattern | None:
    width, height = element["grid_width"], element["grid_height"]
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
    """Pattern with the changes that an element names, and not a word of the picture of it."""
    element.skip("icon")
    amplitude, inverted = element.read("amplitude", SHARE), element.read("invert", OFF)
    return changed(pattern, amplitude, inverted, vibration(element, context))


def _even(pattern: AnyPattern, element: GenElement, context: GenContext) -> AnyPattern:
    """Pattern that is the same everywhere, so that it shows no motion."""
    element.skip("motion", "td_centric")
    return _changed(pattern, element, context)


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
    motion = element.one("motion", MOTION) if moves else None
    if motion is not None and motion["enable"]:
        speed, direction = motion["velocity"], math.radians(motion["direction"])
        velocity = speed * math.cos(direction), speed * math.sin(direction)
    elif motion is not None:
        motion.forget()
    center = element.one("td_centric")
    if center is None and velocity == (0.0, 0.0):
        return pattern
    place = None if center is None else ORIGIN.read(center)
    return Moving(part=pattern, velocity_mm_s=velocity, array_at_mm=place)
