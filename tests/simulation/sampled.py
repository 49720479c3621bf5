"""Places of a motion at the ticks of a clock."""

import numpy as np

from vbraille.simulation.motion import SLACK


def sampled(motion, rate_hz):
    """Places along x at multiples of 1 / rate, up to the end; float64[n], mm."""
    stop = 1 + int(motion.duration_s * rate_hz + SLACK)
    return np.interp(np.arange(stop) / rate_hz, motion.t_s, motion.x_mm)
