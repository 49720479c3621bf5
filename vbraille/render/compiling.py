"""Scenes, compiled for a display, or for rasters of the whole canvas.

A scene becomes one list of instructions. Each part of it stands behind a box and a gate, by which
it is skipped where nothing of it can be felt.
"""

from __future__ import annotations

import itertools
import math
from contextlib import contextmanager
from typing import TYPE_CHECKING

import msgspec
import numpy as np

from vbraille.render import evaluating as i
from vbraille.render import paths, work
from vbraille.render import signalkernels as kernels
from vbraille.render.braille.mappings import DOT_BITS
from vbraille.render.braille.style import pack_cells
from vbraille.render.labels import Assets
from vbraille.render.program import Program, head
from vbraille.render.work import MOST_SIGNALS, ProgramKind
from vbraille.scene.bitmap import WHOLE, opaque
from vbraille.scene.geometry import (
    Box,
    Cycle,
    PlacedDot,
    around,
    axial_cycle,
    bounds,
    cue_cycle,
    drawn_radius_mm,
    is_everywhere,
    reach_mm,
    rows_of,
    stroke_cycles,
)
from vbraille.scene.patterns import (
    AxialGrating,
    Circle,
    Dots,
    Gradual,
    Group,
    Image,
    Label,
    LinearGrating,
    Moving,
    PathShape,
    Polygon,
    RadialGrating,
    SignalLevel,
    StraightLine,
    Tile,
    TurnPeak,
    Uniform,
    UniformVibration,
)
from vbraille.scene.signals import Direction, Inverse, Product, Pulse, Speed, Switch, ordered
from vbraille.scene.traversal import drawn_vibrations, driving, each, waves_of

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from numpy.typing import NDArray

    from vbraille.display import Display
    from vbraille.scene.bitmap import Bitmap
    from vbraille.scene.measures import Point
    from vbraille.scene.patterns import Across, AnyPattern, DotStyle, MovingCue, Stroke, Vibration
    from vbraille.scene.scene import Scene
    from vbraille.scene.signals import OrderedSignal

_FAR = 1e30  # stands for infinity
_LEAST_FADE_MM = 1e-9  # of a fill
_CHUNK = 8  # segments or dots that share a box
_BLOCK = 24  # lines and columns of a raster that are computed together
_JOINS = {
    "add": i.ADD,
    "weighted": i.ADD,
    "maximum": i.MAXIMUM,
    "multiply": i.MULTIPLY,
    "overwrite": i.OVER_ITSELF,
}


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
    numbers[work.FREQUENCY] = max(moves_hz, default=0.0)
    numbers[work.AMPLITUDE] = numbers[work.FREQUENCY] > 0.0
    return Program(*_written(scene, assets, numbers, is_mask=False))


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
    yield from (wave.flow_hz for _, wave in waves_of(pattern) if wave.speed)
    if isinstance(pattern, Moving) and any(pattern.velocity_mm_s):
        yield 1.0  # it moves at any length of its waves


def _in_order(scene: Scene) -> list[OrderedSignal]:
    """Signals of a scene in their order, with the integrals of those that are a motion's speed.

    Raises
    ------
    ValueError
        If there are more than 8.
    """
    order = ordered(scene.signals, driving(*scene.elements)) if scene.signals else []
    if len(order) > MOST_SIGNALS:
        raise ValueError(
            f"there are {len(order)} signals, where each that is the speed of a motion counts "
            f"twice; there can be {MOST_SIGNALS}"
        )
    return order


