"""Patterns of OpenLatero's elements: groups, pictures, textures, and shapes with their strokes.

A maker makes None, and says so, where there is nothing to show, and raises ValueError where there
can be no such pattern.
"""

from __future__ import annotations

import math
from itertools import groupby
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from msgspec.structs import replace

from vbraille.errors import InputError, needing_extras
from vbraille.scene.geometry import joints, rounding_radius_mm, rows_of
from vbraille.scene.images import ImageFile
from vbraille.scene.measures import LEAST_MM, MOST_MM
from vbraille.scene.openlatero.elements import Element
from vbraille.scene.patterns import (
    Across,
    Along,
    AxialGrating,
    Circle,
    Dots,
    DotStyle,
    Dotting,
    Fill,
    Gradual,
    Group,
    Image,
    LinearGrating,
    Moving,
    MovingCue,
    PathShape,
    Peak,
    Polygon,
    RadialGrating,
    SignalLevel,
    StraightLine,
    Stroke,
    Tile,
    TurnPeak,
    Uniform,
    UniformVibration,
    VertexMarkers,
    Vibration,
    meeting_edges,
)
from vbraille.scene.signals import Direction, Speed, Switch
from vbraille.sounds import read_sound
from vbraille.wording import nearest

if TYPE_CHECKING:
    from collections.abc import Callable

    from vbraille.scene.patterns import AnyPattern, Operation

    Made = AnyPattern | None
    Maker = Callable[[Element], Made]


# The surface that the pictures stand on, which no file says.
SURFACE_MM = (289.9, 230.1875)
_LEAST_SIZE_MM = 0.1
_DEEPEST = 32  # patterns within one another
_STILL_MM_S = 1e-3  # below which OpenLatero takes a projected speed as none
_NOTHING = Uniform(level=0.0)
_USUAL = LinearGrating(ridge_mm=8.0)  # the texture where none is given
OPERATIONS: Final[dict[str, Operation]] = {
    "multiply": "multiply",
    "add": "add",
    "max": "maximum",
    "blend": "blend",
    "overwrite": "overwrite",
}
# Textures whose amplitude, inversion and vibration OpenLatero does not read.
_UNREAD = ("DoubleLinearGrating", "Motion", "Pattern")


def pattern_of(leaf: Element) -> Made:
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
    tables = ("texture", name) if kinds is TEXTURES else (name,)
    try:
        element = Element(leaf.xml, leaf.context, leaf, "Pattern", *tables)
        pattern = kinds[name](element)
        if kinds is TEXTURES and name != "Null" and pattern is not None:
            pattern = _finished(pattern, element, name)
    except ValueError as error:
        leaf.say(f"{error}; left out")
        return None
    if pattern is not None:
        leaf.context.made[id(pattern)] = (pattern, leaf.line)
    return pattern


# Groups, and what reacts to the hand


def _operation_of(operation: Element, usual: str) -> str:
    """Name that OpenLatero has for how the parts of an element are put together."""
    if not operation.there:
        return usual
    # Old files have it as text.
    known = (*OPERATIONS, "reactive")
    return operation.word(operation.attribute("type") or operation.text, known, usual)


def _group(element: Element) -> Made:
    """Patterns put together; sounds, of which nothing is felt, stand beside the others."""
    if not element.Pattern:
        element.say("it has no patterns; left out")
        return None
    parts = [pattern_of(part) for part in element.Pattern]
    sounds = tuple(one for part in parts if _is_sound(part) for one in getattr(part, "parts", ()))
    felt = _joined(element.operation, [part for part in parts if not _is_sound(part)])
    if not sounds:
        return felt
    if isinstance(felt, Group) and felt.operation in ("maximum", "add"):
        return replace(felt, parts=felt.parts + sounds)
    return Group(operation="maximum", parts=sounds if felt is None else (felt, *sounds))


def _is_sound(part: Made) -> bool:
    return isinstance(part, Group) and all(one.sound for one in part.parts)


