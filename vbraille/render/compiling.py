"""Scenes, compiled for a display, or for rasters of the whole canvas.

A scene becomes one list of instructions. Each part of it stands behind a box and a gate, by which
it is skipped where nothing of it can be felt.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import msgspec
import numpy as np

from vbraille.render import instructions as i
from vbraille.render import paths, work
from vbraille.render import signalkernels as kernels
from vbraille.render.cellkernels import TABLE
from vbraille.render.labels import Assets, box_of, pack_label
from vbraille.render.program import Program, head
from vbraille.render.work import MOST_SIGNALS, ProgramKind
from vbraille.scene.bitmap import WHOLE, bitmap_box, opaque
from vbraille.scene.bounds import bounds, drawn_radius_mm, is_everywhere, reach_mm
from vbraille.scene.dotting import PlacedDot
from vbraille.scene.joints import Cycle, axial_cycle, cue_cycle, stroke_cycles
from vbraille.scene.patterns import (
    Circle,
    Dots,
    Group,
    Image,
    Label,
    Moving,
    PathShape,
    Polygon,
    StraightLine,
    Tile,
)
from vbraille.scene.signals import Direction, Inverse, Product, Pulse, Speed, Switch, ordered
from vbraille.scene.textures import (
    AxialGrating,
    Gradual,
    LinearGrating,
    RadialGrating,
    SignalLevel,
    TurnPeak,
    Uniform,
    UniformVibration,
)
from vbraille.scene.traversal import drawn_vibrations, driving, each

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from numpy.typing import NDArray

    from vbraille.display import Display
    from vbraille.scene.bitmap import Bitmap
    from vbraille.scene.bounds import Box
    from vbraille.scene.measures import Point
    from vbraille.scene.pattern import Pattern
    from vbraille.scene.patterns import AnyPattern, Fill
    from vbraille.scene.scene import Canvas, Scene
    from vbraille.scene.signals import OrderedSignal
    from vbraille.scene.strokes import Across, DotStyle, MovingCue, Stroke, Vibration

_AnyGrating = LinearGrating | RadialGrating | AxialGrating
_FAR = 1e30  # stands for infinity
_SHARPEST = 1e9  # 1/mm, of a fill that does not fade in
_JOINS = {"add": i.ADD, "weighted": i.ADD, "maximum": i.MAXIMUM, "overwrite": i.OVER_ITSELF}
# Rows that an instruction leaves on the stack beside those that it takes.
_PUSHES = (
    dict.fromkeys((i.ADD, i.MAXIMUM, i.MULTIPLY, i.OVER_ITSELF, i.FILL), -1)
    | dict.fromkeys((i.OVER, i.BLEND, i.FILL_BLENDED, i.RESTORE), -2)
    | dict.fromkeys((i.LEVEL, i.SIGNAL, i.VIBRATION, i.LINEAR, i.RADIAL, i.AXIAL, i.IMAGE), 1)
    | dict.fromkeys((i.PIXELS, i.LABEL, i.LABEL_MASK, i.DOTS, i.PROFILE, i.BANDS, i.BEYOND), 1)
    | {i.CUE: 1, i.WRAP: 2, i.SHIFT: 2}
)


def compile_scene(
    scene: Scene, display: Display, assets: Assets | None = None, *, rate_hz: float = 1000.0
) -> Program:
    """Compile a scene for a display.

    Parameters
    ----------
    scene
        A resolved scene: without `Use` and `ImageDots`.
    display
        Display that shows it.
    assets
        Bitmaps of its images and cells of its labels.
    rate_hz
        Frames a second, of which a vibration may take half.

    Raises
    ------
    ValueError
        If a frequency is above half of the rate, or patterns stand too deep in each other.
    """
    moves_hz = [
        highest_hz(element, number, rate_hz) for number, element in enumerate(scene.elements, 1)
    ]
    moves_hz += [1.0 / one.period_s for one in scene.signals.values() if isinstance(one, Pulse)]
    numbers = head(display, ProgramKind.SCENE, i.CODE)
    numbers[i.COLUMN_MM] = display.column_pitch_mm
    numbers[i.ROW_MM] = display.row_pitch_mm
    numbers[work.FREQUENCY] = max(moves_hz, default=0.0)
    numbers[work.AMPLITUDE] = numbers[work.FREQUENCY] > 0.0
    writer = _Writer(scene, assets or Assets())
    writer.scene()
    return Program(*writer.finish(numbers))


def settled(scene: Scene, velocity_mm_s: Point = (0.0, 0.0), switches: int = 0) -> Scene:
    """Make the scene as it is under a hand that goes on at one velocity: Lévesque 2009, 9.6.

    Signals by the hand and by switches are as they have become then, and change no more.

    Parameters
    ----------
    scene
        A resolved scene.
    velocity_mm_s, switches
        The velocity, and states of the switches, as `vbraille.scene.signals.packed` has them.
    """
    values = SceneMap(scene).signal_values(0.0, velocity_mm_s, switches)
    signals = {
        one.name: Switch(levels=(value, value))
        for one, value in zip(ordered(scene.signals), values.tolist(), strict=False)
        if isinstance(one.signal, Speed | Direction | Switch)
    }
    return msgspec.structs.replace(scene, signals={**scene.signals, **signals})


def highest_hz(pattern: AnyPattern, number: int, rate_hz: float) -> float:
    """Find the highest frequency of what moves in an element by itself; 0 if nothing does.

    Parameters
    ----------
    pattern, number
        The element, and its number in the scene, from 1.
    rate_hz
        Frames a second that show it.

    Raises
    ------
    ValueError
        If a frequency is above half of the rate, so that it would be shown as another.
    """
    highest = 0.0
    for part in each(pattern):
        for hz in _frequencies(part):
            if hz > rate_hz / 2:
                name = part.id or pattern.id
                named = f'"{name}"' if name else f"number {number}"
                raise ValueError(
                    f"element {named} moves at {hz:g} Hz; it can be at most half of the rate, "
                    f"{rate_hz / 2:g} Hz"
                )
            highest = max(highest, hz)
    return highest


def _frequencies(pattern: AnyPattern) -> Iterator[float]:
    """Frequencies of a pattern itself, without those that stand in it."""
    for vibration in (pattern.vibration, *drawn_vibrations(pattern)):
        if vibration is not None and vibration.amplitude > 0.0:
            yield vibration.frequency_hz
    yield from (flow.flow_hz for flow in pattern.flows)
    if isinstance(pattern, Moving) and any(pattern.velocity_mm_s):
        yield 1.0  # it moves at any length of its waves


def signal_numbers(scene: Scene) -> NDArray[np.float64]:
    """Numbers of a scene's signals, as the kernels take them; float64[CODE - SIGNALS].

    Raises
    ------
    ValueError
        If there are more than 8 with the integrals of those that are the speed of a motion.
    """
    order = ordered(scene.signals, driving(*scene.elements)) if scene.signals else []
    if len(order) > MOST_SIGNALS:
        raise ValueError(
            f"there are {len(order)} signals, where each that is the speed of a motion counts "
            f"twice; there can be {MOST_SIGNALS}"
        )
    numbers = np.zeros(i.CODE - i.SIGNALS)
    numbers[0] = len(order)
    rows = numbers[1:].reshape(MOST_SIGNALS, i.SIGNAL_NUMBERS)
    for row, one in zip(rows, order, strict=False):
        own = _signal(one)
        row[: len(own)] = own
    return numbers


def _signal(one: OrderedSignal) -> tuple[float, ...]:
    """Numbers of a signal: its kind, and its own as `vbraille.render.signalkernels` has them."""
    match one.signal:
        case Speed() as speed:
            end = speed.below_mm_s + speed.transition_mm_s
            return (kernels.SPEED, speed.below_mm_s, end, speed.delay_s)
        case Direction() as way:
            angle = math.remainder(math.radians(way.angle_deg), 2.0 * math.pi)
            slow = way.below_mm_s, way.below_mm_s + way.slow_transition_mm_s
            last = way.tolerance_deg + way.transition_deg
            away = math.radians(way.tolerance_deg), math.radians(last)
            at_rest = {"high": kernels.HIGH, "low": kernels.LOW, "keep": kernels.KEEP}[way.at_rest]
            return (kernels.DIRECTION, angle, *slow, *away, float(way.axis), at_rest)
        case Switch() as switch:
            return (kernels.SWITCH, switch.fade_s, float(len(switch.levels)), *switch.levels)
        case Pulse() as clock:
            shapes = {"sine": kernels.SINE, "square": kernels.SQUARE, "ramp": kernels.RAMP}
            return (kernels.CLOCK, shapes[clock.shape], clock.period_s)
        case Product():
            return (kernels.PRODUCT, float(len(one.of)), *map(float, one.of))
        case Inverse():
            return (kernels.INVERSE, 1.0, float(one.of[0]))
    return (kernels.INTEGRAL, 1.0, float(one.of[0]))


class _Writer:
    """Instructions of a scene, written one after the other.

    Parameters
    ----------
    scene
        A resolved scene.
    assets
        Bitmaps of its images and cells of its labels.

    Raises
    ------
    ValueError
        If its elements cannot be put together by its operation.
    """

    def __init__(self, scene: Scene, assets: Assets) -> None:
        if scene.operation in ("weighted", "blend"):
            raise ValueError(
                f'operation = "{scene.operation}" is for groups; put the elements into one'
            )
        self._scene, self._assets = scene, assets
        self._numbers: list[float] = []
        self._table = [np.zeros(4, np.uint16)]
        self._words = 4  # entries of the table
        self._depth = 0
        order = ordered(scene.signals, driving(*scene.elements)) if scene.signals else []
        self._signals = {
            one.name if one.signal is not None else f"∫{one.name}": number
            for number, one in enumerate(order)
        }
        boxes: dict[Image | Label, Box | None] = {}
        boxes |= {label: box_of(label, written) for label, written in assets.written.items()}
        boxes |= {image: bitmap_box(bitmap) for image, bitmap in assets.bitmaps.items()}
        self._boxes = {pattern: box for pattern, box in boxes.items() if box is not None}

    def scene(self) -> None:
        """Write the deflections of the scene."""
        self._group(self._scene.operation, self._scene.elements)

    def hiding(self) -> None:
        """Write the opacity mask of the scene; that of its element if it has one only."""
        elements = self._scene.elements
        if not elements:
            self._say(i.LEVEL, 0.0)
        elif len(elements) == 1:
            self._mask(elements[0])
        else:
            self._mask(Group(operation=self._scene.operation, parts=elements))

    def finish(
        self, numbers: NDArray[np.float64]
    ) -> tuple[NDArray[np.float64], NDArray[np.uint16]]:
        """Numbers and table of a program; the head is given.

        Raises
        ------
        ValueError
            If a number is not finite.
        """
        canvas: Canvas = self._scene.canvas
        self._say(i.END)
        numbers[i.RIGHT_MM], numbers[i.BOTTOM_MM] = canvas.width_mm, canvas.height_mm
        numbers[i.SIGNALS : i.CODE] = signal_numbers(self._scene)
        code = np.array(self._numbers)
        if not np.isfinite(code).all():
            raise ValueError("a number of a pattern is not finite")
        return np.concatenate([numbers, code]), np.concatenate(self._table)

    # Single instructions

    def _say(self, operation: int, *constants: float) -> None:
        self._numbers += (operation, 2 + len(constants), *constants)
        self._depth += _PUSHES.get(operation, 0)
        if self._depth > i.DEPTH:
            raise ValueError("patterns stand too deep in each other; take some groups apart")

    def _say_table(self, operation: int, *constants: float, at: int, entries: NDArray) -> None:
        """Write an instruction on entries of the table, whose place is the constant ``at``."""
        said = list(constants)
        said[at] = self._words
        self._table.append(np.ascontiguousarray(entries.ravel(), np.uint16))
        self._words += entries.size
        self._say(operation, *said)

    def _gated(self, box: Box | None, shut_by: int, pushes: int, say: Callable[[], None]) -> None:
        """Write instructions that are skipped beyond a box, or where signals shut them.

        A gate has a bit for each signal that shuts it where it is 0, and then one for each that
        does where it is 1. So many zeros are pushed instead.
        """
        if box is None and not shut_by:
            say()
            return
        within = [min(max(side, -_FAR), _FAR) for side in box or (-_FAR, -_FAR, _FAR, _FAR)]
        self._say(i.GATE, *within, shut_by, 0.0, pushes)
        begin = len(self._numbers)
        say()
        self._numbers[begin - 2] = len(self._numbers) - begin

    def _number(self, name: str) -> float:
        return float(self._signals[name])

    def _clock(self, velocity_by: str) -> float:
        """Number of the signal whose integral is the time of a motion; below 0 for time itself."""
        return self._number(f"∫{velocity_by}") if velocity_by else -1.0

    def _shut_by(self, pattern: Pattern) -> int:
        return 1 << self._signals[pattern.factor] if pattern.factor else 0

    def _factor(self, pattern: Pattern) -> None:
        if pattern.factor:
            self._say(i.BY_SIGNAL, self._number(pattern.factor))

    # Groups

    def _group(
        self,
        operation: str,
        parts: Sequence[AnyPattern],
        weights: Sequence[float] | None = None,
        by: AnyPattern | None = None,
    ) -> None:
        """Write the deflection of parts that are put together."""
        if by is not None:
            self._blend(parts, by, self._deflection)
        elif operation == "multiply":
            self._say(i.LEVEL, 1.0)
            for part in parts:
                self._whole(part)
                self._say(i.MULTIPLY)
        elif operation == "overwrite":
            covering = [n for n, part in enumerate(parts) if self._covers_alone(part)]
            first = covering[-1] if covering else -1
            if covering:  # it hides all that is beneath it
                self._whole(parts[first])
            else:
                self._say(i.LEVEL, 0.0)
            for part in parts[first + 1 :]:

                def lay(part: AnyPattern = part) -> None:
                    self._layer(part)

                self._gated(self._box(part), self._shut_by(part), 0, lay)
        else:
            self._say(i.LEVEL, 0.0)
            for number, part in enumerate(parts):
                weight = 1.0 if weights is None else weights[number]

                def say(part: AnyPattern = part, weight: float = weight) -> None:
                    self._deflection(part)
                    if weight != 1.0:
                        self._say(i.SCALE, weight)
                    self._say(_JOINS[operation])

                self._gated(self._box(part), self._shut_by(part), 0, say)

    def _box(self, pattern: AnyPattern) -> Box | None:
        return bounds(pattern, self._boxes)

    def _whole(self, pattern: AnyPattern) -> None:
        """Write a deflection, of which nothing is computed where it is 0."""
        box, shut_by = self._box(pattern), self._shut_by(pattern)
        self._gated(box, shut_by, 1, lambda: self._deflection(pattern))

    def _blend(
        self, parts: Sequence[AnyPattern], by: AnyPattern, say: Callable[[AnyPattern], None]
    ) -> None:
        """Write a blend; a part is skipped while a signal chooses the other alone."""
        bit = 0
        if isinstance(by, SignalLevel) and _is_plain(by) and not by.factor:
            bit = 1 << self._signals[by.name]
        first, second = parts
        self._gated(None, bit << MOST_SIGNALS, 1, lambda: say(first))
        self._gated(None, bit, 1, lambda: say(second))
        self._deflection(by)
        self._say(i.BLEND)

    def _layer(self, pattern: AnyPattern) -> None:
        """Lay a pattern over what is beneath it: Lévesque 2009, eq. 8.22."""
        self._deflection(pattern)
        if _is_own_mask(pattern):
            self._say(i.OVER_ITSELF)
        else:
            self._mask(pattern, paired=isinstance(pattern, paths.AnyShape))
            self._say(i.OVER)

    # Deflections

    def _deflection(self, pattern: AnyPattern) -> None:
        """Write a pattern with its changes: amplitude, inversion, vibration, factor."""
        self._plain(pattern)
        if pattern.amplitude != 1.0:
            self._say(i.SCALE, pattern.amplitude)
        if pattern.inverted:
            self._say(i.INVERT)
        swing = pattern.vibration
        if swing is not None:
            operation = i.VIBRATE_HIGH if swing.of == "high" else i.VIBRATE_LOW
            self._say(operation, swing.frequency_hz, swing.amplitude)
        self._factor(pattern)

    def _plain(self, pattern: AnyPattern) -> None:
        """Write a pattern without its changes.

        Raises
        ------
        TypeError
            If it is none that is rendered.
        """
        match pattern:
            case Uniform():
                self._say(i.LEVEL, pattern.level)
            case SignalLevel():
                self._say(i.SIGNAL, self._number(pattern.name))
            case UniformVibration():
                self._say(i.VIBRATION, pattern.frequency_hz)
            case LinearGrating():
                angle = math.radians(pattern.travel_deg)
                right, down = math.cos(angle), math.sin(angle)
                start = pattern.start_mm[0] * right + pattern.start_mm[1] * down
                cycle = Cycle(pattern.ridge_mm, pattern.gap_mm)
                waveform = self._waveform(cycle, pattern, pattern.velocity_mm_s)
                self._say(i.LINEAR, right, down, start, *waveform)
            case RadialGrating():
                cycle = Cycle(pattern.ridge_mm, pattern.gap_mm)
                waveform = self._waveform(cycle, pattern, pattern.velocity_mm_s)
                self._say(i.RADIAL, *pattern.center_mm, *waveform)
            case AxialGrating():
                self._axial(pattern)
            case Image():
                self._bitmap(self._assets.bitmaps[pattern])
                if pattern.texture is not None:
                    self._whole(pattern.texture)
                    self._say(i.MULTIPLY)
            case Label():
                self._label(i.LABEL, pattern)
            case Dots():
                self._dots(pattern.dot, pattern.dot.across, _placed(pattern))
            case Tile():
                size = pattern.width_mm, pattern.height_mm
                self._say(i.WRAP, *pattern.origin_mm, *size)
                self._whole(pattern.part)
                self._say(i.RESTORE)
            case Moving():
                center = pattern.array_at_mm or (_FAR, _FAR)
                clock = self._clock(pattern.velocity_by)
                self._say(i.SHIFT, *pattern.velocity_mm_s, clock, *center)
                self._whole(pattern.part)
                self._say(i.RESTORE)
            case Group():
                self._group(pattern.operation, pattern.parts, pattern.weights, pattern.by)
            case StraightLine() | Circle() | Polygon() | PathShape():
                self._shape(pattern)
            case _:
                raise TypeError(
                    f"a {type(pattern).__name__} is not rendered; resolve the scene first"
                )

    def _waveform(self, cycle: Cycle, grating: _AnyGrating, velocity: float) -> tuple[float, ...]:
        own = (cycle.length, cycle.ridge, velocity, self._clock(grating.velocity_by))
        change = grating.distortion
        if change is None:
            return (*own, 0.0)
        if isinstance(change, Gradual):
            return (*own, change.factor - 1.0, change.start_mm, change.length_mm, 0.0)
        if isinstance(change, TurnPeak):
            center, length = change.center_deg, change.length_deg
        else:
            center, length = change.center_mm, change.length_mm
        return (*own, change.factor - 1.0, center - length, length, 1.0)

    def _axial(self, grating: AxialGrating) -> None:
        cycle = axial_cycle(grating)
        factor = 1.0 if grating.distortion is None else max(1.0, grating.distortion.factor)
        inner_mm, outer_mm = grating.fade_mm
        radius = factor / math.radians(cycle.length)
        fade = (grating.middle, inner_mm * radius, 1.0 / ((outer_mm - inner_mm) * radius))
        waveform = self._waveform(cycle, grating, grating.velocity_deg_s)
        self._say(i.AXIAL, *grating.center_mm, grating.start_deg, *fade, *waveform)

    def _bitmap(self, bitmap: Bitmap) -> None:
        rows, columns = bitmap.intensities.shape
        outside = round(bitmap.outside * WHOLE)
        framed = np.pad(bitmap.intensities, 1, constant_values=outside)
        per_mm = columns / bitmap.width_mm, rows / bitmap.height_mm
        x, y = bitmap.place_mm
        # The middle of the frame's first pixel is half a pixel beyond the corner.
        first = x - 0.5 / per_mm[0], y - 0.5 / per_mm[1]
        operation = i.PIXELS if bitmap.nearest else i.IMAGE
        size = columns + 2, rows + 2
        self._say_table(operation, *first, *per_mm, *size, 0.0, at=6, entries=framed)

    def _label(self, operation: int, label: Label) -> None:
        packed = pack_label(label, self._assets.written[label])
        self._say_table(operation, *packed.numbers.tolist(), at=TABLE, entries=packed.table)

    def _dots(
        self,
        style: DotStyle,
        across: Across | None,
        numbers: Sequence[float],
        *,
        is_mask: bool = False,
        vertices: Vibration | None = None,
        motion: tuple[float, float, float] = (0.0, 0.0, -1.0),
    ) -> None:
        profile = _profile(2 * style.radius_mm, style.edge, across, is_mask=is_mask)
        own = (-1.0, -1.0) if vertices is None else (vertices.frequency_hz, vertices.amplitude)
        swings = (*_swing(style.vibration), *own)
        self._say(i.DOTS, *profile, style.amplitude, *motion, *swings, *numbers)

    def _dotted(self, shape: paths.AnyShape, across: Across | None, *, is_mask: bool) -> None:
        """Write the dots along a shape, or their opacity mask."""
        dots = shape.dots
        assert dots is not None
        self._dots(
            dots.dot,
            across,
            paths.dotted_numbers(shape),
            is_mask=is_mask,
            vertices=dots.vertex_vibration,
            motion=(
                float(bool(dots.velocity_mm_s)),
                dots.velocity_mm_s,
                self._clock(dots.velocity_by),
            ),
        )

    # Shapes

    def _shape(self, shape: paths.AnyShape) -> None:
        """Write a shape: its fill, the stroke or dots that it is drawn with, and its cue.

        The coordinates of its path are left for its mask.
        """
        fill, cue = _fill_of(shape), shape.cue
        if fill is not None:
            self._whole(fill.texture)
        self._coordinates(shape, along=True)
        if shape.stroke is not None:
            self._stroke(shape, shape.stroke)
        elif shape.dots is not None:
            self._dotted(shape, shape.dots.dot.across, is_mask=False)
        else:
            self._say(i.LEVEL, 0.0)
        if fill is not None and fill.blended:
            self._outline(shape, None)
            self._say(i.FILL_BLENDED)
        elif fill is not None:
            slope = min(1.0 / fill.fade_mm, _SHARPEST) if fill.fade_mm else _SHARPEST
            self._say(i.FILL, drawn_radius_mm(shape) + fill.gap_mm, slope)
        if cue is not None and shape.is_cued_over:
            self._cue(shape, cue)

    def _coordinates(self, shape: paths.AnyShape, *, along: bool) -> None:
        """Write the coordinates of a shape's path, as far as they are needed."""
        fill, stroke = _fill_of(shape), shape.stroke
        if fill is None and stroke is None and not shape.is_cued_over:
            return
        marked = isinstance(shape, Polygon) and shape.markers is not None
        textured = stroke is not None and (stroke.along is not None or marked)
        along = along and (textured or shape.cue is not None)
        if isinstance(shape, Circle):
            self._say(i.CIRCLE, *shape.center_mm, shape.radius_mm, float(along))
            return
        reach = max(reach_mm(shape), drawn_radius_mm(shape))
        if fill is not None and not fill.blended:
            reach = max(reach, drawn_radius_mm(shape) + fill.gap_mm + fill.fade_mm)
        clock = -1.0
        if stroke is not None and stroke.along is not None:
            clock = self._clock(stroke.along.velocity_by)
        size = i.ACROSS if not along else i.ROUNDED if _is_rounded(shape) else i.ALONG
        chunks = paths.path_chunks(shape, size)
        self._say(i.PATH, size, float(fill is not None), reach, clock, *chunks)

    def _outline(self, shape: paths.AnyShape, across: Across | None) -> None:
        """Write the profile of what a shape is drawn with."""
        if shape.stroke is not None:
            stroke = shape.stroke
            self._say(i.PROFILE, *_profile(stroke.width_mm, stroke.edge, across, is_mask=True))
        elif shape.dots is not None:
            self._dotted(shape, across, is_mask=True)
        else:
            self._say(i.LEVEL, 0.0)

    def _stroke(self, shape: paths.AnyShape, stroke: Stroke) -> None:
        """Write a stroke: its profile times what its textures leave, eqs. 8.7-8.14."""
        profile = _profile(stroke.width_mm, stroke.edge, stroke.across)
        self._say(i.PROFILE, *profile)
        if stroke.amplitude != 1.0:
            self._say(i.SCALE, stroke.amplitude)
        markers = shape.markers if isinstance(shape, Polygon) else None
        cue = None if shape.is_cued_over else shape.cue
        swing, along = stroke.vibration, stroke.along
        if not (along or stroke.outlined or swing or markers or cue):
            return
        if along is not None:
            cycle, velocity = stroke_cycles(shape)[0], along.velocity_mm_s
            if paths.cycles_differ(shape):  # the places along it are in ridges already
                cycle, velocity = Cycle(1.0, 1.0), 0.0
            clock = self._clock(along.velocity_by)
            numbers = (cycle.length, cycle.ridge, along.amplitude, velocity, clock)
            self._say(i.BANDS, i.ALONG_ROW, *numbers)
            if along.whole_edges:
                self._say(i.GROOVE, *profile)
        else:
            self._say(i.LEVEL, float(stroke.outlined))
            if stroke.outlined:
                self._say(i.GROOVE, *profile)
        if swing is not None and swing.of == "low":
            self._say(i.VIBRATE_HIGH, swing.frequency_hz, swing.amplitude)
        self._say(i.INVERT)
        if swing is not None and swing.of == "high":
            self._say(i.VIBRATE_HIGH, swing.frequency_hz, swing.amplitude)
        if markers is not None and isinstance(shape, Polygon):
            numbers = (stroke.width_mm / 2, 1.0 / markers.blend_mm, *_swing(markers.swing))
            self._say(i.MARKERS, *numbers, *paths.marker_numbers(shape))
        if cue is not None:
            self._cue(shape, cue)
        self._say(i.MULTIPLY)

    def _cue(self, shape: paths.AnyShape, cue: MovingCue) -> None:
        """Lay the bands of a cue over what is uppermost: 9.3 and 9.3.2."""
        if cue.way == "add":
            self._say(i.SCALE, 1.0 - cue.share)
        cycle, row = cue_cycle(shape), i.PLACE_ROW if _is_rounded(shape) else i.ALONG_ROW
        clock = self._clock(cue.velocity_by)
        self._say(i.BANDS, row, cycle.length, cycle.ridge, 1.0, cue.velocity_mm_s, clock)
        if shape.is_cued_over:
            self._say(i.PROFILE, *_profile(shape.cue_width_mm, shape.cue_edge_mm, None))
            self._say(i.MULTIPLY)
            # Bands that are not wider than a row of dots end as the row does.
            _, closed = shape.outline
            if not closed and shape.cue_width_mm > shape.width_mm:
                self._say(i.BEYOND, 2.0 / shape.width_mm)
                self._say(i.MULTIPLY)
        shows, hides = {
            "vibrate": (1.0, 1.0),
            "blend": (cue.level, 1.0),
            "mask": (0.0, 2.0),
            "add": (cue.share, 0.0),
        }[cue.way]
        self._say(i.CUE, shows, hides, *_swing(cue.swing))
        self._say(i.OVER)

    # Opacity masks

    def _covers(self, pattern: AnyPattern) -> bool:
        """Tell whether a pattern's mask is 1 everywhere, but for its factor."""
        if is_everywhere(pattern):
            return True
        if isinstance(pattern, Group):
            covers = [self._covers_alone(part) for part in pattern.parts]
            return (all if pattern.operation in ("multiply", "blend") else any)(covers)
        return not isinstance(pattern, Image | Label | Dots | paths.AnyShape)

    def _covers_alone(self, pattern: AnyPattern) -> bool:
        return not pattern.factor and self._covers(pattern)

    def _mask(self, pattern: AnyPattern, *, paired: bool = False) -> None:
        """Write the opacity mask of a pattern: Lévesque 2009, 8.4.5.

        Paired with its deflection, it takes the coordinates of a shape's path from there.
        """
        if self._covers(pattern):
            self._say(i.LEVEL, 1.0)
        else:
            match pattern:
                case Image():
                    self._bitmap(opaque(self._assets.bitmaps[pattern]))
                case Label():
                    self._label(i.LABEL_MASK, pattern)
                case Dots():
                    self._dots(pattern.dot, pattern.dot.across, _placed(pattern), is_mask=True)
                case Group():
                    self._group_mask(pattern)
                case StraightLine() | Circle() | Polygon() | PathShape():
                    self._shape_mask(pattern, paired)
                case _:
                    self._say(i.LEVEL, 1.0)
        self._factor(pattern)

    def _group_mask(self, group: Group) -> None:
        """Write the mask of a group: by its own operation, but that of layers is 1 - Π(1 - μ)."""
        if group.by is not None:
            self._blend(group.parts, group.by, self._mask)
            return
        if group.operation == "multiply":
            self._say(i.LEVEL, 1.0)
            for part in group.parts:
                self._mask(part)
                self._say(i.MULTIPLY)
            return
        self._say(i.LEVEL, 0.0)
        for part in group.parts:

            def say(part: AnyPattern = part) -> None:
                self._mask(part)
                self._say(_JOINS[group.operation])

            self._gated(self._box(part), self._shut_by(part), 0, say)

    def _shape_mask(self, shape: paths.AnyShape, paired: bool) -> None:
        if not paired:
            self._coordinates(shape, along=False)
        across: Any = None
        if shape.stroke is not None:
            across = shape.stroke.across
        elif shape.dots is not None:
            across = shape.dots.dot.across
        self._outline(shape, across)
        if _fill_of(shape) is not None:
            self._say(i.FILL_MASK)
        if shape.is_cued_over:
            self._say(i.PROFILE, *_profile(shape.cue_width_mm, shape.cue_edge_mm, None))
            self._say(i.OVER_ITSELF)


