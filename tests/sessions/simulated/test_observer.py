"""The simulated reader reads what it is given, less of it when it is weak, and nothing else."""

from dataclasses import replace
from itertools import permutations

import numpy as np
import pytest

from tests.render.scenes import JIT
from vbraille.render import (
    MAPPINGS,
    STRESS2,
    VBD,
    BrailleStyle,
    Tuning,
    single_row,
)
from vbraille.sessions.planning.questions import Which
from vbraille.sessions.simulated.feeling import FeltTrial
from vbraille.sessions.simulated.observer import LEAST_FELT, FeltFrames, Observer
from vbraille.simulation.specs import parse_hand

MARGIN_MM = 2.0
WAYS = [(STRESS2, mapping) for mapping in MAPPINGS.values() if mapping.rows <= 6]
WAYS += [(VBD, single_row(dot_row)) for dot_row in (1, 2, 3)]
# Without compiled kernels a slow hand's ticks take too long.
HANDS = ["sweep:20", "sweep:73", "sweep:200", "device", "fluent"] if JIT else ["sweep:200"]
QUICK = "sweep:73" if JIT else "sweep:200"
NAMES = [f"{model.name}-{mapping.name}" for model, mapping in WAYS]


def moved(model, hand, cells, *, seed=1, late_s=(), kept=None, geometry=None):
    """Times and places of a hand's ticks at 1 kHz, each so much too late, or some of them lost."""
    line_mm = (geometry or model.style.geometry).extent_mm(cells)
    start_mm = -model.display.span_mm - MARGIN_MM
    motion = parse_hand(hand, seed).read_line(start_mm, line_mm + MARGIN_MM)
    time_s = np.arange(0, motion.duration_s, 1e-3)
    if len(late_s):
        time_s = np.sort(time_s + np.resize(late_s, time_s.size))
    if kept is not None:
        time_s = time_s[np.resize(kept, time_s.size)]
    return time_s, np.interp(time_s, motion.t_s, motion.x_mm)


def explored(model, mapping, masks, time_s, x_mm, *, count_mm=None, levels=None, **changes):
    """What a hand is given of a line, through an encoder and a device of so many levels."""
    geometry = changes.pop("geometry", model.style.geometry)
    style = BrailleStyle(model.style.profile, mapping, geometry, Tuning(**changes))
    renderer = style.render(np.array(masks, np.uint8), model.display)
    if count_mm:
        x_mm = np.round(x_mm / count_mm) * count_mm
    frames = renderer.path(x_mm)
    if levels:
        frames = (np.round(frames * (levels - 1)) / (levels - 1)).astype(np.float32)
    return FeltFrames(frames, x_mm, time_s)


def faded_in(exploration, fade_s=0.1):
    share = np.clip(exploration.time_s / fade_s, 0, 1).astype(np.float32)
    return replace(exploration, frames=exploration.frames * share[:, None, None])


def drawn(rng, mapping, cells=4):
    """Cells of which one has all dots that the mapping shows."""
    masks = rng.integers(0, 64, cells)
    masks[rng.integers(cells)] = 63
    return [int(mask) for mask in masks & mapping.shown_dots()]


def of(model, mapping, **changes):
    return Observer(model.display, replace(model.style, mapping=mapping), **changes)


@pytest.mark.no_cover
@pytest.mark.parametrize("hand", HANDS)
@pytest.mark.parametrize(("model", "mapping"), WAYS, ids=NAMES)
def test_without_noise_every_string_is_read_right(model, mapping, hand, rng):
    seed = int(rng.integers(1000))
    for texture, contrast in ((rng.choice([0, 0.25, 1]), 1.0), (rng.random(), 0.05)):
        masks = drawn(rng, mapping)
        path = moved(model, hand, 4, seed=seed)
        given = explored(model, mapping, masks, *path, texture=texture, contrast=contrast)
        assert read(of(model, mapping), given, 4, rng) == masks