def _write_signals(scene: Scene, numbers: NDArray[np.float64]) -> None:
    """Fill in the numbers of a scene's signals."""
    order = _in_order(scene)
    numbers[work.SIGNALS] = len(order)
    rows = numbers[work.SIGNAL_ROWS : work.CODE].reshape(MOST_SIGNALS, work.SIGNAL_NUMBERS)
    for row, one in zip(rows, order, strict=False):
        own = _signal(one)
        row[: len(own)] = own


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
            at_rest = kernels.AT_REST.index(way.at_rest)
            return (kernels.DIRECTION, *slow, angle, *away, way.axis, at_rest)
        case Switch() as switch:
            return (kernels.SWITCH, switch.fade_s, len(switch.levels), *switch.levels)
        case Pulse() as clock:
            return (kernels.CLOCK, kernels.SHAPES.index(clock.shape), clock.period_s)
        case Product() | Inverse():
            factor = (1.0, 0.0) if isinstance(one.signal, Product) else (-1.0, 1.0)
            return (kernels.PRODUCT, *factor, len(one.of), *one.of)
    return (kernels.INTEGRAL, *one.of)


def _written(
    scene: Scene, assets: Assets | None, numbers: NDArray[np.float64], *, is_mask: bool
) -> tuple[NDArray[np.float64], NDArray[np.uint16]]:
    """Numbers and table of a scene's program, or of that for its opacity mask; the head is given.

    A scene of one element has the mask of that.

    Raises
    ------
    ValueError
        If its elements cannot be put together by its operation, patterns stand too deep in each
        other, or a number is not finite.
    """
    writer = _Writer(scene, assets or Assets())
    if not scene.elements:
        writer.say(i.LEVEL, 0.0)
    elif is_mask and len(scene.elements) == 1:
        writer.pattern(scene.elements[0], is_mask)
    else:
        writer.pattern(Group(operation=scene.operation, parts=scene.elements), is_mask)
    writer.say(i.END)
    code = np.array(writer.numbers)
    if not np.isfinite(code).all():
        raise ValueError("a number of a pattern is not finite")
    numbers[work.RIGHT_MM] = scene.canvas.width_mm
    numbers[work.BOTTOM_MM] = scene.canvas.height_mm
    numbers[work.INSTRUCTIONS] = writer.count
    _write_signals(scene, numbers)
    return np.concatenate([numbers, code]), np.concatenate(writer.table)


