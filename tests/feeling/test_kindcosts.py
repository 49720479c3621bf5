"""What kinds of patterns cost: measured, and held to the whole and to what elements cost.

How times are taken apart is tried on a machine that always takes the same. A real one does other
things, too; only `make soak` asks it, and each time anew until it is as it must be: disturbances
make times larger, and never all of them by the same.
"""

import numpy as np
import pytest

from tests.feeling.felt import DISPLAY
from tests.tiers import TIER, Tier
from vbraille.feeling.costs import batches_of, time_frames
from vbraille.feeling.kindcosts import BLANK, COMPOSITION, KINDS, costs_of_kinds
from vbraille.feeling.paths import PathOptions, path_of
from vbraille.render import work
from vbraille.render.machine import words as w
from vbraille.render.scene.compiling import compile_scene
from vbraille.render.scene.stripping import WordKind, kinds_in
from vbraille.scene.dots import Dots
from vbraille.scene.patterns import Circle, Fill
from vbraille.scene.scene import Canvas, Scene
from vbraille.scene.strokes import Across, DotStyle, Stroke
from vbraille.scene.textures import AxialGrating, RadialGrating, UniformVibration

CANVAS = Canvas(width_mm=120, height_mm=90)
SPOT = PathOptions("spot", at="60,45", seconds=0.3)
TRIES = 12
by_the_clock = pytest.mark.skipif(TIER < Tier.SOAK, reason="for `make soak`: it takes times")
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


PRICES = dict(zip(WordKind, (0.5, 1.0, 2.0, 4.0, 8.0, 16.0, 32.0), strict=True))
CALLS, NOTHING = 0.25, 0.125


def priced(programs, at, repeats):
    """Times of a machine on which each kind has its price, higher from batch to batch."""
    taken = np.zeros((len(programs), repeats, at.shape[0]))
    for number, program in enumerate(programs):
        tiles = int(program.numbers[w.GRID_COLUMNS] * program.numbers[w.GRID_ROWS])
        starts = program.numbers[w.GRID : w.GRID + tiles].astype(int)
        calls = (program.numbers[starts] >= w.OPERATIONS).any()
        price = sum(PRICES[kind] for kind in kinds_in(program)) if calls else 0
        taken[number] = price + CALLS * calls + NOTHING
    # Something else has the machine in each repeat but one.
    busy = np.arange(repeats)[:, None] != np.arange(at.shape[0]) % repeats
    return taken * (1 + at[:, 0, work.TIME]) + busy * taken


def test_each_kind_has_its_price_and_all_make_the_whole():
    program = program_of(GRATING, DOTS, DISC, UniformVibration(frequency_hz=20))
    whole, dearest = costs_of_kinds(program, path(), 3, timer=priced)
    assert whole.found == ("strokes", "fills", "gratings", "vibration", "dots", COMPOSITION, BLANK)
    assert tuple(whole.kinds_us) == KINDS
    of_batch = 1 + batches_of(path())[:, 0, work.TIME]
    wanted = {kind: PRICES.get(kind, 0) * (kind in whole.found) for kind in KINDS}
    wanted |= {COMPOSITION: CALLS, BLANK: NOTHING}
    for kind, price in wanted.items():
        np.testing.assert_allclose(whole.kinds_us[kind], price * of_batch)
        np.testing.assert_allclose(dearest.kinds_us[kind], price * of_batch[3])
        assert whole.share(kind) == pytest.approx(price / sum(wanted.values()))
    np.testing.assert_allclose(whole.whole_us, sum(wanted.values()) * of_batch)
    assert whole.told_apart == pytest.approx(1)


@by_the_clock
def test_kinds_make_the_whole_within_a_tenth():
    program = program_of(GRATING, DOTS, DISC, UniformVibration(frequency_hz=20))
    sums = []
    for _ in range(TRIES):
        sums.append([each.told_apart for each in costs_of_kinds(program, path(), 3)])
        if np.abs(np.array(sums[-1]) - 1).max() < 0.1:
            break
    else:
        pytest.fail(f"shares of the whole: {sums}")


@by_the_clock
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
        # Calling the element and adding it are composition.
        own_us = sum(
            first.kinds_us[each].mean() - other.kinds_us[each].mean()
            for each in (kind, COMPOSITION)
        )
        tries.append((float(own_us), float(least[0] - least[1])))
        if own_us == pytest.approx(least[0] - least[1], rel=0.25):
            return
    pytest.fail(f"µs of {kind}: {tries}")