@pytest.mark.parametrize("texture", [0.0, 1.0])
@pytest.mark.parametrize(("levels", "count_mm"), [(256, 0.045), (512, 0.013), (1024, 0.005)])
@pytest.mark.parametrize(("model", "mapping"), [WAYS[0], WAYS[2], WAYS[6]])
def test_through_levels_counts_a_fade_and_late_ticks(
    model, mapping, levels, count_mm, texture, rng
):
    for hand, contrast in ((QUICK, 1.0), ("sweep:200", 0.05)):
        masks = drawn(rng, mapping)
        path = moved(model, hand, 4, late_s=rng.exponential(1e-4, 997), kept=rng.random(997) > 0.02)
        given = explored(
            model,
            mapping,
            masks,
            *path,
            levels=levels,
            count_mm=count_mm,
            texture=texture,
            contrast=contrast,
        )
        assert read(of(model, mapping), faded_in(given), 4, rng) == masks


def test_it_reads_the_frames_and_nothing_else(rng):
    path = moved(STRESS2, QUICK, 4)
    strings = [drawn(rng, STRESS2.style.mapping) for _ in range(3)]
    given = [
        explored(STRESS2, STRESS2.style.mapping, masks, *path, texture=0.5) for masks in strings
    ]
    observer = of(STRESS2, STRESS2.style.mapping)
    assert [read(observer, one, 4, rng) for one in given] == strings
    swapped = FeltFrames(given[1].frames, given[0].x_mm, given[0].time_s)
    assert read(observer, swapped, 4, rng) == strings[1]
    assert strings[0] != strings[1]


def test_dots_off_the_mapping_and_blank_cells(rng):
    given = explored(VBD, single_row(2), [255, 0, 0b10010, 0b101], *moved(VBD, QUICK, 4))
    observer = of(VBD, single_row(2))
    assert read(observer, given, 4, rng) == [0b10010, 0, 0b10010, 0]
    evidence = observer.felt(given, 4)
    assert np.isnan(evidence[:, [0, 2, 3, 5, 6, 7]]).all()
    assert not evidence[[1, 3]][:, [1, 4]].any()


def test_a_hand_that_turns_round_and_stops_in_the_middle(rng):
    masks = drawn(rng, STRESS2.style.mapping)
    knots = [(0, -14), (0.3, 16), (0.6, 16), (0.9, -6), (1.2, 20), (1.5, 8), (2.0, 48)]
    knots_s, knots_mm = np.array(knots, float).T
    time_s = np.arange(0, 2.0, 1e-3)
    x_mm = np.interp(time_s, knots_s, knots_mm)
    given = explored(STRESS2, STRESS2.style.mapping, masks, time_s, x_mm)
    assert read(of(STRESS2, STRESS2.style.mapping), faded_in(given), 4, rng) == masks


def test_evidence_is_in_proportion_to_contrast_and_near_1_for_a_plain_dot():
    path = moved(STRESS2, "sweep:73", 1)
    observer = of(STRESS2, STRESS2.style.mapping)
    touches = [
        observer.felt(explored(STRESS2, STRESS2.style.mapping, [1], *path, contrast=contrast), 1)
        for contrast in (1.0, 0.3)
    ]
    one, third = (touch[0, 0] for touch in touches)
    assert one == pytest.approx(1, abs=0.05)
    assert third == pytest.approx(0.3 * one, rel=1e-4)


@pytest.mark.no_cover
def test_legibility_falls_with_contrast(rng):
    observer = of(VBD, VBD.style.mapping, noise=0.12)
    path = moved(VBD, "sweep:100", 4)
    strings = [[9, left, right, 9] for left in (0, 1, 8, 9) for right in (0, 1, 8, 9)]
    right = []
    for contrast in (1.0, 0.6, 0.4, 0.25, 0.1):
        told = []
        for masks in strings:
            given = explored(VBD, VBD.style.mapping, masks, *path, contrast=contrast)
            touch = observer.felt(given, 4)
            told += [np.equal(observer.answer(touch, rng), masks)[1:3].all() for _ in range(15)]
        right.append(np.mean(told))
    assert right[0] > 0.95
    assert right == sorted(right, reverse=True)
    assert min(-np.diff(right)) > 0.03
    assert right[-1] < 0.25  # chance is 1/16