class _Writer:
    """Instructions of a scene, written one after the other.

    Parameters
    ----------
    scene
        A resolved scene.
    assets
        Bitmaps of its images and cells of its labels.
    """

    def __init__(self, scene: Scene, assets: Assets) -> None:
        self.numbers: list[float] = []
        self.table = [np.zeros(4, np.uint16)]
        self.count = 0
        self._words = 4  # entries of the table
        self._depth = 0
        self._assets = assets
        self._boxes = assets.boxes()
        self._measured: AnyPattern | None = None  # the shape whose coordinates are known
        self._signals = {
            one.name if one.signal is not None else f"∫{one.name}": number
            for number, one in enumerate(_in_order(scene))
        }

    # Single instructions

    def say(self, operation: int, *constants: float) -> None:
        """Write an instruction."""
        added = i.ADDED.get(operation, 0)
        self.numbers += (operation, i.HEAD + len(constants), added, *constants)
        self.count += 1
        self._depth += added
        if self._depth > work.DEPTH:
            raise ValueError("patterns stand too deep in each other; take some groups apart")

    def _entries(self, entries: NDArray) -> float:
        """Add entries to the table, and tell where they begin."""
        begin = self._words
        self.table.append(np.ascontiguousarray(entries.ravel(), np.uint16))
        self._words += entries.size
        return float(begin)

    @contextmanager
    def _gate(self, box: Box | None, shut_by: int = 0) -> Iterator[None]:
        """Have the instructions within be skipped beyond a box, or where signals shut them.

        A gate has a bit for each signal that shuts it where it is 0, and then one for each that
        does where it is 1.
        """
        if box is None and not shut_by:
            yield
            return
        within = np.clip(box or (-_FAR, -_FAR, _FAR, _FAR), -_FAR, _FAR)
        self.say(i.GATE, *within, shut_by, 0.0)
        begin = len(self.numbers)
        before = self._measured
        yield
        self.numbers[begin - 1] = work.CODE + len(self.numbers)  # where to go on then
        if self._measured is not before:  # the coordinates may have been skipped
            self._measured = None

    def _shut_by(self, pattern: AnyPattern) -> int:
        return 1 << self._signals[pattern.factor] if pattern.factor else 0

    def _clock(self, velocity_by: str) -> float:
        """Number of the signal whose integral is the time of a motion; below 0 for time itself."""
        return float(self._signals[f"∫{velocity_by}"]) if velocity_by else -1.0

    def _scale(self, factor: float) -> None:
        if factor != 1.0:
            self.say(i.LEVEL, factor)
            self.say(i.MULTIPLY)

    # Patterns

    def pattern(self, pattern: AnyPattern, is_mask: bool = False) -> None:
        """Write a pattern with its changes, or its opacity mask: Lévesque 2009, 8.4.5."""
        if is_mask and is_everywhere(pattern):
            self.say(i.LEVEL, 1.0)
        else:
            self._plain(pattern, is_mask)
        if not is_mask:
            self._scale(pattern.amplitude)
            if pattern.inverted:
                self.say(i.INVERT)
            self._vibrate(pattern.vibration)
        if pattern.factor:
            self.say(i.SIGNAL_VALUE, self._signals[pattern.factor])
            self.say(i.MULTIPLY)

    def _vibrate(self, vibration: Vibration | None) -> None:
        """Have what is up vibrate, or what is down: 1 - (1 - δ) δ¹."""
        if vibration is not None:
            is_low = vibration.of == "low"
            if is_low:
                self.say(i.INVERT)
            self.say(i.VIBRATE, vibration.frequency_hz, vibration.amplitude)
            if is_low:
                self.say(i.INVERT)

    def _whole(self, pattern: AnyPattern, is_mask: bool = False, shut_by: int = 0) -> None:
        """Write a pattern, of which nothing is computed where it is 0 or signals shut it."""
        box, own = bounds(pattern, self._boxes), self._shut_by(pattern)
        if box is None and not own | shut_by:
            self.pattern(pattern, is_mask)
            return
        self.say(i.LEVEL, 0.0)
        with self._gate(box, own | shut_by):
            self.pattern(pattern, is_mask)
            self.say(i.ADD)

    def _plain(self, pattern: AnyPattern, is_mask: bool) -> None:
        """Write a pattern without its changes, or its mask.

        Raises
        ------
        TypeError
            If it is none that is rendered.
        """
        match pattern:
            case Group():
                self._group(pattern, is_mask)
            case StraightLine() | Circle() | Polygon() | PathShape():
                self._shape(pattern, is_mask)
            case Dots():
                dots = [PlacedDot(x, y) for x, y in pattern.centers_mm]
                self._dots(pattern.dot, pattern.dot.across, dots, is_mask)
            case Label():
                written = self._assets.written[pattern]
                place = (*pattern.place_mm, math.radians(pattern.angle_deg))
                cells, words = pack_cells(written.lines, written.style, DOT_BITS, place)
                if not is_mask:
                    cells[work.TABLE] = self._entries(words)
                self.say(i.LABEL_MASK if is_mask else i.LABEL, *cells)
            case Image():
                bitmap = self._assets.bitmaps[pattern]
                self._bitmap(opaque(bitmap) if is_mask else bitmap)
                if pattern.texture is not None and not is_mask:
                    self._whole(pattern.texture)
                    self.say(i.MULTIPLY)
            case _ if is_mask:
                self.say(i.LEVEL, 1.0)
            case Uniform():
                self.say(i.LEVEL, pattern.level)
            case SignalLevel():
                self.say(i.SIGNAL_VALUE, self._signals[pattern.name])
            case UniformVibration():
                self.say(i.LEVEL, 1.0)
                self.say(i.VIBRATE, pattern.frequency_hz, 1.0)
            case LinearGrating():
                angle = math.radians(pattern.travel_deg)
                right, down = math.cos(angle), math.sin(angle)
                start = pattern.start_mm[0] * right + pattern.start_mm[1] * down
                self.say(i.LINEAR, *self._waveform(pattern), right, down, start)
            case RadialGrating():
                self.say(i.RADIAL, *self._waveform(pattern), *pattern.center_mm)
            case AxialGrating():
                factor = 1.0 if pattern.distortion is None else max(1.0, pattern.distortion.factor)
                radius = factor / math.radians(axial_cycle(pattern).length)
                inner_mm, outer_mm = (radius * fade_mm for fade_mm in pattern.fade_mm)
                fade = (pattern.middle, inner_mm, 1.0 / (outer_mm - inner_mm))
                place = (*pattern.center_mm, pattern.start_deg)
                self.say(i.AXIAL, *self._waveform(pattern), *place, *fade)
            case Tile():
                self.say(i.WRAP, *pattern.origin_mm, pattern.width_mm, pattern.height_mm)
                self._inner(pattern.part)
            case Moving():
                clock = self._clock(pattern.velocity_by)
                right, down = pattern.velocity_mm_s
                self.say(i.SHIFT, right, clock, down, clock, *(pattern.array_at_mm or (_FAR, _FAR)))
                self._inner(pattern.part)
            case _:
                raise TypeError(
                    f"a {type(pattern).__name__} is not rendered; resolve the scene first"
                )

    def _inner(self, part: AnyPattern) -> None:
        """Write what stands at other places, which are gone back from."""
        self._whole(part)
        self.say(i.RESTORE)
        self._measured = None

    def _group(self, group: Group, is_mask: bool) -> None:
        """Write parts that are put together.

        The mask is by the group's own operation, but that of layers is 1 - Π(1 - μ).
        """
        if group.by is not None:
            self._blend(group.parts, group.by, is_mask)
            return
        is_product = group.operation == "multiply"
        self.say(i.LEVEL, float(is_product))
        for number, part in enumerate(group.parts):
            if is_product:
                self._whole(part, is_mask)
                self.say(i.MULTIPLY)
                continue
            with self._gate(bounds(part, self._boxes), self._shut_by(part)):
                self.pattern(part, is_mask)
                if group.weights is not None and not is_mask:
                    self._scale(group.weights[number])
                if group.operation == "overwrite" and not is_mask:
                    self.pattern(part, is_mask=True)
                    self.say(i.OVER)
                else:
                    self.say(_JOINS[group.operation])

    def _blend(self, parts: Sequence[AnyPattern], by: AnyPattern, is_mask: bool) -> None:
        """Write a blend; a part is skipped while a signal chooses the other alone."""
        bit = 0
        changes = by.inverted, by.vibration, by.factor
        if isinstance(by, SignalLevel) and by.amplitude == 1.0 and not any(changes):
            bit = 1 << self._signals[by.name]
        for part, shut_by in zip(parts, (bit << MOST_SIGNALS, bit), strict=True):
            self._whole(part, is_mask, shut_by)
        self.pattern(by)
        self.say(i.BLEND)

    def _waveform(self, grating: LinearGrating | RadialGrating | AxialGrating) -> tuple[float, ...]:
        """Numbers of a grating's waveform, and of what changes its frequency."""
        clock, change = self._clock(grating.velocity_by), grating.distortion
        if isinstance(grating, AxialGrating):
            cycle, velocity = axial_cycle(grating), grating.velocity_deg_s
        else:
            cycle, velocity = Cycle(grating.ridge_mm, grating.gap_mm), grating.velocity_mm_s
        own = (velocity, clock, cycle.length, cycle.ridge)
        if change is None:
            return (*own, 0.0, 0.0, 0.0, 0.0)
        if isinstance(change, Gradual):
            return (*own, change.factor - 1.0, change.start_mm, change.length_mm, 0.0)
        if isinstance(change, TurnPeak):
            center, length = change.center_deg, change.length_deg
        else:
            center, length = change.center_mm, change.length_mm
        return (*own, change.factor - 1.0, center - length, length, 1.0)

    def _bitmap(self, bitmap: Bitmap) -> None:
        rows, columns = bitmap.intensities.shape
        outside = round(bitmap.outside * WHOLE)
        framed = np.pad(bitmap.intensities, 1, constant_values=outside)
        per_mm = columns / bitmap.width_mm, rows / bitmap.height_mm
        x, y = bitmap.place_mm
        # The middle of the frame's first pixel is half a pixel beyond the corner.
        first = x - 0.5 / per_mm[0], y - 0.5 / per_mm[1]
        size = columns + 2, rows + 2
        self.say(i.IMAGE, *first, *per_mm, *size, self._entries(framed), bitmap.nearest)

    # Shapes

    def _shape(self, shape: paths.AnyShape, is_mask: bool) -> None:
        """Write a shape: its fill, the stroke or dots that it is drawn with, and its cue."""
        fill = None if isinstance(shape, StraightLine) else shape.fill
        if fill is not None and not is_mask:
            self._whole(fill.texture)
        self._measure(shape)
        if is_mask:
            self._drawn(shape, is_mask=True)
            if fill is not None:
                self.say(i.INSIDE, -_FAR, 1.0)
                self.say(i.MAXIMUM)
            if shape.is_cued_over:
                self.say(i.PROFILE, *_profile(shape.cue_width_mm, shape.cue_edge_mm))
                self.say(i.OVER_ITSELF)
            return
        if fill is not None:
            begin, slope = -_FAR, 1.0
            if not fill.blended:
                begin = drawn_radius_mm(shape) + fill.gap_mm
                slope = 1.0 / max(fill.fade_mm, _LEAST_FADE_MM)
            self.say(i.INSIDE, begin, slope)
            self.say(i.MULTIPLY)
        self._drawn(shape, is_mask=False)
        if shape.stroke is not None:
            self._texture(shape, shape.stroke)
        if fill is not None and fill.blended:
            self._drawn(shape, is_mask=True, is_textured=False)
            self.say(i.OVER)
        elif fill is not None:
            self.say(i.ADD)
        if shape.cue is not None and shape.is_cued_over:
            self._cue(shape, shape.cue)

    def _measure(self, shape: paths.AnyShape) -> None:
        """Write the coordinates of a shape's path, unless they are known already."""
        if self._measured is shape:
            return
        self._measured = shape
        stroke, cue = shape.stroke, shape.cue
        along = None if stroke is None else stroke.along
        is_along = along is not None or cue is not None
        if isinstance(shape, Circle):
            self.say(i.CIRCLE, *shape.center_mm, shape.radius_mm, is_along)
            return
        reach, fill = max(reach_mm(shape), drawn_radius_mm(shape)), None
        if not isinstance(shape, StraightLine):
            fill = shape.fill
        if fill is not None and not fill.blended:
            reach = max(reach, drawn_radius_mm(shape) + fill.gap_mm + fill.fade_mm)
        if fill is None and stroke is None and not shape.is_cued_over:
            return
        rounded = is_along and isinstance(shape, Polygon) and shape.join == "rounded"
        segments = list(paths.segments_of(shape, rounded=rounded))
        size = len(segments[0])
        self.say(i.PATH, work.CODE + len(self.numbers) + i.HEAD)
        path = len(self.numbers)
        for number in range(0, len(segments), _CHUNK):
            some = segments[number : number + _CHUNK]
            ends = ((one[0] + one[2] * one[4], one[5]) for one in some)
            box = around([*((one[0], one[1]) for one in some), *ends])
            with self._gate(box.grown(reach)):
                self.say(i.SEGMENTS, size, *itertools.chain(*some))
            end = work.CODE + len(self.numbers)
            begin = end - size * len(some)
            if number == 0:
                self.numbers[path - 1] = begin  # the nearest segment where none is near
            if fill is not None:
                with self._gate(box._replace(left=-_FAR)):
                    self.say(i.CROSSINGS, begin, end, size)
        self.say(i.MEASURED, rounded)

    def _drawn(self, shape: paths.AnyShape, *, is_mask: bool, is_textured: bool = True) -> None:
        """Write the profile of what a shape is drawn with, or its dots."""
        stroke, dots = shape.stroke, shape.dots
        if stroke is not None:
            across = stroke.across if is_textured else None
            self.say(i.PROFILE, *_profile(stroke.width_mm, stroke.edge, across, is_mask))
        elif dots is not None:
            across = dots.dot.across if is_textured else None
            motion = dots.velocity_mm_s, self._clock(dots.velocity_by)
            vertices = dots.vertex_vibration
            look = self._dots(dots.dot, across, rows_of(shape)[0], is_mask, vertices, motion)
            for row in paths.moving_rows(shape):
                self.say(i.DOT_ROW, look, *row)
        else:
            self.say(i.LEVEL, 0.0)

    def _dots(
        self,
        style: DotStyle,
        across: Across | None,
        dots: Sequence[PlacedDot],
        is_mask: bool,
        vertices: Vibration | None = None,
        motion: tuple[float, float] = (0.0, -1.0),
    ) -> float:
        """Write dots that stay, and return the place of the numbers of their look."""
        own = (-1.0, -1.0) if vertices is None else _swing(vertices)
        look = (
            *_profile(2 * style.radius_mm, style.edge, across, is_mask),
            style.amplitude,
            *_swing(style.vibration),
            *own,
            *motion,
        )
        self.say(i.LEVEL, 0.0, *look)
        at = float(work.CODE + len(self.numbers) - len(look))
        for number in range(0, len(dots), _CHUNK):
            some = dots[number : number + _CHUNK]
            with self._gate(around((dot.x_mm, dot.y_mm) for dot in some).grown(style.radius_mm)):
                self.say(i.DOTS, at, *itertools.chain(*some))
        return at

    def _texture(self, shape: paths.AnyShape, stroke: Stroke) -> None:
        """Write what the textures of a stroke leave of its profile: eqs. 8.7-8.14."""
        self._scale(stroke.amplitude)
        swing, along = stroke.vibration, stroke.along
        markers = shape.markers if isinstance(shape, Polygon) else None
        cue = None if shape.is_cued_over else shape.cue
        if not (along or stroke.outlined or swing or markers or cue):
            return
        # What an outline leaves out, γ_o of eq. 8.9, ends where its own edge begins.
        groove = _profile(stroke.width_mm - 2 * stroke.edge, stroke.edge)
        if along is not None:
            cycles, clock = stroke_cycles(shape), self._clock(along.velocity_by)
            cycle = cycles[0].length, cycles[0].ridge
            own = along.amplitude, len(set(cycles)) > 1
            self.say(i.BANDS, along.velocity_mm_s, clock, *cycle, *own)
            if along.whole_edges:
                self.say(i.PROFILE, *groove)
                self.say(i.MULTIPLY)
        elif stroke.outlined:
            self.say(i.PROFILE, *groove)
        else:
            self.say(i.LEVEL, 0.0)
        self.say(i.INVERT)
        self._vibrate(swing)
        if markers is not None and isinstance(shape, Polygon):
            own = (1.0 / markers.blend_mm, *_swing(markers.swing))
            self.say(i.MARKERS, *own, *paths.marker_numbers(shape))
        if cue is not None:
            self._cue(shape, cue)
        self.say(i.MULTIPLY)

    def _cue(self, shape: paths.AnyShape, cue: MovingCue) -> None:
        """Lay the bands of a cue over what is uppermost: 9.3 and 9.3.2."""
        if cue.way == "add":
            self._scale(1.0 - cue.share)
        cycle, clock = cue_cycle(shape), self._clock(cue.velocity_by)
        self.say(i.BANDS, cue.velocity_mm_s, clock, cycle.length, cycle.ridge, 1.0, 0.0)
        if shape.is_cued_over:
            self.say(i.PROFILE, *_profile(shape.cue_width_mm, shape.cue_edge_mm))
            self.say(i.MULTIPLY)
            # Bands that are not wider than a row of dots end as the row does.
            _, closed = shape.outline
            if not closed and shape.cue_width_mm > shape.width_mm:
                self.say(i.BEYOND, 2.0 / shape.width_mm)
                self.say(i.MULTIPLY)
        shows, hides = {
            "vibrate": (1.0, 1.0),
            "blend": (cue.level, 1.0),
            "mask": (0.0, 2.0),
            "add": (cue.share, 0.0),
        }[cue.way]
        self.say(i.CUE, shows, hides, *_swing(cue.swing))
        self.say(i.OVER)


