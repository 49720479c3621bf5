"""A frame out, a carriage sample in: the devices, and the interface they keep."""

from vbraille.devices.base import Device, DeviceInfo, Sample
from vbraille.devices.registry import open_device, opened_device

__all__ = ["Device", "DeviceInfo", "Sample", "open_device", "opened_device"]
