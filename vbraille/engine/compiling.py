"""Compile all that a reading calls, so that the first one does not wait for it.

python -m vbraille.engine.compiling
"""

from __future__ import annotations

import numpy as np

from vbraille.engine import shared
from vbraille.engine.hosted import warm_up
from vbraille.render import MODELS
from vbraille.sessions.record.replay import Replay
from vbraille.sessions.record.traces import TRACE


def main() -> None:
    """Compile the tick, the frames of `render`, and those of a replay."""
    for model in MODELS.values():
        display, style = model.display, model.style
        warm_up(display, shared.Extent(display.rows, display.columns, 0, 2))
        line = style.render(np.zeros(1, np.uint8), display)
        line.path(np.zeros(1))
        line.poses(np.zeros(1), np.zeros(1))
        line.frame(0.0, np.zeros(display.shape))
        Replay(lambda _, line=line: line, display).frames(np.zeros(1, TRACE))


if __name__ == "__main__":
    main()