def _fill_of(shape: paths.AnyShape) -> Fill | None:
    return None if isinstance(shape, StraightLine) else shape.fill


def _is_rounded(shape: paths.AnyShape) -> bool:
    """Tell whether places along a shape follow round corners, or lie in ridges of its own."""
    return (isinstance(shape, Polygon) and shape.join == "rounded") or paths.cycles_differ(shape)


def _is_plain(pattern: Pattern) -> bool:
    return pattern.amplitude == 1.0 and not pattern.inverted and pattern.vibration is None


def _is_own_mask(pattern: AnyPattern) -> bool:
    """Tell whether a pattern's deflection is its mask, too."""
    if not _is_plain(pattern) or pattern.factor:
        return False
    if isinstance(pattern, Dots):
        return _is_plain_dot(pattern.dot)
    if not isinstance(pattern, paths.AnyShape) or _fill_of(pattern) or pattern.cue:
        return False
    if pattern.dots is not None:
        return pattern.dots.vertex_vibration is None and _is_plain_dot(pattern.dots.dot)
    stroke = pattern.stroke
    marked = isinstance(pattern, Polygon) and pattern.markers is not None
    if stroke is None or marked or stroke.amplitude != 1.0 or stroke.outlined:
        return False
    return stroke.across is None and stroke.along is None and stroke.vibration is None


