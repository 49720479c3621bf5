"""A driver of another package: a device in memory that logs its frames and can break."""

import os
from pathlib import Path

_MODULE = '''
import os
import numpy as np
from vbraille.devices.events import Notice
from vbraille.simulation.hand import Sweep
from vbraille.simulation.simulated import SimulatedDevice
from vbraille.errors import DeviceError

class Logged(SimulatedDevice):
    """Writes every frame to a file; can break."""

    def __init__(self, address, wanted):
        super().__init__(wanted, hand=Sweep(150.0))
        path, _, self.fault = address.partition(",")
        self.log = open(path, "wb", buffering=0)
        self.risen = False  # the first line has faded in, however late it came

    def read(self):
        if self.frames >= 300 and self.fault == "gone":
            raise DeviceError("the device is gone")
        if self.frames >= 300 and self.risen:
            if self.fault.isdigit():
                fault, self.fault = int(self.fault), ""
                os.kill(os.getppid(), fault)
            if self.fault == "bug":
                raise ZeroDivisionError("a bug")
        return super().read()

    def _send(self, frame):
        if self.frames >= 300 and self.fault == "gone":
            raise DeviceError("the device is gone")
        super()._send(frame)
        self.risen |= frame.max() == 1.0
        self.log.write(frame.tobytes())

    def _release(self):
        super()._release()
        if self.fault == "jammed":
            raise OSError("the lock is jammed")

    def take_events(self):
        return [Notice(255, "three hundred frames")] if self.frames == 300 else []

    def counts(self):
        return {"frames": self.frames}
'''


def install(
    folder: Path, name: str = "logged", opener: str = "Logged", module: str = _MODULE
) -> dict[str, str]:
    """Install it there as a device kind of its name; the environment of programs that know it."""
    package = folder / f"{name}-1.dist-info"
    package.mkdir()
    (package / "METADATA").write_text(f"Name: {name}\nVersion: 1\n")
    (package / "entry_points.txt").write_text(f"[vbraille.devices]\n{name} = {name}:{opener}\n")
    (folder / f"{name}.py").write_text(module)
    return {**os.environ, "PYTHONPATH": str(folder)}
