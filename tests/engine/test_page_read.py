"""A page on a simulated carriage of two axes, read by a wandering hand and decoded by a stranger.

The decoder knows where dots are meant to stand on the canvas, where the array was, and what the
actuators did. Of lines, parts and pictures it knows nothing.
"""

from dataclasses import replace

import numpy as np
import pytest

from tests.shown import LATERO
from vbraille.engine.batch import BatchEngine
from vbraille.engine.record import Flag
from vbraille.render import STRESS2, Tuning, model_of
from vbraille.simulation.simulated import SimulatedDevice
from vbraille.simulation.specs import parse_hand
from vbraille.simulation.steering import ReadPage, Steering

LINES, CELLS = 25, 5
PITCH_MM = STRESS2.style.geometry.line_pitch_mm
PLANE = {"height_mm": LINES * PITCH_MM, "turns": True}
_PLACES = {0: (0, 0), 1: (0, 1), 2: (0, 2), 3: (1, 0), 4: (1, 1), 5: (1, 2)}


def places(ticks, display):
    """Where each actuator was along x, float64[n, rows, columns]; by `vbraille.pose`."""
    right = display.column_offsets_mm() - display.span_mm / 2
    down = display.row_offsets_mm() - display.depth_mm / 2
    theta = ticks["theta_rad"][:, None, None]
    return ticks["x_mm"][:, None, None] + right * np.cos(theta) + down[:, None] * np.sin(theta)


def decoded(ticks, model):
    """Dot masks of the page, uint8[lines, cells], from poses and frames."""
    geometry, mapping = model.style.geometry, model.style.mapping
    first = model.style.rows_on(model.display).start
    at = ticks["y_mm"] / PITCH_MM
    x_mm = places(ticks, model.display)
    masks = np.zeros((LINES, CELLS), np.uint8)
    for line in range(LINES):
        on = (np.abs(at - line - 0.5) < 0.3) & (ticks["share"] == 1)
        for cell in range(CELLS):
            for bit, (side, dot_row) in _PLACES.items():
                shown = mapping.right if side else mapping.left
                row = first + shown.index(dot_row)
                centre_mm = (
                    cell * geometry.cell_pitch_mm
                    + side * geometry.dot_spacing_mm
                    + geometry.dot_width_mm / 2
                )
                over = np.abs(x_mm[on, row] - centre_mm) < geometry.dot_width_mm / 8
                assert over.any(), f"the hand missed cell {cell} of line {line}"
                felt = ticks["frame"][on, row][over]
                assert (felt > 0.5).all() or (felt == 0).all()
                masks[line, cell] |= bool(felt.max() > 0.5) << bit
    return masks


@pytest.mark.parametrize(
    ("array", "seed"), [(STRESS2.display, 1), (LATERO, 2)], ids=["stress2", "latero"]
)
def test_a_page_is_read_along_a_wandering_path_without_a_next_line(rng, array, seed):
    display = replace(array, **PLANE)
    model = model_of(display)
    model = replace(model, style=replace(model.style, tuning=Tuning(texture=0.0)))
    page = rng.integers(0, 64, (LINES, CELLS)).astype(np.uint8)
    steering = Steering()
    with SimulatedDevice(display, hand=parse_hand("fluent", seed), steering=steering) as device:
        engine = BatchEngine(device, poll_ticks=20_000)
        engine.show(model.style.render_page(list(page), display), 1)
        end_mm = model.style.geometry.extent_mm(CELLS)
        steering.give(ReadPage(LINES, PITCH_MM, end_mm))
        parts = [engine.poll()]
        while not steering.done_at(int(parts[-1]["device_ns"][-1])):
            parts.append(engine.poll())
    ticks = np.concatenate(parts)
    assert set(ticks["line"].tolist()) == {1}
    assert np.ptp(ticks["theta_rad"]) > 0.1  # it wanders, and turns
    assert np.abs(ticks["y_mm"] / PITCH_MM % 1 - 0.5).max() > 0.1
    np.testing.assert_array_equal(decoded(ticks, model), page)
    # A line is come to by a fade: no actuator moves faster than that and the hand ask for.
    assert (ticks["flags"] & int(Flag.CHANGED) != 0).sum() >= LINES
