"""A picture that is felt on a device in memory, by the engine's own loop on a manual clock."""

import time

from tests.engine.planar import Bench
from vbraille.devices.base import Placing
from vbraille.display import Pose
from vbraille.feeling.composing import compose
from vbraille.feeling.loading import load_scene
from vbraille.reading.commands.scene import BOUND
from vbraille.reading.sceneview import SceneView
from vbraille.render import MODELS

DISPLAY = MODELS["stress2-8x8"].display
SCENE = """
title = "A house"
description = "A house and the sun."
canvas = { width_mm = 120, height_mm = 90 }

[[elements]]
kind = "circle"
id = "sun"
title = "Sun"
description = "It shines."
center_mm = [90, 20]
radius_mm = 10
stroke = { width_mm = 3 }
fill = { texture = { kind = "linear-grating", ridge_mm = 2, gap_mm = 2 } }

[[elements]]
kind = "polygon"
id = "wall"
vertices_mm = [[20, 30], [60, 30], [60, 80], [20, 80]]
stroke = { width_mm = 3 }
fill = { texture = { kind = "linear-grating", ridge_mm = 2, gap_mm = 2 } }
"""


class Felt:
    """A person who feels a file, and the device: where the finger is, what was said, the keys."""

    def __init__(
        self, path, *, display=DISPLAY, steering=None, entering=False, room=1 << 22, rate_hz=1000.0
    ):
        self.at = (10.0, 10.0)
        self.bench = Bench(lambda _: (*self.at, 0.0), display)
        self.said = []
        self.held, self.attended, self.paused, self.pointer = False, True, False, None
        self.placing, self.display = Placing.DONE, display
        self.engine, self.steering = self.bench.engine, steering
        self.style = MODELS["stress2-8x8"].style
        self.loaded = load_scene(path, self.style)
        self.feeler = SceneView(
            self.loaded,
            self,
            rate_hz=rate_hz,
            say=self.said.append,
            bound=BOUND,
            room=room,
            entering=entering,
        )
        self.feeler.start(compose(self.loaded, display, rate_hz=rate_hz))
        self.said.clear()

    @property
    def pose(self):
        """Pose of the array; None before it is known."""
        return None if self.at is None else Pose(0, *self.at)

    def press(self, *keys):
        """Press keys; what was said."""
        for key in keys:
            self.feeler.press(key)
        said, self.said[:] = list(self.said), []
        return said

    def wait(self):
        """Wait until the picture that is being made is felt; what was said of it."""
        end_s = time.monotonic() + 30.0
        while self.feeler._making is not None:
            assert time.monotonic() < end_s
            self.feeler.attend(0.0)
            time.sleep(0.001)
        return self.press()

    def be_at(self, x_mm, y_mm, now_s=0.0):
        """Have the finger come to a place; what was said."""
        self.at = (x_mm, y_mm)
        self.feeler.attend(now_s)
        return self.press()
