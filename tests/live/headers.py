"""The headers of frames and maps as a page reads them, each number by its name."""

import numpy as np

# The header of a frame, in the order of an Intel processor. After it come the deflections,
# float32[rows, columns], and the samples, float32[samples, 3]: seconds before this tick, place of
# the array's centre in mm, and deflection of the actuator that the page follows.
FRAME = np.dtype(
    [
        ("kind", "u1"),  # FRAME_KIND
        ("version", "u1"),  # VERSION
        ("samples", "<u2"),  # number of samples
        ("flags", "<u4"),  # bits of `vbraille.engine.record.Flag`
        ("state", "<u4"),  # number of the state that the frame belongs to
        ("line", "<u4"),  # number of what is under the hand; 0 before the first
        ("part", "<u4"),  # which part of the picture is shown
        ("late", "<u4"),  # deadlines missed so far
        ("tick", "<f8"),  # number of the tick, from 0
        ("time_s", "<f8"),  # when the tick woke; in a recording, seconds from its start
        ("x_mm", "<f4"),  # the array's centre on the canvas; NaN where it is not known
        ("y_mm", "<f4"),
        ("theta_rad", "<f4"),
        ("vx_mm_s", "<f4"),  # the hand's velocity along x
        ("lateness_us", "<f4"),  # from the deadline to the waking
        ("work_us", "<f4"),  # from waking until the frame was written
        ("share", "<f4"),  # how much of a change has faded in: 1 is all
        ("age_ms", "<f4"),  # from the tick until the frame was sent; 0 in a recording
        ("rows", "<u2"),  # shape of the deflections; 0 × 0 where they are not shown
        ("columns", "<u2"),
        ("signals", "<u4"),  # number of the picture's signals
    ]
)
# The header of a map; after it come the bytes of a file.
MAP = np.dtype([("kind", "u1"), ("svg", "u1"), ("reserved", "<u2"), ("bytes", "<u4")])
