"""A page on a simulated carriage of two axes, read by a wandering hand and decoded by a stranger.

The decoder knows where dots are meant to stand on the canvas, where the array was, and what the
actuators did. Of lines, parts and pictures it knows nothing.
"""

from dataclasses import replace

import numpy as np
import pytest

from tests.tiers import heavy
from vbraille.engine.batch import BatchEngine
from vbraille.engine.record import Flag
from vbraille.render import LATERO, STRESS2, STRESS2_8X8, Tuning
from vbraille.simulation.simulated import SimulatedDevice
from vbraille.simulation.specs import parse_hand
from vbraille.simulation.steering import ReadPage, Steering

LINES, CELLS = 25, 5
LARGE = 25, 40
_PLACES = {0: (0, 0), 1: (0, 1), 2: (0, 2), 3: (1, 0), 4: (1, 1), 5: (1, 2)}


def places(ticks, display):
    """Where each actuator was along x, float64[n, rows, columns]; by `vbraille.display`."""
    right = display.column_offsets_mm() - display.span_mm / 2
    down = display.row_offsets_mm() - display.depth_mm / 2
    theta = ticks["theta_rad"][:, None, None]
    return ticks["x_mm"][:, None, None] + right * np.cos(theta) + down[:, None] * np.sin(theta)


def over_dots(ticks, model, size):
    """Yield what was felt at the place of each dot of a page.

    For each line and dot of a cell: line, dot from 0, the cells that an actuator of its row was
    over, int[n], and what that actuator did then, float[n].
    """
    lines, cells = size
    geometry, mapping = model.style.geometry, model.style.mapping
    first = model.style.rows_on(model.display).start
    at = ticks["y_mm"] / geometry.line_pitch_mm
    for line in range(lines):
        on = ticks[np.abs(at - line - 0.5) < 0.3]
        x_mm = places(on, model.display)
        for bit, (side, dot_row) in _PLACES.items():
            row = first + (mapping.right if side else mapping.left).index(dot_row)
            first_mm = side * geometry.dot_spacing_mm + geometry.dot_width_mm / 2
            pitches = (x_mm[:, row] - first_mm) / geometry.cell_pitch_mm
            cell = np.rint(pitches).astype(int)
            off_mm = np.abs(pitches - cell) * geometry.cell_pitch_mm
            over = (off_mm < geometry.dot_width_mm / 8) & (cell >= 0) & (cell < cells)
            yield line, bit, cell[over], on["frame"][:, row][over]


def decoded(ticks, model, size):
    """Dot masks of the page, uint8[lines, cells], from poses and frames."""
    masks = np.zeros(size, np.uint8)
    for line, bit, cell, felt in over_dots(ticks[ticks["share"] == 1], model, size):
        assert ((felt > 0.5) | (felt == 0)).all()
        raised = np.bincount(cell[felt > 0.5], minlength=size[1])
        flat = np.bincount(cell[felt == 0], minlength=size[1])
        assert ((raised > 0) != (flat > 0)).all(), f"missed a cell of line {line}, or felt two"
        masks[line] |= ((raised > 0) << bit).astype(np.uint8)
    return masks


@pytest.mark.parametrize(
    ("model", "size", "seed"),
    [
        (STRESS2, (LINES, CELLS), 1),
        pytest.param(STRESS2_8X8, LARGE, 3, marks=heavy),
        pytest.param(LATERO, LARGE, 2, marks=heavy),
    ],
    ids=["stress2", "stress2-8x8", "latero"],
)
def test_a_page_is_read_along_a_wandering_path_without_a_next_line(rng, model, size, seed):
    ticks, page, model = felt_of("fluent", rng, model, size, seed)
    lines, pitch_mm = size[0], model.style.geometry.line_pitch_mm
    assert np.ptp(ticks["theta_rad"]) > 0.1  # it wanders, and turns
    assert np.abs(ticks["y_mm"] / pitch_mm % 1 - 0.5).max() > 0.1
    np.testing.assert_array_equal(decoded(ticks, model, size), page)
    # A line is come to by a fade: no actuator moves faster than that and the hand ask for.
    assert (ticks["flags"] & int(Flag.CHANGED) != 0).sum() >= lines


@pytest.mark.parametrize(
    ("model", "size", "seed"),
    [
        (STRESS2, (LINES, CELLS), 4),
        pytest.param(STRESS2_8X8, LARGE, 5, marks=heavy),
        pytest.param(LATERO, LARGE, 6, marks=heavy),
    ],
    ids=["stress2", "stress2-8x8", "latero"],
)
def test_every_dot_that_a_hand_crosses_going_all_about_a_page_is_right(rng, model, size, seed):
    ticks, page, model = felt_of("wander:60", rng, model, size, seed)
    shown = (ticks["share"] == 1) & (ticks["flags"] & int(Flag.RESTING) == 0)
    crossed = 0
    for line, bit, cell, felt in over_dots(ticks[shown], model, size):
        assert ((felt > 0.5) == (page[line, cell] >> bit & 1 == 1)).all(), (line, bit)
        crossed += np.unique(cell).size
    assert crossed > 6 * page.size / 4


def felt_of(hand, rng, model, size, seed):
    """What a hand feels of a page without texture: ticks, the page's masks, and the model."""
    lines, cells = size
    geometry = model.style.geometry
    pitch_mm, end_mm = geometry.line_pitch_mm, geometry.extent_mm(cells)
    room = {"height_mm": lines * pitch_mm, "travel_mm": end_mm + 20.0, "turns": True}
    display = replace(model.display, **room)
    model = replace(model, style=replace(model.style, tuning=Tuning(texture=0.0)))
    page = rng.integers(0, 64, size).astype(np.uint8)
    steering = Steering()
    with SimulatedDevice(display, hand=parse_hand(hand, seed), steering=steering) as device:
        engine = BatchEngine(device, poll_ticks=20_000)
        engine.show(model.style.render_page(list(page), display), 1)
        steering.give(ReadPage(lines, pitch_mm, end_mm))
        parts = [engine.poll()]
        while not steering.done_at(int(parts[-1]["device_ns"][-1])):
            parts.append(engine.poll())
    ticks = np.concatenate(parts)
    assert set(ticks["line"].tolist()) == {1}
    return ticks, page, replace(model, display=display)
