import sys
from importlib import metadata

import pytest

from tests.engine.test_loop import info
from vbraille.devices import open_device
from vbraille.errors import InputError
from vbraille.simulation.simulated import SimulatedDevice


@pytest.mark.parametrize("spec", ["sim", "sim:", "sim:?hand=device"])
def test_the_simulated_device_is_what_the_page_wants(spec):
    with open_device(spec, info(rows=1, columns=12)) as device:
        assert isinstance(device, SimulatedDevice)
        assert (device.display.rows, device.display.columns) == (1, 12)


@pytest.mark.parametrize("spec", ["", ":", "simulated", "/dev/ttyACM0", "serial "])
def test_an_unknown_kind_is_named_with_what_there_is(spec):
    with pytest.raises(InputError, match=r"no device kind .*there are .*serial, sim"):
        open_device(spec, info())


def test_another_package_joins_by_an_entry_point(tmp_path, monkeypatch):
    package = tmp_path / "other-1.dist-info"
    package.mkdir()
    (package / "METADATA").write_text("Name: other\nVersion: 1\n")
    (package / "entry_points.txt").write_text("[vbraille.devices]\nother = other_driver:make\n")
    (tmp_path / "other_driver.py").write_text(
        "from dataclasses import replace\n"
        "from vbraille.simulation.simulated import SimulatedDevice\n"
        "def make(address, wanted):\n"
        "    columns = int(address[-1])\n"
        "    made = replace(wanted, name=address, columns=columns, rate_hz=1000.0)\n"
        "    return SimulatedDevice(made)\n"
    )
    monkeypatch.syspath_prepend(str(tmp_path))
    assert metadata.entry_points(group="vbraille.devices", name="other")
    with open_device("other:bench8", info(columns=8)) as device:
        assert device.display.name == "bench8"
    with pytest.raises(InputError, match=r"bench8 has 6 × 8 .*page is for 6 × 10"):
        open_device("other:bench8", info())
    with open_device("other:bench8", info(), fits=False) as device:  # what is wanted is a wish
        assert device.display.columns == 8
    with pytest.raises(InputError, match="made for 1000 frames a second and 2000 are"):
        open_device("other:bench8", info(rate_hz=2000), fits=False)
    with open_device("other:bench8", info(rate_hz=2000), fits=False, often=False) as device:
        assert device.display.rate_hz == 1000


OTHER = (
    "from dataclasses import replace\n"
    "from vbraille.simulation.simulated import SimulatedDevice\n"
    "class Device(SimulatedDevice):\n"
    "    closed = 0\n"
    "    def _release(self):\n"
    "        Device.closed += 1\n"
    "def make(address, wanted):\n"
    "    name, value = address.split('=')\n"
    "    return Device(replace(wanted, **{name: float(value)}))\n"
)


@pytest.mark.parametrize(
    ("address", "changes", "sentence"),
    [
        ("column_pitch_mm=1.213", {}, "columns of test are 1.213 mm apart .* page is for 1.2 mm"),
        ("row_pitch_mm=1.78", {}, "rows of test are 1.78 mm apart .* page is for 1.8 mm"),
        ("rate_hz=500", {}, "made for 500 frames a second and 1000 are .* ‹rate› 500 or less"),
        ("column_pitch_mm=1.211", {}, None),
        ("column_pitch_mm=9", {"columns": 1}, None),
        ("row_pitch_mm=9", {"rows": 1}, None),
        ("rate_hz=1001", {}, None),
    ],
)
def test_a_device_that_does_not_fit_is_refused_and_closed(
    tmp_path, monkeypatch, address, changes, sentence
):
    package = tmp_path / "fitting-1.dist-info"
    package.mkdir()
    (package / "METADATA").write_text("Name: fitting\nVersion: 1\n")
    (package / "entry_points.txt").write_text("[vbraille.devices]\nfit = fitting_driver:make\n")
    (tmp_path / "fitting_driver.py").write_text(OTHER)
    monkeypatch.syspath_prepend(str(tmp_path))
    monkeypatch.delitem(sys.modules, "fitting_driver", raising=False)
    if sentence is None:
        open_device(f"fit:{address}", info(**changes)).close()
    else:
        with pytest.raises(InputError, match=sentence):
            open_device(f"fit:{address}", info(**changes))
    assert sys.modules["fitting_driver"].Device.closed == 1
    sys.modules.pop("fitting_driver")


def test_any_device_will_do_where_none_is_wanted(tmp_path, monkeypatch):
    package = tmp_path / "any-1.dist-info"
    package.mkdir()
    (package / "METADATA").write_text("Name: any\nVersion: 1\n")
    (package / "entry_points.txt").write_text("[vbraille.devices]\nany = any_driver:make\n")
    (tmp_path / "any_driver.py").write_text(
        "from tests.engine.test_loop import info\n"
        "from vbraille.simulation.simulated import SimulatedDevice\n"
        "def make(address, wanted):\n"
        "    assert wanted is None\n"
        "    return SimulatedDevice(info(columns=3))\n"
    )
    monkeypatch.syspath_prepend(str(tmp_path))
    with open_device("any:", None) as device:
        assert device.display.columns == 3


def test_serial_devices_are_of_the_registry():
    with pytest.raises(InputError, match="there is no port /dev/none"):
        open_device("serial:/dev/none", info())