def _joined(operation: Element, parts: list[Made]) -> Made:
    """Parts put together as an element says; None for those that are left out, and for nothing."""
    name = _operation_of(operation, "max")
    if name == "reactive":
        if len(parts) != 2:
            operation.say(f"a reactive group is of 2 patterns, and this has {len(parts)}")
        return _reacting(operation.Modulator, *(*parts, None, None)[:2])
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
    if len(found) < 2:
        return found[0] if found else None
    if name == "overwrite":
        operation.say("its layers hide a little more or less of what is below them here than there")
    return Group(operation=OPERATIONS[name], parts=tuple(found))


def _reacting(modulator: Element, first: Made, second: Made) -> AnyPattern:
    """Blend of two patterns by the hand's movement; it is the first where the modulator is 1."""
    kind = modulator.word(modulator.attribute("type"), ("Directional", "Velocity"), "Directional")
    name, signal = "way", None
    if kind == "Velocity":
        name = "slow"
        signal = Speed(
            below_mm_s=modulator.limit,
            transition_mm_s=modulator.transition,
            # Theirs is the time until it has risen: half of it waits.
            delay_s=modulator.delay / 2000.0,
        )
    else:
        signal = Direction(**modulator.here)
    by = SignalLevel(name=modulator.context.signal(name, signal))
    return Group(operation="blend", parts=(second or _NOTHING, first or _NOTHING), by=by)


def _toggle(element: Element) -> Made:
    """Two patterns that a key swaps, as a button does there."""
    if len(element.Pattern) != 2:
        element.say(f"a toggle is of 2 patterns, and this has {len(element.Pattern)}; left out")
        return None
    layers: list[AnyPattern] = []
    for leaf, name, levels in zip(
        element.Pattern, ("first", "second"), ((1.0, 0.0), (0.0, 1.0)), strict=True
    ):
        part = pattern_of(leaf)
        factor = element.context.signal(name, Switch(title="button", levels=levels))
        if part is not None and part.factor:
            part = Group(operation="maximum", parts=(part,))
        layers += [] if part is None else [replace(part, factor=factor)]
    return Group(operation="maximum", parts=tuple(layers)) if layers else None


# Pictures and sounds


def _image(element: Element) -> Made:
    """A picture as the mask of a texture."""
    leaf, mask = element.Pattern, element.mask
    if not leaf.there:
        element.say("it has no texture, and OpenLatero ends at it; left out")
        return None
    texture = pattern_of(leaf)
    if texture is None:
        element.say("there is nothing of its texture to show; left out")
        return None
    kind = leaf.attribute("type")
    if kind != "Texture":
        element.say(f"it is the mask of a {kind}, as the file says; OpenLatero does not show it")
    image = _masked(mask)
    if image is None:
        return None
    if not image.nearest:
        mask.say("between pixels it is bilinear here, and the nearest pixel counts there")
    return replace(image, texture=None if texture == Uniform() else texture)


def _audio(element: Element) -> Made:
    """Masks that are not felt, each with the sound of those that are in it."""
    found: list[AnyPattern] = []
    for sound in element.sound:
        name, folder = sound.audiofile.text, element.context.folder
        try:
            if not name:
                raise InputError("its sound is not named")
            read_sound(folder / name)
        except InputError as error:
            sound.say(f"{_in(folder, error)}; left out")
            continue
        image = _masked(sound.mask)
        if image is not None:
            found.append(replace(image, amplitude=0.0, sound=name, title=Path(name).stem))
    return Group(operation="maximum", parts=tuple(found)) if found else None