def test_nothing_felt_is_no_answer(rng):
    path = moved(VBD, "sweep:200", 3)
    blind = of(VBD, VBD.style.mapping, noise=0.2)
    without = explored(VBD, VBD.style.mapping, [9, 9, 9], *path, contrast=0.0)
    assert read(blind, without, 3, rng) == [None] * 3
    assert not (blind.felt(without, 3) > LEAST_FELT).any()
    never = FeltFrames(without.frames, np.full(without.x_mm.shape, np.nan), without.time_s)
    assert np.isnan(blind.felt(never, 3)).all()
    assert read(blind, never, 3, rng) == [None] * 3


def test_where_the_hand_never_was_there_is_no_answer(rng):
    given = explored(VBD, VBD.style.mapping, [9, 1, 9], *moved(VBD, "sweep:100", 3))
    near = given.within(-np.inf, 12.0)
    observer = of(VBD, VBD.style.mapping)
    assert read(observer, near, 3, rng) == [9, 1, None]
    assert np.isnan(observer.felt(near, 3)[2]).all()


WIDTHS_MM = [0.5, 1.0, 1.5, 2.0, 2.5, 3.0]
GAPS_MM = [1.0, 1.3, 1.6, 1.9, 2.2, 2.5]


def stimuli(parameter, hand):
    """Explorations of every value of a parameter."""
    for value_mm in WIDTHS_MM if parameter == "dot_width_mm" else GAPS_MM:
        if parameter == "dot_width_mm":
            masks, geometry = [1], replace(VBD.style.geometry, dot_width_mm=value_mm)
        else:
            masks, geometry = [9], replace(VBD.style.geometry, dot_spacing_mm=2.0 + value_mm)
        path = moved(VBD, hand, 1, geometry=geometry)
        yield (
            value_mm,
            explored(VBD, VBD.style.mapping, masks, *path, geometry=geometry, texture=1.0),
        )


def read(observer, given, places, rng):
    return observer.answer(observer.felt(given, places), rng)


def compare(observer, first, second, parameter, rng):
    """Choose which of two is nearer to the nominal length, as the reader of sessions does."""
    felt = FeltTrial(observer, rng, [first, second], [1, 1], slice(0, 1), parameter)
    return int(Which().simulate(felt))


@pytest.mark.parametrize("hand", ["sweep:20", "device", "fluent"] if JIT else ["sweep:40"])
@pytest.mark.parametrize("parameter", ["dot_width_mm", "dot_gap_mm"])
def test_the_nearer_to_nominal_is_chosen_the_first_of_ties(parameter, hand, rng):
    observer = of(VBD, VBD.style.mapping)
    for (first_mm, first), (second_mm, second) in permutations(stimuli(parameter, hand), 2):
        off_mm = round(abs(first_mm - 2), 3), round(abs(second_mm - 2), 3)
        wanted = 1 if off_mm[0] <= off_mm[1] else 2
        assert compare(observer, first, second, parameter, rng) == wanted, (first_mm, second_mm)


def test_comparing_errs_with_noise_and_knows_what_was_not_felt(rng):
    widths = dict(stimuli("dot_width_mm", "sweep:100"))
    unsure = of(VBD, VBD.style.mapping, noise=0.2)
    near = [compare(unsure, widths[2.0], widths[2.5], "dot_width_mm", rng) for _ in range(40)]
    far = [compare(unsure, widths[2.0], widths[0.5], "dot_width_mm", rng) for _ in range(40)]
    assert 40 > near.count(1) > 20
    assert far.count(1) > near.count(1)
    rest = replace(widths[2.0], frames=np.zeros_like(widths[2.0].frames))
    sure = of(VBD, VBD.style.mapping)
    assert compare(sure, rest, widths[0.5], "dot_width_mm", rng) == 2
    assert compare(sure, widths[0.5], rest, "dot_width_mm", rng) == 1
    assert compare(sure, rest, rest, "dot_width_mm", rng) == 1
    assert compare(sure, widths[2.0], widths[2.0], "dot_gap_mm", rng) == 1
    none = rest.within(1e6, 2e6)
    assert compare(sure, none, widths[3.0], "dot_width_mm", rng) == 2
