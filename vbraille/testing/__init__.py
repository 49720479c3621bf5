"""Tools for tests of a driver or of a program on vbraille: checks, devices, hands, a clock.

`CHECKS` is what every device must do. `simulated_device` is one in memory, `simulated_controller`
one that speaks the wire protocol at a port, and `parse_hand` gives what moves either.
"""

from vbraille.engine.clock import ManualClock, RealClock
from vbraille.simulation.simulated import SimulatedDevice
from vbraille.simulation.simulator import Defect, Faults
from vbraille.simulation.specs import parse_hand
from vbraille.testing.conformance import CHECKS
from vbraille.testing.standins import simulated_controller, simulated_device

__all__ = [
    "CHECKS",
    "Defect",
    "Faults",
    "ManualClock",
    "RealClock",
    "SimulatedDevice",
    "parse_hand",
    "simulated_controller",
    "simulated_device",
]
