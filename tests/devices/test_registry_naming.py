"""Drivers of others that raise, or are no drivers: named in one sentence."""

import sys

import pytest

from tests import drivers
from tests.engine.test_loop import info
from vbraille.devices import opened_device
from vbraille.engine.clock import ManualClock
from vbraille.engine.loop import Loop
from vbraille.engine.mailbox import Extent, attach
from vbraille.errors import DeviceError, InputError

HEAD = """
import sys
import numpy as np
from vbraille.simulation.simulated import SimulatedDevice
from vbraille.errors import InputError
"""


@pytest.fixture
def driver(tmp_path, monkeypatch):
    """Install a driver ``other`` of some lines of a class's body; its module's lines."""

    def install(body, head="", kind="SimulatedDevice", opener="open_other"):
        indented = "".join(f"    {line}\n" for line in body.splitlines())
        source = f"{HEAD}{head}\nclass Other({kind}):\n{indented}"
        source += "\ndef open_other(address, wanted):\n    return Other(wanted)\n"
        drivers.install(tmp_path, "other", opener, source)
        monkeypatch.syspath_prepend(str(tmp_path))
        monkeypatch.delitem(sys.modules, "other", raising=False)
        return source.splitlines()

    yield install
    sys.modules.pop("other", None)


def use():
    """Open it, ask all that a loop asks, and close it."""
    with opened_device("other:", info()) as device:
        device.set_zero()
        Loop(device, ManualClock()).tick()
        device.take_events()
        device.counts()


RAISES = {
    "load": ("pass", "raise ZeroDivisionError('mark')"),
    "import": ("pass", "import nothing_of_this_name  # mark"),
    "syntax": ("pass", "def mark(:"),
    "open": ("def __init__(self, wanted):\n    raise OSError(5, 'mark')", ""),
    "exit": ("def __init__(self, wanted):\n    sys.exit(3)  # mark", ""),
    "display": ("@property\ndef display(self):\n    return 1 / 0  # mark", ""),
    "read": ("def read(self):\n    return 1 / 0  # mark", ""),
    "library": ("def read(self):\n    return np.zeros(2).reshape(3)  # mark", ""),
    "python": ("def read(self):\n    return __import__('json').loads('')  # mark", ""),
    "send": ("def _send(self, frame):\n    raise ValueError('mark\\n of two lines')", ""),
    "set_zero": ("def set_zero(self):\n    assert not 'mark'", ""),
    "notes": ("def take_events(self):\n    return [{}['mark']]", ""),
    "counts": ("def counts(self):\n    return [][0]  # mark", ""),
    "close": ("def _release(self):\n    raise OSError('mark')", ""),
}


@pytest.mark.parametrize(("body", "head"), RAISES.values(), ids=RAISES)
def test_what_a_driver_raises_names_it_in_one_sentence(driver, capfd, body, head):
    driver(body, head)
    with pytest.raises(DeviceError) as raised:
        use()
    said = str(raised.value)
    assert said.startswith("the driver other (other:open_other), which is not vbraille's own, has")
    assert "\n" not in said
    assert "Traceback" not in capfd.readouterr().err


def test_a_driver_that_is_not_there_is_named(driver):
    driver("pass", opener="open_another")
    with pytest.raises(DeviceError, match=r"driver other \(other:open_another\).*AttributeError: "):
        use()


def test_a_driver_that_gives_something_else_than_a_sample_is_named(driver):
    driver("def read(self):\n    return (0, 1.0)")
    with pytest.raises(DeviceError, match=r"the driver other .*Error: "):
        use()


def test_a_driver_s_own_sentences_pass(driver):
    driver("def __init__(self, wanted):\n    raise InputError('give other:HOST')")
    with pytest.raises(InputError, match=r"^give other:HOST$"):
        use()


def test_a_traceback_is_printed_when_it_is_asked_for(driver, monkeypatch, capfd, tmp_path):
    lines = driver("def read(self):\n    return 1 / 0")
    monkeypatch.setenv("VBRAILLE_TRACEBACK", "1")
    with pytest.raises(DeviceError, match="ZeroDivisionError"):
        use()
    number = next(number for number, line in enumerate(lines, 1) if "1 / 0" in line)
    assert f'File "{tmp_path}/other.py", line {number}' in capfd.readouterr().err


def test_what_the_program_itself_raises_is_not_blamed_on_the_driver(driver):
    driver("pass")
    with pytest.raises(OSError, match="Bad file"), opened_device("other:", info()):
        attach(999_999, Extent(6, 10, 20, 100))
    with pytest.raises(ZeroDivisionError), opened_device("sim:", info()):
        raise ZeroDivisionError


def test_what_is_no_device_is_not_read_on(driver):
    driver("def __init__(self, _wanted):\n    pass", kind="object")
    with pytest.raises(DeviceError, match=r"driver other .* gives .*Other object .* must give"):
        use()
