"""Drivers of others that raise, or are no drivers: named with file and line, in one sentence."""

import importlib
import sys

import pytest

from tests import drivers
from tests.engine.test_loop import info
from vbraille.devices import opened_device, registry
from vbraille.engine.clock import ManualClock
from vbraille.engine.loop import Loop
from vbraille.engine.shared import Extent, attach
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
def test_what_a_driver_raises_names_it_with_file_and_line(driver, tmp_path, body, head):
    lines = driver(body, head)
    number = next(number for number, line in enumerate(lines, 1) if "mark" in line)
    with pytest.raises(DeviceError) as raised:
        use()
    said = str(raised.value)
    assert said.startswith("the driver other, which is not vbraille's own, has a fault (")
    assert f"at {tmp_path}/other.py, line {number}; tell whoever wrote it" in said
    assert "\n" not in said


def test_a_driver_that_is_not_there_is_named(driver):
    driver("pass", opener="open_another")
    with pytest.raises(DeviceError, match=r"AttributeError: .*\) at other:open_another; no line"):
        use()


def test_what_finds_drivers_is_not_blamed(tmp_path, monkeypatch):
    """A package that brings a newer `importlib.metadata` puts its own in the place of Python's."""
    source = "from importlib.metadata import EntryPoint\nclass Found(EntryPoint):\n"
    source += "    def load(self):\n        raise AttributeError('open_another')\n"
    (tmp_path / "backport_of_metadata.py").write_text(source)
    monkeypatch.syspath_prepend(str(tmp_path))
    found = importlib.import_module("backport_of_metadata")
    driver = found.Found("other", "json:open_another", registry.GROUP)
    monkeypatch.setattr(registry, "entry_points", lambda **_: [driver])
    with pytest.raises(DeviceError, match=r"\) at json:open_another; no line"):
        use()


def test_a_driver_that_gives_something_else_than_a_sample_is_named(driver):
    driver("def read(self):\n    return (0, 1.0)")
    with pytest.raises(DeviceError, match=r"the driver other, .* at other:open_other; no line"):
        use()


def test_a_driver_s_own_sentences_pass(driver):
    driver("def __init__(self, wanted):\n    raise InputError('give other:HOST')")
    with pytest.raises(InputError, match=r"^give other:HOST$"):
        use()


def test_a_traceback_is_let_through_when_it_is_asked_for(driver, monkeypatch):
    driver("def read(self):\n    return 1 / 0")
    monkeypatch.setenv("VBRAILLE_TRACEBACK", "1")
    with pytest.raises(ZeroDivisionError):
        use()


def test_what_the_program_itself_raises_is_not_blamed_on_the_driver(driver):
    driver("pass")
    with pytest.raises(OSError, match="Bad file"), opened_device("other:", info()):
        attach(999_999, Extent(6, 10, 20, 100))
    with pytest.raises(ZeroDivisionError), opened_device("sim:", info()):
        raise ZeroDivisionError


@pytest.mark.parametrize(
    ("body", "sentence"),
    [
        (
            "@property\ndef take_events(self):\n    return []",
            "take_events must be a method, and",
        ),
        ("def take_notes(self):\n    return []", "take_notes is not asked any more; take_events"),
        ("counts = {}", r"counts must be a method, and is \{\}"),
        ("def taking(self):\n    return False", "taking must be a property or a value, and"),
        ("def _send(self):\n    pass", r"can be called as _send\(self, value\)"),
        ("@staticmethod\ndef read(self):\n    pass", r"can be called as read\(self\)"),
        ("_release = None", "_release must be a method, and is None"),
    ],
)
def test_a_driver_with_members_of_another_kind_is_not_read_on(driver, body, sentence):
    driver(body)
    with pytest.raises(DeviceError, match=rf"driver other \(other:open_other\) .* {sentence}"):
        use()


def test_what_is_no_device_is_not_read_on(driver):
    driver("def __init__(self, _wanted):\n    pass", kind="object")
    with pytest.raises(DeviceError, match=r"driver other .* gives .*Other object .* must give"):
        use()
