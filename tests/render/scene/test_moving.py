"""What moves along paths: Lévesque 2009, 9.3.2 and 9.3.3; `test_laws` holds it to its twin."""

import math

import numpy as np
import pytest
from msgspec.structs import replace

from tests.render.scene.showing import STRESS2_8X8_ARRAY, scene_of
from vbraille.render.compiling import SceneMap, compile_scene
from vbraille.scene.geometry import bounds, rows_of
from vbraille.scene.patterns import (
    Along,
    Circle,
    DotStyle,
    Dotting,
    MovingCue,
    PathShape,
    Polygon,
    StraightLine,
    Stroke,
    Vibration,
)

DOT = DotStyle(radius_mm=1.0, edge_mm=0.5)
MOVING = Dotting(dot=DOT, velocity_mm_s=20.0)
LINE = StraightLine(start_mm=(10, 30), end_mm=(40, 30), dots=MOVING)
SQUARE = Polygon(vertices_mm=((10, 10), (40, 10), (40, 40), (10, 40)), dots=MOVING)
CURVE = tuple((30 + 20 * math.cos(a), 30 + 20 * math.sin(a)) for a in np.arange(0, 4, 0.1))
WINDING = PathShape(contours_mm=(CURVE,), dots=MOVING)
ROUND = PathShape(contours_mm=((*CURVE[::2], (15.0, 20.0)),), closed=True, dots=MOVING)
RING = Circle(center_mm=(30, 30), radius_mm=15, dots=MOVING)

CUED = StraightLine(
    start_mm=(10, 30),
    end_mm=(40, 30),
    stroke=Stroke(width_mm=8),
    cue=MovingCue(way="blend", width_mm=6, ridge_mm=4, gap_mm=6),
)
THIN = replace(CUED, stroke=Stroke(width_mm=3, edge_mm=0.5), cue=replace(CUED.cue, width_mm=10))
CUTS = StraightLine(
    start_mm=(10, 30), end_mm=(40, 30), stroke=Stroke(along=Along(ridge_mm=4, velocity_mm_s=20))
)


def along(shape, time_s, x, y):
    """Deflections at places of a line that is level."""
    return SceneMap(scene_of(shape)).deflections(
        np.asarray(x, float), np.array([float(y)]), time_s=time_s
    )[0]


def test_dots_of_a_line_move_by_its_speed_and_come_round():
    pitch = rows_of(LINE)[1][0].pitch_mm
    x = np.linspace(12, 38, 500)
    at_first = along(LINE, 0.0, x, 30)
    later = along(LINE, 0.01, x + 0.2, 30)
    np.testing.assert_allclose(later, at_first, atol=1e-5)
    np.testing.assert_allclose(along(LINE, pitch / 20, x, 30), at_first, atol=1e-5)
    assert np.abs(along(LINE, pitch / 40, x, 30) - at_first).max() > 0.9


def test_dots_come_and_go_at_the_ends_of_a_line():
    for time_s in np.arange(0, 0.15, 0.01):
        assert not along(LINE, time_s, np.linspace(0, 8.99, 60), 30).any()
        assert not along(LINE, time_s, np.linspace(41.01, 50, 60), 30).any()
    # Half of the fade is where the line ends, but for a dot's own edge.
    shares = [along(LINE, time_s, [9.5], 30)[0] for time_s in np.arange(0, 0.15, 0.001)]
    assert max(shares) == pytest.approx(0.5, abs=0.01)


def test_dots_on_vertices_stay():
    frames = [along(SQUARE, t, [10, 40, 25], 10) for t in np.arange(0, 0.5, 0.01)]
    corners, middle = np.array(frames)[:, :2], np.array(frames)[:, 2]
    assert (corners == 1.0).all()
    assert np.ptp(middle) == 1.0
    stay, rows = rows_of(SQUARE)
    assert [dot[:2] for dot in stay] == list(SQUARE.vertices_mm)
    assert len(rows) == 4


@pytest.mark.parametrize("shape", [LINE, SQUARE, WINDING, ROUND, RING, CUED, THIN, CUTS])
def test_what_moves_stays_within_its_bounds_and_never_jumps(shape):
    program = compile_scene(scene_of(shape), STRESS2_8X8_ARRAY)
    box = bounds(shape)
    times = np.arange(0, 0.6, 0.001)
    rng = np.random.default_rng(3)
    for x, y in rng.uniform(5, 55, (12, 2)):
        frames = program.poses(np.full(times.size, x), np.full(times.size, y), 0.4, times)[
            1
        ].reshape(times.size, -1)
        # The steepest slope of a dot and of the fade, over a fiftieth of a millimetre.
        most = 0.02 * (math.pi / 2 / 0.5 + 1)
        if shape.cue is not None:
            most = 0.05 * math.pi / 4
        assert np.abs(np.diff(frames, axis=0)).max() <= most + 1e-6
    x, y = np.arange(0.0, 60.0, 0.25), np.arange(0.0, 60.0, 0.25)
    for time_s in (0.0, 0.037, 1.21):
        up = SceneMap(scene_of(shape)).deflections(x, y, time_s=time_s) > 0
        rows, columns = np.nonzero(up)
        assert up.any()
        for column, row in zip(columns, rows, strict=True):
            assert box.holds(x[column], y[row])


@pytest.mark.parametrize(
    ("make", "said"),
    [
        (lambda: Circle(center_mm=(9, 9), radius_mm=5, cue=MovingCue()), "cue needs a stroke"),
        (lambda: MovingCue(velocity_mm_s=0, velocity_by="on"), "without a velocity"),
        (lambda: MovingCue(ridge_mm=0), "ridge is 0"),
        (lambda: MovingCue(share=1.5), "share is 1.5"),
        (lambda: MovingCue(vibration=Vibration(of="low")), "not for bands"),
        (lambda: Dotting(velocity_mm_s=5000), "velocity is 5000"),
        (lambda: Dotting(velocity_by="on"), "without a velocity"),
    ],
)
def test_what_cannot_move_so_is_refused(make, said):
    with pytest.raises(ValueError, match=said):
        make()
