"""Devices by their specs."""

from importlib.metadata import EntryPoint

import pytest

from vbraille.devices import Device, open_device
from vbraille.devices.registry import check_actuators, drivers
from vbraille.errors import DeviceError, InputError
from vbraille.render import MODELS


def opens(address, _wanted):
    """A driver of another package."""
    if address == "nothing":
        return None
    if address == "bug":
        raise RuntimeError("no such luck")
    host, port = address.split(":")
    return (host, int(port))


@pytest.fixture
def other(monkeypatch):
    """Another package's driver, as `other:ADDRESS`."""
    point = EntryPoint("other", f"{__name__}:opens", "vbraille.devices")
    monkeypatch.setattr("vbraille.devices.registry.find_driver", lambda _: point)


@pytest.mark.usefixtures("other")
@pytest.mark.parametrize("spec", ["other:host", "other:host:x", "other:"])
def test_a_mistyped_address_is_no_fault_of_the_drivers_author(spec):
    with pytest.raises(DeviceError) as caught:
        open_device(spec, None)
    assert "author" not in str(caught.value)
    assert "address" in str(caught.value)


@pytest.mark.usefixtures("other")
@pytest.mark.parametrize("spec", ["other:bug", "other:nothing"])
def test_a_fault_of_a_driver_names_it(spec):
    with pytest.raises(DeviceError, match=r"other .*author"):
        open_device(spec, None)


def test_known_kinds_are_named():
    kinds = [name for name, _ in drivers()]
    assert {"latero", "serial", "sim"} <= set(kinds)
    with pytest.raises(InputError, match="serial"):
        open_device("nothing:x", None)


def test_another_array_is_refused():
    with pytest.raises(InputError, match="6 × 10"):
        check_actuators(MODELS["stress2"].display, MODELS["vbd"].display)
    with open_device("sim", MODELS["vbd"].display) as device:
        assert isinstance(device, Device)
