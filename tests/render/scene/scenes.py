"""Tactile pictures drawn at random, what they need beside themselves, and what their twin shows.

Numbers of scenes have two digits, so that what fails can be read and shrinks well. Poses have odd
ones: a place that is as near to one edge as to another belongs to either.
"""

import math

from hypothesis import settings
from hypothesis import strategies as st

from tests.render.scene.showing import SIDE_MM
from tests.render.scene.twinsignals import SIGNALS
from tests.tiers import by_tier
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
    Label,
    LinearGrating,
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
from vbraille.scene.scene import Canvas, Scene


def examples(count):
    """Try a law on so many examples in `make test-all`, on a few and many more in the others."""
    return settings(max_examples=by_tier(max(count // 8, 4), count, 50 * count))


def numbers(least, most):
    """Numbers with two digits after the point."""
    return st.integers(math.ceil(least * 100), math.floor(most * 100)).map(lambda n: n / 100)


shares = st.one_of(st.just(1.0), numbers(0, 1))
points = st.tuples(numbers(0, SIDE_MM), numbers(0, SIDE_MM))
vibrations = st.builds(
    Vibration, frequency_hz=numbers(0.1, 50), amplitude=shares, of=st.sampled_from(["high", "low"])
)
high = st.builds(Vibration, frequency_hz=numbers(0.1, 50), amplitude=shares)
velocities = st.one_of(st.just(0.0), numbers(-100, 100))
gaps = st.one_of(st.just(0.0), numbers(0.1, 10))

# What may change any pattern; mostly nothing does.
changes = st.one_of(
    st.just({}),
    st.fixed_dictionaries(
        {},
        optional={
            "amplitude": shares,
            "inverted": st.booleans(),
            "vibration": vibrations,
            "factor": st.sampled_from(["none", "half", "all"]),
        },
    ),
)


def patterns_of(kind, **fields):
    """Patterns of a kind with fields drawn, and changed as any pattern may be."""
    return st.builds(
        lambda own, change: kind(**own, **change), st.fixed_dictionaries(fields), changes
    )


# Textures

distortions = st.one_of(
    st.builds(Gradual, factor=numbers(0.1, 8), start_mm=numbers(-20, 60), length_mm=numbers(1, 80)),
    st.builds(Peak, factor=numbers(0.1, 8), center_mm=numbers(-20, 60), length_mm=numbers(1, 80)),
)
turn_peaks = st.builds(
    TurnPeak, factor=numbers(0.1, 8), center_deg=numbers(0, 360), length_deg=numbers(1, 360)
)


def moving_or_distorted(distortion, velocity):
    """A grating has a distortion, or ridges that move, or neither."""
    return st.one_of(
        st.just({}),
        st.fixed_dictionaries({"distortion": distortion}),
        st.fixed_dictionaries({velocity: numbers(-100, 100)}),
    )


uniforms = patterns_of(Uniform, level=shares)
levels = patterns_of(SignalLevel, name=st.sampled_from(["none", "half", "all"]))
uniform_vibrations = patterns_of(UniformVibration, frequency_hz=numbers(0.1, 50))
linear_gratings = st.builds(
    lambda own, angle, more, change: LinearGrating(**own, **angle, **more, **change),
    st.fixed_dictionaries({"ridge_mm": numbers(0.5, 12), "gap_mm": gaps, "start_mm": points}),
    st.one_of(
        st.just({}),
        st.fixed_dictionaries({"wave_angle_deg": numbers(-180, 180)}),
        st.fixed_dictionaries({"ridge_angle_deg": numbers(-180, 180)}),
    ),
    moving_or_distorted(distortions, "velocity_mm_s"),
    changes,
)
radial_gratings = st.builds(
    lambda own, more, change: RadialGrating(**own, **more, **change),
    st.fixed_dictionaries({"ridge_mm": numbers(0.5, 12), "gap_mm": gaps, "center_mm": points}),
    moving_or_distorted(distortions, "velocity_mm_s"),
    changes,
)
axial_gratings = st.builds(
    lambda own, more, change: AxialGrating(**own, **more, **change),
    st.fixed_dictionaries(
        {
            "center_mm": points,
            "ridge_deg": numbers(5, 180),
            "gap_deg": st.one_of(st.just(0.0), numbers(0.5, 180)),
            "start_deg": numbers(-360, 360),
            "whole_cycles": st.booleans(),
            "fade_mm": st.sampled_from([(0.5, 1.0), (0.0, 3.0)]),
            "middle": shares,
        }
    ),
    moving_or_distorted(turn_peaks, "velocity_deg_s"),
    changes,
)
textures = st.one_of(
    levels, uniforms, uniform_vibrations, linear_gratings, radial_gratings, axial_gratings
)

# Strokes and dots

acrosses = st.builds(Across, amplitude=shares, cycles=st.sampled_from([1, 3, 7, 11]))
alongs = st.builds(
    Along,
    ridge_mm=numbers(0.5, 8),
    gap_mm=gaps,
    amplitude=shares,
    whole_edges=st.booleans(),
    whole_cycles=st.booleans(),
    velocity_mm_s=velocities,
)


@st.composite
def strokes(draw):
    """Strokes of any kind that a stroke can be."""
    along = draw(st.one_of(st.none(), alongs))
    outlined = along is None and draw(st.booleans())
    width = draw(numbers(0.5, 15))
    four = outlined or (along is not None and along.whole_edges)
    edge = draw(
        numbers(0.05, max(0.06, width / 4)) if four else st.just("smooth") | numbers(0.05, 5)
    )
    if four:
        width = max(width, 4 * edge)
    return Stroke(
        width_mm=width,
        edge_mm=edge,
        amplitude=draw(shares),
        outlined=outlined,
        across=draw(st.none() | acrosses),
        along=along,
        vibration=draw(st.none() | (high if along is None else vibrations)),
    )


@st.composite
def dot_styles(draw):
    """Dots of any kind."""
    radius = draw(numbers(0.3, 4))
    edge = draw(st.none() | numbers(0.05, 4))
    return DotStyle(
        radius_mm=radius,
        edge_mm=edge,
        plateau=draw(st.none() | numbers(0, 0.95)) if edge is None else None,
        amplitude=draw(shares),
        across=draw(st.none() | acrosses),
        vibration=draw(st.none() | high),
    )


dottings = st.builds(
    Dotting,
    dot=dot_styles(),
    separation_mm=numbers(0, 6),
    vertex_vibration=st.none() | high,
    velocity_mm_s=velocities,
)
cues = st.builds(
    MovingCue,
    way=st.sampled_from(["vibrate", "blend", "mask", "add"]),
    ridge_mm=numbers(0.5, 8),
    gap_mm=gaps,
    velocity_mm_s=velocities,
    width_mm=numbers(0, 15),
    share=shares,
    level=shares,
    vibration=st.none() | high,
    whole_cycles=st.booleans(),
)
# What a shape is drawn with; the last has nothing but a fill.
drawn = st.builds(
    lambda look, cue: {**look, **cue},
    st.one_of(
        st.fixed_dictionaries({"stroke": strokes()}), st.fixed_dictionaries({"dots": dottings})
    ),
    st.one_of(st.just({}), st.just({}), st.fixed_dictionaries({"cue": cues})),
)
markers = st.builds(
    lambda span, angle, blend, swing: VertexMarkers(
        span=span, angle_deg=angle, blend_mm=blend, **swing
    ),
    st.sampled_from(["angle", "square", "edges", "arc"]),
    numbers(1, 180),
    numbers(0.05, 4),
    st.just({"plain": True}) | st.fixed_dictionaries({"vibration": high}),
)


def shapes(kind, **fields):
    """Shapes of a kind without a fill."""
    return st.builds(
        lambda own, look, change: kind(**own, **look, **change),
        st.fixed_dictionaries(fields),
        drawn,
        changes,
    )


def filled(kind, texture, **fields):
    """Shapes of a kind with a fill, whether they have a stroke, dots or neither."""
    fills = st.builds(
        Fill,
        texture=texture,
        gap_mm=st.just(0.0) | numbers(0, 3),
        fade_mm=st.just(0.0) | numbers(0.05, 3),
        blended=st.booleans(),
    )
    return st.builds(
        lambda own, look, fill, change: kind(**own, **look, fill=fill, **change),
        st.fixed_dictionaries(fields),
        st.one_of(st.just({}), drawn),
        fills,
        changes,
    )


@st.composite
def outlines(draw, most=7):
    """Corners of a polygon whose edges do not cross: it can all be seen from one place."""
    middle = draw(points)
    turns = draw(st.lists(st.integers(0, 71), min_size=3, max_size=most, unique=True))
    return tuple(
        (
            round(middle[0] + far * math.cos(math.radians(5 * turn)), 2),
            round(middle[1] + far * math.sin(math.radians(5 * turn)), 2),
        )
        for turn in sorted(turns)
        for far in [draw(numbers(2, 30))]
    )


def apart(places):
    """Whether no two places that follow are the same, nor the last and the first."""
    return all(
        math.dist(a, b) > 0.01 for a, b in zip(places, [*places[1:], places[0]], strict=True)
    )


contours = st.lists(points, min_size=3, max_size=6, unique=True).map(tuple).filter(apart)
ends = st.fixed_dictionaries({"start_mm": points, "end_mm": points}).filter(
    lambda line: line["start_mm"] != line["end_mm"]
)
lines = st.builds(
    lambda own, look, change: StraightLine(**own, **look, **change), ends, drawn, changes
)
round_fields = {"center_mm": points, "radius_mm": numbers(0.5, 30)}
corner_fields = {
    "vertices_mm": outlines().filter(
        lambda places: apart(places) and meeting_edges(places) is None
    ),
    "join": st.sampled_from(["straight", "rounded"]),
    "rounding_offset_mm": st.just(0.0) | numbers(0, 6),
    "markers": st.none() | markers,
}
path_fields = {"contours_mm": st.lists(contours, min_size=1, max_size=3).map(tuple)}
open_or_closed = {**path_fields, "closed": st.booleans()}
closed = {**path_fields, "closed": st.just(True)}

dots = patterns_of(
    Dots, centers_mm=st.lists(points, min_size=1, max_size=8).map(tuple), dot=dot_styles()
)

# What needs something beside itself

image_fields = {
    "file": st.sampled_from(["blank.png", "whole.png", "one.png", "gray.png", "sparse.png"]),
    "place_mm": points,
    "width_mm": numbers(0.5, 40),
    "height_mm": numbers(0.5, 40),
    "outside": st.just(0.0) | shares,
    "nearest": st.booleans(),
}
labels = patterns_of(
    Label,
    text=st.sampled_from(["a", "map", "north sea"]),
    place_mm=points,
    angle_deg=st.just(0.0) | numbers(-180, 180),
)


# All together


def simple(texture):
    """Patterns of every kind but groups and tiles, with such textures inside."""
    return {
        "line": lines,
        "circle": shapes(Circle, **round_fields),
        "filled circle": filled(Circle, texture, **round_fields),
        "polygon": shapes(Polygon, **corner_fields),
        "filled polygon": filled(Polygon, texture, **corner_fields),
        "path": shapes(PathShape, **open_or_closed),
        "filled path": filled(PathShape, texture, **closed),
        "dots": dots,
        "image": patterns_of(Image, **image_fields),
        "image of a texture": patterns_of(Image, texture=texture, **image_fields),
        "label": labels,
    }


def groups(parts):
    """Groups of every operation."""
    several = st.lists(parts, min_size=1, max_size=4).map(tuple)
    return st.one_of(
        patterns_of(
            Group,
            operation=st.sampled_from(["overwrite", "overwrite", "multiply", "add", "maximum"]),
            parts=several,
        ),
        weighted(several),
        patterns_of(
            Group,
            operation=st.just("blend"),
            parts=st.tuples(parts, parts),
            by=parts | levels,
        ),
    )


def weighted(several):
    """Sums by weights that add up to 1."""
    return st.builds(
        lambda parts, share, change: Group(
            operation="weighted", parts=parts, weights=_weights(len(parts), share), **change
        ),
        several,
        numbers(0, 1),
        changes,
    )


def _weights(count, share):
    rest = (1 - share) / (count - 1) if count > 1 else 0.0
    return (share, *[rest] * (count - 1)) if count > 1 else (1.0,)


def tiles(parts):
    """Tiles of any pattern."""
    return patterns_of(
        Tile, width_mm=numbers(0.5, 40), height_mm=numbers(0.5, 40), part=parts, origin_mm=points
    )


KINDS = {
    "uniform": uniforms,
    "vibration": uniform_vibrations,
    "signal": levels,
    "linear grating": linear_gratings,
    "radial grating": radial_gratings,
    "axial grating": axial_gratings,
    **simple(textures),
    "tile": tiles(st.one_of(textures, *simple(textures).values())),
    "group": groups(st.one_of(textures, *simple(textures).values())),
}
patterns = st.recursive(
    st.one_of(*(kind for name, kind in KINDS.items() if name not in ("tile", "group"))),
    lambda parts: st.one_of(groups(parts), tiles(parts)),
    max_leaves=5,
)


# Patterns that end somewhere.


@st.composite
def scenes(draw, parts=patterns, most=4):
    """Scenes of some patterns."""
    return Scene(
        canvas=Canvas(width_mm=SIDE_MM, height_mm=SIDE_MM),
        operation=draw(st.sampled_from(["overwrite", "maximum", "add", "multiply"])),
        elements=tuple(draw(st.lists(parts, min_size=1, max_size=most))),
        signals=SIGNALS,
    )


seeds = st.integers(0, 2**32 - 1)
