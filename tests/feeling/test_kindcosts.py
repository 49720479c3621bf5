"""What kinds of patterns cost: measured, and held to the whole and to what elements cost.

Times are told by a machine that does other things, too, so each is measured anew until it is as it
must be: disturbances make times larger, and never all of them by the same.
"""

import numpy as np
import pytest

from tests.feeling.felt import DISPLAY
from vbraille.feeling.costs import batches_of, time_frames
from vbraille.feeling.kindcosts import BLANK, COMPOSITION, KINDS, costs_of_kinds
from vbraille.feeling.paths import PathOptions, path_of
from vbraille.render.scene.compiling import compile_scene
from vbraille.scene.dots import Dots
from vbraille.scene.patterns import Circle, Fill
from vbraille.scene.scene import Canvas, Scene
from vbraille.scene.strokes import Across, DotStyle, Stroke
from vbraille.scene.textures import AxialGrating, RadialGrating, UniformVibration

CANVAS = Canvas(width_mm=120, height_mm=90)
SPOT = PathOptions("spot", at="60,45", seconds=0.3)
TRIES = 12
GRATING = RadialGrating(center_mm=(60, 45), ridge_mm=3)
SPOKES = AxialGrating(center_mm=(60, 45), ridge_deg=20)
DOTS = Dots(
    centers_mm=tuple((x, y) for x in (54.0, 60.0, 66.0) for y in (39.0, 45.0, 51.0)),
    dot=DotStyle(radius_mm=2, across=Across()),
)
DISC = Circle(center_mm=(60, 45), radius_mm=8, stroke=Stroke(width_mm=3), fill=Fill(texture=SPOKES))


def program_of(*elements):
    scene = Scene(canvas=CANVAS, elements=elements, operation="add")
    return compile_scene(scene, DISPLAY)


def path():
    return path_of(SPOT, CANVAS, DISPLAY.span_mm, 1000.0)


def test_kinds_make_the_whole_within_a_tenth():
    program = program_of(GRATING, DOTS, DISC, UniformVibration(frequency_hz=20))
    sums = []
    for _ in range(TRIES):
        costs = costs_of_kinds(program, path(), 3)
        sums.append([each.told_apart for each in costs])
        if np.abs(np.array(sums[-1]) - 1).max() < 0.1:
            break
    else:
        pytest.fail(f"shares of the whole: {sums}")
    whole, dearest = costs
    assert whole.found == ("strokes", "fills", "gratings", "vibration", "dots", COMPOSITION, BLANK)
    assert tuple(whole.kinds_us) == KINDS
    assert not whole.kinds_us["labels"].any()
    assert whole.whole_us.shape == (len(batches_of(path())),)
    assert dearest.whole_us.shape == (1,)


@pytest.mark.parametrize(
    ("kind", "element"), [("gratings", GRATING), ("dots", DOTS)], ids=["gratings", "dots"]
)
def test_a_kind_costs_what_frames_cost_more_with_it(kind, element):
    """By another way: the picture compiled without the element."""
    shown = program_of(DISC, element)
    without = program_of(DISC)
    tries = []
    for _ in range(TRIES):
        first, _ = costs_of_kinds(shown, path(), 0)
        other, _ = costs_of_kinds(without, path(), 0)
        least = time_frames([shown, without], batches_of(path()), 7).min(axis=1).mean(axis=1)
        own_us = first.kinds_us[kind].mean() - other.kinds_us[kind].mean()
        tries.append((float(own_us), float(least[0] - least[1])))
        # Calling the element and adding it are composition.
        if own_us == pytest.approx(least[0] - least[1], rel=0.25):
            return
    pytest.fail(f"µs of {kind}: {tries}")
