"""Recordings and sessions that earlier versions wrote, and what is played of them."""

from pathlib import Path

import numpy as np
import pytest

from tests.tiers import heavy
from vbraille.live.messages import FRAME, Next

WRITTEN = Path(__file__).parent.parent / "written-by"
RECORDINGS = sorted(WRITTEN.glob("*/recordings/*.h5"))
SESSIONS = sorted(path for path in WRITTEN.glob("*/sessions/*") if any(path.glob("trace-*.gz")))
ON_PAPER = sorted(path for path in WRITTEN.glob("*/sessions/*") if not any(path.glob("trace-*")))
# One of each kind that differs in what has to be done; the others are as these.
_ALWAYS = (
    "0.1.0-2026-11-21/recordings/vbd-row-1.h5",
    "0.1.0-2026-11-22/recordings/stress2-row-sheared.h5",
    "0.1.0-2026-11-21/sessions/words-host-died",
    "0.1.0-2026-11-22-format-3/sessions/words-host-died",
    "0.1.0-2026-11-22/sessions/letters-stopped",
)


def each(paths):
    """Paths as parameters of tests; some of them for the heavier tiers alone."""
    names = [str(path.relative_to(WRITTEN)) for path in paths]
    return [
        pytest.param(path, id=name, marks=() if name in _ALWAYS else heavy)
        for path, name in zip(paths, names, strict=True)
    ]


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
