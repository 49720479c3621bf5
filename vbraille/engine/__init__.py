"""Time: the loop that reads the device, renders and writes, tick by tick."""

from vbraille.engine.clock import Clock, ManualClock, RealClock
from vbraille.engine.engine import Engine, LocalEngine
from vbraille.engine.loop import Loop, Picture
from vbraille.engine.tally import Tally

__all__ = [
    "Clock",
    "Engine",
    "LocalEngine",
    "Loop",
    "ManualClock",
    "Picture",
    "RealClock",
    "Tally",
]
