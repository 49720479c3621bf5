"""Recordings of lines and pages, and what is played of them."""

from dataclasses import replace
from functools import cache
from pathlib import Path
from tempfile import mkdtemp

import numpy as np

from tests.live.headers import FRAME
from vbraille.live.messages import Next
from vbraille.newfile import new_file
from vbraille.recording import Recorder
from vbraille.render import MAPPINGS, STRESS2, VBD, single_row

LINES = [np.array(cells, np.uint8) for cells in ([1, 3, 9], [63], [5, 8, 1, 2], [0, 7])]
MODELS = {
    "stress2-alternate": (STRESS2, MAPPINGS["alternate"]),
    "stress2-compact": (STRESS2, MAPPINGS["compact"]),
    "stress2-row-sheared": (STRESS2, MAPPINGS["sheared"]),
    "vbd-row-1": (VBD, single_row(1)),
    "vbd-row-3": (VBD, single_row(3)),
}


def record(path, lines, x_mm, *, pages=False, rate_hz=1000.0, model=STRESS2):
    """Write a recording of lines that are read one after the other, or of two pages of them."""
    style, display = model.style, model.display
    with new_file(path) as file:
        recorder = Recorder(file, display, 4)
        recorder.describe(model=model, rate_hz=rate_hz, first_line=7, source="a.txt", sha256="0")
        done = 0
        for masks in lines if not pages else (lines[:2], lines[2:]):
            t_s = (done + np.arange(x_mm.size)) / rate_hz
            if pages:
                rows = [recorder.add_line(line) for line in masks]
                program = style.render_page(masks, display)
                y_mm = np.linspace(-5, 14 * len(masks) + 5, x_mm.size)
                part, frames = program.poses(x_mm, y_mm)
                at = rows[0] + np.clip(part, 0, len(masks) - 1)
                recorder.add_frames(t_s, x_mm, at, frames, y_mm=y_mm, part=part)
            else:
                row = recorder.add_line(masks)
                frames = style.render(masks, display).path(x_mm)
                recorder.add_frames(t_s, x_mm, row, frames, y_mm=7.0)
            done += x_mm.size
    return path


@cache
def recorded(name="stress2-alternate"):
    """Give the file of a recording by one of `MODELS`, which no test may change."""
    model, mapping = MODELS[name]
    model = replace(model, style=replace(model.style, mapping=mapping))
    path = Path(mkdtemp(prefix="vbraille-recording-")) / f"{name}.h5"
    return record(path, LINES, np.linspace(-12, 60, 700), model=model)


def asked(viewer, at_s, since_s=None, **more):
    """Header, deflections and samples that a viewer gives."""
    made = viewer.frame(Next(at_s=at_s, since_s=since_s, **more))
    header = np.frombuffer(made, FRAME, 1)[0]
    shape = int(header["rows"]), int(header["columns"])
    after = FRAME.itemsize + 4 * shape[0] * shape[1]
    frame = np.frombuffer(made[FRAME.itemsize : after], np.float32).reshape(shape)
    samples = np.frombuffer(made[after:], np.float32).reshape(-1, 3)
    assert len(samples) == header["samples"]
    return header, frame, samples
