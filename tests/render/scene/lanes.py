"""Where the actuators of a display are on the canvas: by `vbraille.display`, once more in numpy."""

import math

import numpy as np


def lane_places(display, x_mm, y_mm, theta_rad=0.0):
    """Places of all actuators, row by row: x and y, float64[rows · columns] each."""
    rows, columns = np.indices(display.shape).reshape(2, -1)
    right = (columns - (display.columns - 1) / 2) * display.column_pitch_mm
    down = (rows - (display.rows - 1) / 2) * display.row_pitch_mm
    cosine, sine = math.cos(theta_rad), math.sin(theta_rad)
    return x_mm + right * cosine + down * sine, y_mm + down * cosine - right * sine