def _masked(mask: Element) -> Image | None:
    """Picture of a mask where it is; None if there is none."""
    file, context = mask.imgfile, mask.context
    name = beside = file.text
    if name[:1] == "/" and not Path(name).is_file():
        # OpenLatero itself writes "/mask.png" for a picture that stands beside the scene.
        beside = name[1:]
    if not name:
        mask.say("its picture is not named; left out")
        return None
    if beside != name and "/" not in beside and (context.folder / beside).is_file():
        file.say(f"{name} is not there, and {beside} beside this file is taken")
        name = beside
    channel = "alpha" if file.attribute("type") == "alpha" else "gray"
    try:
        picture = ImageFile(context.folder / name)
        picture.intensities(channel, 1, 1)
    except (InputError, OSError, ValueError) as error:
        file.say(f"its picture is left out: {_in(context.folder, error)}")
        return None
    columns, rows = picture.columns, picture.rows
    # Usually the largest size that fits on the surface in the picture's shape.
    high = min(SURFACE_MM[1], SURFACE_MM[0] * rows / columns)
    fitting = (high * columns / rows, high)
    whole = fitting if mask.reference_maximized else SURFACE_MM
    width, height = map(_extent_mm, (mask.width, mask.height), fitting, whole)
    left, top = (SURFACE_MM[0] - width) / 2, (SURFACE_MM[1] - height) / 2
    if mask.position.text != "centered":
        left, top = mask.position.place((left, top))
    blur = 2.0 * math.sqrt(width / columns * height / rows) if mask.blur else 0.0
    if mask.blur and not context.as_shown:
        mask.say("its blur is of 2 pixels of the picture, as mm here, and does not end at 4 pixels")
    return Image(
        **mask.here,
        file=name,
        # To the nanometre, since people read it.
        place_mm=(round(left, 6), round(top, 6)),
        width_mm=round(width, 6),
        height_mm=round(height, 6),
        channel=channel,
        blur_mm=round(blur, 6),
        nearest=context.as_shown,
    )


def _extent_mm(element: Element, fitting: float, whole: float) -> float:
    """Width or height that an element tells of, in mm or as a share of the whole."""
    if element.attribute("units") != "%":
        return element.number(fitting, "mm", _LEAST_SIZE_MM)
    return whole * element.number(1.0, "share", _LEAST_SIZE_MM / whole, MOST_MM / whole)


def _in(folder: Path, error: Exception) -> str:
    """Message about a file, with its name as it is seen from the scene."""
    return str(error).replace(f"{folder}/", "")


# Textures


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


def _finished(part: AnyPattern, element: Element, name: str) -> AnyPattern:
    """Texture with its motion (eq. 9.1), where the array is taken to be, and its changes."""
    motion, velocity = element.motion, (0.0, 0.0)
    if not isinstance(part, Uniform | UniformVibration):
        if isinstance(part, LinearGrating) and part.distortion is None:
            part = _across(motion, part)
        elif motion.enable:
            way = math.radians(motion.direction)
            velocity = motion.velocity * math.cos(way), motion.velocity * math.sin(way)
        center = element.td_centric.place((0.0, 0.0)) if element.td_centric.there else None
        if center is not None or velocity != (0.0, 0.0):
            part = Moving(part=part, velocity_mm_s=velocity, array_at_mm=center)
    vibration = _vibration_of(element.vibration)
    made = _changed(part, element.amplitude, element.invert, vibration)
    if made is part or name not in _UNREAD:
        return made
    if element.context.as_shown:
        return part
    changes = "its amplitude, invert and vibration are"
    element.say(f"{changes} as the file says; OpenLatero does not read them here")
    return made


def _vibration(element: Element) -> Made:
    return UniformVibration(frequency_hz=element.context.truncated(element.freq))


def _linear(element: Element) -> Made:
    return _grating(element, LinearGrating)


def _radial(element: Element) -> Made:
    return _grating(element, RadialGrating)


def _axial(element: Element) -> Made:
    wave = element.Grating
    if wave.ridge_size + wave.gap_size > 360.0:
        wave.gap_size = 360.0 - wave.ridge_size
        wave.say(f"its ridge and gap are more than a turn; a gap of {wave.gap_size:g}° is taken")
    middle = float(not wave.invert)  # it is inverted with the grating
    return _grating(element, AxialGrating, whole_cycles=False, middle=middle)


def _grating(element: Element, kind: Callable[..., AnyPattern], **more: Any) -> Made:
    """Grating; what is the same everywhere if it is off, and None if it has no ridges."""
    wave = element.Grating
    if not wave.enable:
        return Uniform(level=float(wave.invert))
    turns = kind is AxialGrating
    unit, least, most = ("°", 0.5, 3600.0) if turns else ("mm", LEAST_MM, 1000.0)
    ridge = wave.ridge_size
    if ridge < least:
        wave.say(f"its ridges are {ridge:g} {unit}, and must be {least:g} or more; left out")
        return None
    distortion = _distortion(wave.PitchModulator, turns)
    # Where the frequency changes, ridges do not move in OpenLatero either.
    speed = wave.context.truncated(_speed_of(wave, unit, most), ridge + wave.gap_size)
    more["velocity_deg_s" if turns else "velocity_mm_s"] = 0.0 if distortion else speed
    return kind(**element.here, **wave.here, **more, distortion=distortion)


