"""Reads a line back from what the fingertip was given.

It knows the device and where dots are meant to stand on the surface, as a reader does; of the line
itself, of masks and of gains it knows nothing.
"""

import numpy as np

# Bit of the mask by dot row and dot column, 0 the left one.
_BITS = {(0, 0): 0, (1, 0): 1, (2, 0): 2, (0, 1): 3, (1, 1): 4, (2, 1): 5, (3, 0): 6, (3, 1): 7}


def read_back(frames, x_mm, *, array, mapping, geometry):
    """Every cell that the hand went over.

    Parameters
    ----------
    frames : float[n, rows, columns]
        What the actuators did.
    x_mm : float64[n]
        Where the array's centre was at each frame.
    array, mapping, geometry
        What the frames were felt with.

    Returns
    -------
    uint8[cells]
        Dot masks.

    Raises
    ------
    ValueError
        If actuators that show the same dot disagree, or the hand missed a dot.
    """
    idle = np.zeros(array.rows)
    first = (array.rows - mapping.rows) // 2
    idle[first : first + mapping.rows] = mapping.inverted
    swings = (frames - idle[:, None]) * (1 - 2 * idle)[:, None]
    raised = swings > swings.max() / 2
    surface = (x_mm - array.span_mm / 2)[:, None] + array.column_offsets_mm()
    radius = geometry.dot_width_mm / 2
    reach = surface.max() - geometry.dot_spacing_mm - geometry.dot_width_mm
    masks = np.zeros(1 + int(reach // geometry.cell_pitch_mm), np.uint8)
    for number in range(masks.size):
        for side, table in enumerate((mapping.left, mapping.right)):
            left_edge = number * geometry.cell_pitch_mm + side * geometry.dot_spacing_mm
            over = np.abs(surface - left_edge - radius) < radius
            if not over.any():
                raise ValueError(f"the hand missed dot column {side} of cell {number}")
            felt = {}
            for row, dot_row in enumerate(table, first):
                if dot_row >= 0:
                    felt.setdefault(dot_row, set()).add(bool(raised[:, row][over].any()))
            for dot_row, answers in felt.items():
                if len(answers) > 1:
                    raise ValueError(f"rows disagree on dot row {dot_row} of cell {number}")
                if answers == {True}:
                    masks[number] |= 1 << _BITS[dot_row, side]
    return masks