def _is_plain_dot(style: DotStyle) -> bool:
    return style.amplitude == 1.0 and style.across is None and style.vibration is None


def _placed(dots: Dots) -> list[float]:
    return paths.dot_chunks([PlacedDot(x, y) for x, y in dots.centers_mm])


def _profile(
    width: float, edge: float, across: Across | None, *, is_mask: bool = False
) -> tuple[float, ...]:
    half = width / 2
    weight, cycles = (0.0, 0) if across is None else (across.amplitude, across.cycles)
    return (half - edge, 1.0 / edge, half, weight, cycles / width, float(is_mask))


def _swing(vibration: Vibration | None) -> tuple[float, float]:
    return (0.0, 0.0) if vibration is None else (vibration.frequency_hz, vibration.amplitude)


class SceneMap:
    """A scene as a whole, for pictures of it.

    Parameters
    ----------
    scene
        A resolved scene: without `Use` and `ImageDots`.
    assets
        Bitmaps of its images and cells of its labels.

    Raises
    ------
    ValueError
        If patterns stand too deep in each other.
    """

    def __init__(self, scene: Scene, assets: Assets | None = None) -> None:
        self._scene, self._assets = scene, assets or Assets()
        self._compiled: dict[bool, tuple[NDArray[np.float64], NDArray[np.uint16]]] = {}

    def deflections(
        self,
        x_mm: NDArray[np.float64],
        y_mm: NDArray[np.float64],
        *,
        time_s: float = 0.0,
        parity: int = 0,
        noise_seed: int | None = None,
        velocity_mm_s: Point = (0.0, 0.0),
        switches: int = 0,
    ) -> NDArray[np.float32]:
        """Compute the deflections of actuators at the places of a raster: Lévesque 2009, 8.3.3.

        Parameters
        ----------
        x_mm, y_mm : float64[w], float64[h]
            Places of its columns and lines on the canvas.
        time_s
            Time since the scene was first shown, in seconds.
        parity
            0 for actuators whose column and row are both even or both odd, 1 for the others.
        noise_seed
            Seed of the noise that stands for vibrations; None shows them as they are at the time.
            Gratings that travel stand where they do at first then.
        velocity_mm_s, switches
            Velocity of the hand for as long as signals remember, and states of the switches, as
            `vbraille.scene.signals.packed` has them.

        Returns
        -------
        float32[h, w]
            Deflections, 0 … 1; 0 beyond the canvas.
        """
        given = self.signal_values(time_s, velocity_mm_s, switches)
        return self._raster(False, x_mm, y_mm, time_s, parity, noise_seed, given)

    def opacity(
        self,
        x_mm: NDArray[np.float64],
        y_mm: NDArray[np.float64],
        *,
        time_s: float = 0.0,
        parity: int = 0,
        noise_seed: int | None = None,
        velocity_mm_s: Point = (0.0, 0.0),
        switches: int = 0,
        every_layer: bool = False,
    ) -> NDArray[np.float32]:
        """Compute the opacity mask of the scene at the places of a raster: Lévesque 2009, 8.4.5.

        The arguments are those of `deflections`, and whether all signals are 1, so that every layer
        is there; only the mask of a blend that is chosen by what moves depends on the time. A scene
        of one element has the mask of that.

        Returns
        -------
        float32[h, w]
            Opacity, 0 … 1; 0 beyond the canvas.
        """
        given = self.signal_values(time_s, velocity_mm_s, switches)
        if every_layer:
            given[:MOST_SIGNALS] = 1.0
        return self._raster(True, x_mm, y_mm, time_s, parity, noise_seed, given)

    def signal_values(
        self, time_s: float, velocity_mm_s: Point, switches: int
    ) -> NDArray[np.float64]:
        """Compute the signals, in their order; then NaN, as no array has a centre: float64[10]."""
        at = np.zeros(work.AT)
        if self._scene.signals:
            at[work.TIME], at[work.SWITCHES] = time_s, switches
            at[work.VX], at[work.VY] = velocity_mm_s
            numbers = np.zeros(i.CODE)
            numbers[i.SIGNALS :] = signal_numbers(self._scene)
            kernels.begin(numbers, at)
            kernels.compute(numbers, at, 0.0)
        return np.append(at[work.SIGNAL : work.MEMORY], (math.nan, math.nan))

    def _raster(
        self,
        hiding: bool,
        x_mm: NDArray[np.float64],
        y_mm: NDArray[np.float64],
        time_s: float,
        parity: int,
        noise_seed: int | None,
        given: NDArray[np.float64],
    ) -> NDArray[np.float32]:
        from vbraille.render import evaluating

        if hiding not in self._compiled:
            writer = _Writer(self._scene, self._assets)
            (writer.hiding if hiding else writer.scene)()
            self._compiled[hiding] = writer.finish(np.zeros(i.CODE))
        x_mm, y_mm = np.ascontiguousarray(x_mm, np.float64), np.ascontiguousarray(y_mm, np.float64)
        out = np.empty((y_mm.size, x_mm.size), np.float32)
        noise = np.empty((0, 0), np.float32)
        if noise_seed is not None:
            noise = np.random.default_rng(noise_seed).random(out.shape, np.float32) * 2 - 1
        rows = np.zeros((i.SCRATCH_ROWS, evaluating.TILE_COLUMNS * evaluating.TILE_LINES))
        rows[i.GIVEN_ROW, : given.size] = given
        time = math.nan if noise_seed is not None else time_s
        sign = -1.0 if parity else 1.0
        evaluating.raster(*self._compiled[hiding], rows, x_mm, y_mm, sign, noise, time, out)
        return out
