from importlib import metadata

import pytest

from tests.engine.test_loop import info
from vbraille.devices import open_device
from vbraille.devices.simulated import SimulatedDevice
from vbraille.errors import InputError


@pytest.mark.parametrize("spec", ["sim", "sim:", "sim:anything"])
def test_the_simulated_device_is_what_the_page_wants(spec):
    with open_device(spec, info(rows=1, columns=12)) as device:
        assert isinstance(device, SimulatedDevice)
        assert (device.info.rows, device.info.columns) == (1, 12)


@pytest.mark.parametrize("spec", ["", ":", "simulated", "/dev/ttyACM0", "serial "])
def test_an_unknown_kind_is_named_with_what_there_is(spec):
    with pytest.raises(InputError, match=r"no device kind .*there is .*sim"):
        open_device(spec, info())


def test_another_package_joins_by_an_entry_point(tmp_path, monkeypatch):
    package = tmp_path / "other-1.dist-info"
    package.mkdir()
    (package / "METADATA").write_text("Name: other\nVersion: 1\n")
    (package / "entry_points.txt").write_text("[vbraille.devices]\nother = other_driver:make\n")
    (tmp_path / "other_driver.py").write_text(
        "from dataclasses import replace\n"
        "from vbraille.devices.simulated import SimulatedDevice\n"
        "def make(address, wanted):\n"
        "    return SimulatedDevice(replace(wanted, name=address, columns=int(address[-1])))\n"
    )
    monkeypatch.syspath_prepend(str(tmp_path))
    assert metadata.entry_points(group="vbraille.devices", name="other")
    with open_device("other:bench8", info(columns=8)) as device:
        assert device.info.name == "bench8"
    with pytest.raises(InputError, match=r"bench8 has 6 × 8 .*page is for 6 × 10"):
        open_device("other:bench8", info())
