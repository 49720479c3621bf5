"""Lines and ways to show them, drawn at random, and what is plain to say about each."""

import math
from dataclasses import dataclass, replace

import numba
import numpy as np
from hypothesis import strategies as st

from tests import tiers
from tests.render.braille.reference import deflections
from tests.shown import LATERO, STRESS2_ARRAY, VBD_ARRAY, array_of, from_left
from vbraille.braille.geometry import PRESETS, Geometry
from vbraille.display import Display
from vbraille.render import (
    MAPPINGS,
    STRESS2,
    VBD,
    BrailleStyle,
    Mapping,
    Profile,
    Tuning,
    single_row,
)

JIT = not numba.config.DISABLE_JIT

# Dot row and dot column (0 left, 1 right) of the dots as readers count them.
DOT_PLACES = {
    1: (0, 0),
    2: (1, 0),
    3: (2, 0),
    4: (0, 1),
    5: (1, 1),
    6: (2, 1),
    7: (3, 0),
    8: (3, 1),
}


def examples(count):
    """Try a law on so many examples, by tier; on fewer where the kernels are not compiled."""
    return tiers.examples(count if JIT else max(count // 5, 10))


def cell(*dots):
    """The mask of a cell with these dots."""
    return sum(1 << (dot - 1) for dot in dots)


def line(*masks):
    return np.array(masks, np.uint8)


def frame_at(renderer, x_mm, dtype=np.float64):
    """A frame, put where something else was before."""
    out = np.full(renderer.shape, np.nan, dtype)
    renderer.frame(x_mm, out)
    return out


@dataclass(frozen=True)
class Scene:
    masks: np.ndarray
    style: BrailleStyle
    array: Display

    def renderer(self):
        return from_left(self.masks, self.style, self.array)

    def twin(self, x_mm):
        return deflections(x_mm, self.masks, self.style, self.array, 0.0)

    def idle(self):
        """Idle ends of the array's rows, as a column."""
        idle = np.zeros((self.array.rows, 1))
        idle[self.first_row : self.first_row + self.style.mapping.rows, 0] = (
            self.style.mapping.inverted
        )
        return idle

    @property
    def first_row(self):
        """Where the mapping stands: in the middle, or a row above it."""
        return (self.array.rows - self.style.mapping.rows) // 2

    def dots(self):
        """Actuator row and left edge, in mm, of each dot wherever it is shown."""
        return [
            (
                row,
                number * self.style.geometry.cell_pitch_mm
                + side * self.style.geometry.dot_spacing_mm,
            )
            for number, mask in enumerate(self.masks)
            for dot, (dot_row, side) in DOT_PLACES.items()
            if mask & cell(dot)
            for row, shown in enumerate(
                self.style.mapping.right if side else self.style.mapping.left, self.first_row
            )
            if shown == dot_row
        ]

    def steepest_per_mm(self):
        """The largest slope that the equations allow, in swings per mm.

        Half a sinusoid: (π/W) (cos θ + 8a cos 8θ) / M(a), with 8a = T and M ≥ 1. Raised cosine:
        half of (1 - T) π/R + T kπ/R, with R = W/2.
        """
        level = self.style.tuning.texture
        if self.style.profile is Profile.HALF_SINE:
            waves = 1 + level
        else:
            waves = 1 - level + self.style.tuning.cycles * level
        return self.style.tuning.contrast * waves * math.pi / self.style.geometry.dot_width_mm

    def rounding(self, x_mm):
        """How far deflections may differ because a place in mm has only so many digits."""
        far = np.abs(x_mm) + self.array.span_mm + self.style.geometry.extent_mm(len(self.masks))
        return 3 * self.steepest_per_mm() * np.spacing(np.max(far))


def models(masks, **changes):
    """A scene of each display as it comes, or with changes."""
    return {
        model.name: Scene(masks, replace(model.style, **changes), model.display)
        for model in (VBD, STRESS2)
    }


# Few and ready-made draws: a law is as quick as its scenes are drawn.
tunings = st.builds(
    Tuning,
    texture=st.floats(0, 1),
    contrast=st.floats(0, 1),
    cycles=st.sampled_from([1, 3, 5, 7, 9, 11]),
)
lines = st.binary(max_size=6).map(lambda masks: line(*masks))
arrays = st.one_of(
    st.sampled_from([VBD_ARRAY, STRESS2_ARRAY, LATERO]),
    st.builds(
        array_of,
        rows=st.integers(1, 16),
        columns=st.integers(1, 12),
        column_pitch_mm=st.floats(0.05, 8),
        row_pitch_mm=st.just(1.0),
    ),
)


def _drawn_geometry(spacing_mm, gap_mm, width):
    """Dots apart (width 0 to 1), just touching (1), or one over the other (to 2)."""
    touching = min(spacing_mm, gap_mm)
    widest = min(spacing_mm + gap_mm, 20.0)
    if width <= 1:
        width_mm = 0.2 + width * (touching - 0.2)
    else:
        width_mm = min(touching + (width - 1) * (widest - touching), widest)
    return Geometry(width_mm, spacing_mm, gap_mm, row_spacing_mm=3.6, line_pitch_mm=14.0)


geometries = st.one_of(
    st.sampled_from([*PRESETS.values()]),
    st.builds(
        _drawn_geometry,
        st.floats(0.5, 20),
        st.floats(0.5, 20),
        st.one_of(st.sampled_from([1.0, 2.0]), st.floats(0, 2)),
    ),
)


def _drawn_mapping(numbers):
    """Any table at all; in each number are what a row shows left and right, and its phase."""
    return Mapping(
        "drawn",
        tuple(number % 5 - 1 for number in numbers),
        tuple(number // 5 % 5 - 1 for number in numbers),
        tuple(number // 25 % 2 == 1 for number in numbers),
    )


_single_rows = st.sampled_from([single_row(1), single_row(2), single_row(3)])
_methods = {
    rows: st.sampled_from([each for each in MAPPINGS.values() if each.rows <= rows])
    for rows in range(3, 17)
}
_tables = {rows: st.binary(min_size=1, max_size=rows).map(_drawn_mapping) for rows in range(1, 17)}
mappings = {
    rows: st.one_of(_methods.get(rows, _single_rows), _tables[rows]) for rows in range(1, 17)
}


@st.composite
def scenes(draw):
    array = draw(arrays)
    masks, profile = draw(lines), draw(st.sampled_from(Profile))
    style = BrailleStyle(profile, draw(mappings[array.rows]), draw(geometries), draw(tunings))
    return Scene(masks, style, array)


# How far from an edge, in dot widths.
_asides = st.one_of(st.sampled_from([0.0, 1e-12, -1e-12, 1e-6, -1e-6]), st.floats(-1, 1))
_place = st.tuples(st.integers(0, 9999), _asides)
few_places = st.lists(_place, min_size=1, max_size=3)
many_places = st.lists(_place, min_size=2, max_size=30)


@st.composite
def scenes_with_places(draw, places=few_places):
    """A scene, and positions that bring some column to, near, or between the edges of dots."""
    scene = draw(scenes())
    geometry, width = scene.style.geometry, scene.style.geometry.dot_width_mm
    # One cell more on each side: there, too, are edges that the kernels reckon with.
    edges = [
        number * geometry.cell_pitch_mm + side * geometry.dot_spacing_mm + right * width
        for number in range(-1, len(scene.masks) + 1)
        for side in (0, 1)
        for right in (0, 1)
    ]
    offsets = scene.array.column_offsets_mm()
    x_mm = [
        edges[number % len(edges)] + aside * width - offsets[number // len(edges) % offsets.size]
        for number, aside in draw(places)
    ]
    return scene, np.array(x_mm)