def _profile(
    width: float, edge: float, across: Across | None = None, is_mask: bool = False
) -> tuple[float, ...]:
    half = width / 2
    texture = (0.0, 0.0) if across is None else (across.amplitude, across.cycles / width)
    return (half - edge, 1.0 / edge, half, *texture, is_mask)


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
        self._scene, self._assets = scene, assets
        self._compiled: dict[bool, tuple[NDArray[np.float64], NDArray[np.uint16]]] = {}

    def deflections(
        self,
        x_mm: NDArray[np.float64],
        y_mm: NDArray[np.float64],
        *,
        is_mask: bool = False,
        time_s: float = 0.0,
        parity: int = 0,
        noise_seed: int | None = None,
        velocity_mm_s: Point = (0.0, 0.0),
        switches: int = 0,
        every_layer: bool = False,
    ) -> NDArray[np.float32]:
        """Compute the deflections of actuators at the places of a raster: Lévesque 2009, 8.3.3.

        Parameters
        ----------
        x_mm, y_mm : float64[w], float64[h]
            Places of its columns and lines on the canvas.
        is_mask
            Whether the opacity mask of the scene is computed (8.4.5). Only that of a blend that is
            chosen by what moves depends on the time. A scene of one element has the mask of that.
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
        every_layer
            Whether all signals are 1, so that every layer is there.

        Returns
        -------
        float32[h, w]
            Deflections, 0 … 1; 0 beyond the canvas.
        """
        given = self.signal_values(time_s, velocity_mm_s, switches)
        if every_layer:
            given[:MOST_SIGNALS] = 1.0
        if is_mask not in self._compiled:
            numbers = np.zeros(work.CODE)
            self._compiled[is_mask] = _written(self._scene, self._assets, numbers, is_mask=is_mask)
        numbers, table = self._compiled[is_mask]
        more = 1 + int(numbers[work.INSTRUCTIONS]) // _BLOCK**2
        rows = np.zeros((work.LIVE_ROW + more, _BLOCK**2))
        rows[work.GIVEN_ROW, : given.size] = given
        shape = len(y_mm), len(x_mm)
        time, signs = time_s, np.broadcast_to(np.float32(-1.0 if parity else 1.0), shape)
        if noise_seed is not None:
            random = np.random.default_rng(noise_seed)
            time, signs = math.nan, random.random(shape, np.float32) * 2 - 1
        out = np.empty(shape, np.float32)
        for top in range(0, shape[0], _BLOCK):
            for left in range(0, shape[1], _BLOCK):
                block = slice(top, top + _BLOCK), slice(left, left + _BLOCK)
                made = np.empty(out[block].shape)
                x, y = np.meshgrid(x_mm[block[1]], y_mm[block[0]])
                places = np.stack([x, y, signs[block]]).reshape(3, -1)
                rows[work.X_ROW : work.SIGN_ROW + 1, : made.size] = places
                i.show(numbers, table, rows, time, made)
                out[block] = made
        return out

    def signal_values(
        self, time_s: float, velocity_mm_s: Point, switches: int
    ) -> NDArray[np.float64]:
        """Compute the signals, in their order; then NaN, as no array has a centre: float64[10]."""
        at = np.zeros(work.AT)
        if self._scene.signals:
            at[work.TIME], at[work.SWITCHES] = time_s, switches
            at[work.VX], at[work.VY] = velocity_mm_s
            numbers = np.zeros(work.CODE)
            _write_signals(self._scene, numbers)
            kernels.begin(numbers, at)
            kernels.compute(numbers, at, 0.0)
        return np.append(at[work.SIGNAL : work.MEMORY], (math.nan, math.nan))