def _distortion(pitch: Element, turns: bool) -> Gradual | Peak | TurnPeak | None:
    """Change of the frequency along a grating; None if it is the same everywhere."""
    if not pitch.enable:
        return None
    kind = pitch.word(pitch.attribute("type"), ("slope", "peak"), "slope")
    if not turns and kind == "slope":
        return Gradual(**pitch.here, start_mm=pitch.position)
    if not turns:
        return Peak(**pitch.here, center_mm=pitch.position)
    if kind == "peak":
        return TurnPeak(**pitch.here, center_deg=pitch.position)
    pitch.say("the frequency of an axial grating has no slope here; it is the same all round")
    return None


def _double(element: Element) -> Made:
    """Two gratings, each of which moves by itself."""
    ridge, gap = element.primary_ridge_size, element.primary_gap_size
    if min(ridge, ridge * element.secondary_scale) < LEAST_MM:
        element.say(f"its ridges are below {LEAST_MM} mm; left out")
        return None
    turn = 90.0 if element.constraint == "orthogonal" else 0.0
    both: list[Made] = []
    for scale, angle, amplitude in (
        (1.0, element.angle, element.primary_amplitude),
        (element.secondary_scale, element.angle + turn, element.secondary_amplitude),
    ):
        grating = LinearGrating(
            ridge_mm=ridge * scale,
            gap_mm=min(gap * scale, MOST_MM),
            wave_angle_deg=math.fmod(angle, 360.0),
            start_mm=element.seed,
        )
        both.append(_changed(_across(element.motion, grating), amplitude))
    element.motion.enable = False
    return _joined(element.operation, both)


def _blend(element: Element) -> Made:
    """One of two textures by the movement of the hand."""
    found = [pattern_of(part) for part in element.Pattern]
    if len(found) != 2:
        element.say(f"it has {len(found)} textures instead of 2; OpenLatero's own are taken")
        found = [replace(_USUAL, wave_angle_deg=90.0), _USUAL]
    return _reacting(element.Modulator, *found)


def _motion(element: Element) -> Made:
    """A texture over which bands move under the finger, whether the hand moves or not: 9.3."""
    cue, context = element.cue_type, element.context
    under = pattern_of(element.Pattern) if element.Pattern.there else _USUAL
    if under is None or cue == "none":
        return under
    ridge, gap = 5.0 if "vibration" in cue else 2.0, 30.0
    wave = LinearGrating(
        ridge_mm=ridge,
        gap_mm=gap,
        wave_angle_deg=element.direction,
        velocity_mm_s=context.truncated(element.velocity, ridge + gap),
    )
    bands = Moving(part=wave, array_at_mm=(0.0, 0.0))
    if cue == "disabling bands":
        return Group(operation="multiply", parts=(under, replace(bands, inverted=True)))
    if "superposed" not in cue:
        other = UniformVibration() if cue == "vibration bands" else Uniform(level=0.5)
        return Group(operation="blend", parts=(under, other), by=bands)
    vibration = None
    if "vibration" in cue and not context.as_shown:
        element.say("its bands vibrate, as their name says; OpenLatero's do not")
        vibration = Vibration()
    # OpenLatero weakens bands that are added.
    return Group(operation="add", parts=(under, _changed(bands, 0.2, vibration=vibration)))


def _tile(element: Element) -> Made:
    ring = Circle(center_mm=(10.0, 10.0), radius_mm=5.0, stroke=Stroke(width_mm=1.0))
    part = pattern_of(element.Pattern) if element.Pattern.there else ring
    if part is None:
        return None
    if element.context.as_shown:  # which does not read it
        element.motion.enable = False
    return Tile(**element.here, part=part)


# Shapes


