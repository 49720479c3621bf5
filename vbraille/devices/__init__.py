"""A frame out, a pose of the carriage in: the devices, and the interface they keep."""

from vbraille.devices.base import Device
from vbraille.devices.registry import open_device, opened_device
from vbraille.display import Display, Pose

__all__ = ["Device", "Display", "Pose", "open_device", "opened_device"]
