"""Time: the loop that reads the device, renders and writes, tick by tick."""

from vbraille.engine.clock import Clock, ManualClock, RealClock
from vbraille.engine.loop import Loop, Picture

__all__ = ["Clock", "Loop", "ManualClock", "Picture", "RealClock"]