def _vibration_of(element: Element, always_up: str = "") -> Vibration | None:
    """Vibration that an element tells of; None if it is off.

    Parameters
    ----------
    element
        The element of the vibration.
    always_up
        What it is a vibration of, such as "dots", if that has nothing that is down.
    """
    if not element.there or not element.enable:
        return None
    swing = _swing(element)
    if element.blend_mode == "high":
        return swing
    if always_up:
        element.say(f"{always_up} have nothing down that could vibrate; what is up does")
        return swing
    if element.context.as_shown:  # which ignores it
        return swing
    element.say("what is down vibrates, as the file says; OpenLatero ignores blend_mode low")
    return replace(swing, of="low")


def _swing(element: Element) -> Vibration:
    """Vibration of what is up, whether it is on or off."""
    return Vibration(**element.here, frequency_hz=element.context.truncated(element.frequency))


def _speed_of(wave: Element, unit: str = "mm", most: float = 1000.0) -> float:
    """Speed of the ridges of a grating, in a unit per second."""
    speed, in_hertz = wave.velocity
    speed *= wave.ridge_size + wave.gap_size if in_hertz else 1.0
    if abs(speed) > most:
        wave.say(f"its ridges would move at {speed:g} {unit}/s; {most:g} is taken")
    return max(-most, min(most, speed))


def _ripples(texture: Element) -> Across | None:
    """Texture across a profile; None for none."""
    if not texture.enable or not texture.amplitude:
        return None
    return Across(**texture.here, cycles=2 * int(texture.nb_cycles) + 1)


def _look(element: Element) -> dict[str, Any]:
    """Look of a shape: its amplitude, fill, and stroke or dots with their cue.

    It is empty if nothing of it is felt, which is said.
    """
    look: dict[str, Any] = {"amplitude": element.stroke.intensity, **_drawn(element)}
    if hasattr(element, "fill_texture"):
        look["fill"] = _fill(element.fill_texture, look)
    if any(look.get(part) for part in ("stroke", "dots", "fill")):
        return look
    element.say("nothing of it can be felt; left out")
    return {}


def _drawn(element: Element) -> dict[str, Any]:
    """Stroke or dots of a shape, and the cue that moves over them."""
    stroke = element.stroke
    ridge, dots, fill = stroke.ridge, stroke.dots, stroke.fill
    width, other = stroke.width, ridge.width
    if ridge.has("width") and other != width:
        ridge.say(
            f"stroke ridge width is {other:g} and stroke width {width:g}; "
            f"the stroke is {min(other, width):g} mm wide here"
        )
        width = min(other, width)
    if width < LEAST_MM:
        stroke.say(f"stroke width is {width:g}, so there is no stroke")
        return {}
    # OpenLatero reads both into one profile and one vibration, the stroke's last.
    edge = (ridge if ridge.has("edge_width") else dots.ridge).edge_width
    across = _ripples(
        (ridge if ridge.has("width", "edge_width", "texture") else dots.ridge).texture
    )
    swinging = (fill if fill.there else dots).vibration
    vibration = _vibration_of(swinging, "dots" if dots.enable else "")
    if not dots.enable:
        plain = Stroke(width_mm=width, edge_mm=edge, across=across)
        made = _stroke(stroke, plain, vibration)
        return {"stroke": made, "cue": _cue(stroke.motion)} if made else {}
    corner = None
    # Dots on marked corners swing where others do not, and the other way round.
    if hasattr(element, "corner") and element.corner.enable:
        corner = _swing(swinging) if vibration is None else Vibration(amplitude=0.0)
    radius, height = width / 2, dots.height
    dot = DotStyle(
        radius_mm=radius, edge_mm=edge, amplitude=height, across=across, vibration=vibration
    )
    speed = _own_speed(stroke, 0.0)
    row = Dotting(**dots.here, dot=dot, vertex_vibration=corner, velocity_mm_s=speed)
    return {"dots": row, "cue": _cue(stroke.motion)}


def _own_speed(stroke: Element, along: float) -> float:
    """Speed of the texture along a stroke, whose own it is without a cue, or of the dots."""
    # A speed alone is that of the cue "none", by which nothing moves.
    if not stroke.motion.has("cue", "velocity"):
        return along
    return stroke.motion.velocity if stroke.motion.cue == "inherent" else 0.0


def _stroke(stroke: Element, plain: Stroke, vibration: Vibration | None) -> Stroke | None:
    """Stroke with the texture along it; None if nothing of it can be felt."""
    fill, wave, width = stroke.fill, stroke.fill.Grating, plain.width_mm
    fits = width >= 4 * plain.edge
    if wave.enable and wave.ridge_size >= LEAST_MM:
        along = Along(**wave.here, whole_cycles=False, whole_edges=fill.gutter and fits)
        speed = stroke.context.truncated(_own_speed(stroke, _speed_of(wave)), along.wave.length)
        return replace(plain, along=replace(along, velocity_mm_s=speed), vibration=vibration)
    if wave.enable:
        wave.say(f"its ridges are {wave.ridge_size:g} mm, so the stroke has no texture here")
    if vibration is not None and vibration.of == "low":
        if fill.gutter:
            fill.say("the middle of an outlined stroke does not vibrate here")
        vibration = None  # there is nothing in it that is down
    if fill.gutter and not fits:
        needs = "the outline needs a stroke of four edges, and OpenLatero shows nothing"
        if stroke.context.as_shown:
            fill.say(f"{needs}, which hides what is below it there")
            return None
        fill.say(f"{needs}; an edge of {width / 4:g} mm is taken")
        plain = replace(plain, edge_mm=width / 4)
    return replace(plain, outlined=fill.gutter, vibration=vibration)


def _cue(motion: Element) -> MovingCue | None:
    """Bands that move along a shape; None for none."""
    way, level, bands = motion.cue, motion.blend_value, motion.Grating
    if way in ("none", "inherent"):
        return None
    if not bands.enable or bands.ridge_size < LEAST_MM:
        motion.say("its cue has no bands; left out")
        return None
    vibration = _vibration_of(motion.vibration, "bands")
    stands = motion.context.as_shown or motion.vibration.there
    if way == "vibrate" and vibration is None and stands:  # what does not vibrate is up
        way, level = "blend", 1.0
    speed = _speed_of(bands) if bands.has("velocity") else motion.velocity
    return MovingCue(
        **motion.here,
        **bands.here,
        way=way,
        velocity_mm_s=motion.context.truncated(speed, bands.ridge_size + bands.gap_size),
        level=level,
        vibration=vibration,
        whole_cycles=False,
    )


def _fill(element: Element, look: dict[str, Any]) -> Fill | None:
    """Fill of a closed shape of a look; None for nothing."""
    if not element.enable:
        return None
    # Without a texture OpenLatero takes one of its own.
    texture = pattern_of(element.Pattern) if element.Pattern.there else _USUAL
    if texture is None:
        element.say("the fill is left out, since there is nothing of its texture to show")
        return None
    if element.gap < 0:
        if look.get("dots"):
            element.say("dots stand in the place of the fill there, and are blended into it here")
        return Fill(texture=texture, blended=True)
    cue, stroke = look.get("cue"), look.get("stroke")
    weakens = cue and stroke and cue.way == "add" and stroke.width_mm >= cue.width_mm
    share = cue.share if cue and weakens else 0.0
    if element.context.as_shown and share:
        texture = Group(operation="maximum", parts=(texture,), amplitude=1.0 - share)
    return Fill(**element.here, texture=texture, gap_mm=element.gap)


def _paced(shape: StraightLine | Circle, length_mm: float, element: Element) -> AnyPattern:
    """Shape whose dots, if they move, come round after whole microseconds, as they do there."""
    if shape.dots is None:
        return shape
    speed = element.context.truncated(shape.dots.velocity_mm_s, length_mm)
    return replace(shape, dots=replace(shape.dots, velocity_mm_s=speed))


def _line(element: Element) -> Made:
    look = _look(element)
    if not look:
        return None
    line = StraightLine(**element.here, **look)
    _, rows = rows_of(line)
    length = math.dist(line.start_mm, line.end_mm)
    return _paced(line, length + rows[0].pitch_mm, element) if rows else line


def _circle(element: Element) -> Made:
    look = _look(element)
    if not look:
        return None
    return _paced(Circle(**element.here, **look), math.tau * element.radius, element)


def _polygon(element: Element) -> Made:
    """Polygon, or a path if its edges cross."""
    # Vertices that stand on the one before are passed over.
    vertices = tuple(vertex for vertex, _ in groupby(element.vertices.vertex))
    if len(vertices) > 1 and vertices[0] == vertices[-1]:
        vertices = vertices[:-1]
    look = _look(element)
    if not look:
        return None
    markers = _markers(element.corner, look)
    if len(vertices) > 2 and meeting_edges(vertices) is not None:
        lost = " and its markers are left out" if markers is not None else ""
        element.say(f"its edges cross, so it is a path here; textures jump at its corners{lost}")
        return PathShape(contours_mm=(vertices,), closed=True, **look)
    polygon = Polygon(vertices_mm=vertices, **element.join.here, markers=markers, **look)
    along = polygon.stroke is not None and polygon.stroke.along is not None
    wanted = rounding_radius_mm(polygon)
    if (markers is not None or (polygon.join == "rounded" and along)) and any(
        joint.radius_mm < wanted for joint in joints(vertices, wanted)
    ):
        element.say("an edge is too short for the round joints at its ends, which are smaller here")
    return polygon


def _markers(corner: Element, look: dict[str, Any]) -> VertexMarkers | None:
    """Markers at the vertices of a polygon of a look; None for none."""
    stroke = look.get("stroke")
    if not corner.enable or stroke is None:
        return None
    if corner.blend == "in":
        corner.say("markers blend outwards here, not inwards")
    if look["cue"] and not corner.motion:
        corner.say("its cue goes over the markers here")
    vibration = _vibration_of(corner.vibration, "markers")
    if corner.type == "invert vib":
        if stroke.along is not None or stroke.outlined:
            corner.say("markers are plain here, and have the texture of the stroke there")
        vibration = Vibration() if stroke.vibration is None else None
    angle = corner.user_angle if corner.span == "angle" else 30.0
    markers = VertexMarkers(**corner.here, angle_deg=angle)
    if vibration is None:
        return replace(markers, plain=True)
    return replace(markers, vibration=vibration)


def _dots(element: Element) -> Made:
    """Dots of one look, or a single one."""
    centers, operation = tuple(element.dot), _operation_of(element.operation, "add")
    if element.owner == "Dot":
        centers, operation = centers[:1] or ((0.0, 0.0),), "max"
    if not centers:
        element.say("it has no dots; left out")
        return None
    style = DotStyle(
        **element.here,
        edge_mm=element.ridge.edge_width,
        across=_ripples(element.ridge.texture),
        vibration=_vibration_of(element.vibration, "dots"),
    )
    if len(centers) > 1 and operation == "add":
        with needing_extras():
            from scipy.spatial import KDTree
        apart, _ = KDTree(centers).query(centers, k=2)
        if apart[:, 1].min() < 2 * element.dot_radius - 1e-9:
            element.say("dots that overlap add up in OpenLatero, and the larger one counts here")
    elif len(centers) > 1 and operation != "max":
        element.say(f'dots are put together by "maximum" here, and by "{operation}" there')
    return Dots(centers_mm=centers, dot=style)


# Makers of patterns by their types, and of textures by their subtypes.
PATTERNS: Final[dict[str, Maker]] = {
    "Group": _group,
    "Toggle": _toggle,
    "Image": _image,
    "Audio": _audio,
    "Line": _line,
    "Circle": _circle,
    "Polygon": _polygon,
    "Dot": _dots,
    "Dots": _dots,
}
TEXTURES: Final[dict[str, Maker]] = {
    "Null": lambda _: Uniform(level=0.0),
    "Plain": lambda _: Uniform(),
    "Vibration": _vibration,
    "LinearGrating": _linear,
    "RadialGrating": _radial,
    "AxialGrating": _axial,
    "DoubleLinearGrating": _double,
    "Combo": _group,
    "Blend": _blend,
    "Motion": _motion,
    "Pattern": _tile,
}
