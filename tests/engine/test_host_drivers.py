"""Drivers of others in a host process: what they print, raise, start and wait for."""

import os
import resource
import select
import signal
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from tests import drivers
from tests.engine.test_host import PATIENCE_S, ROOM, descriptors, lasting, until
from tests.engine.test_loop import info
from vbraille.devices.base import Placing
from vbraille.devices.events import (
    Back,
    Changed,
    Difference,
    Notice,
    NotInTime,
    Stalled,
    Stranger,
)
from vbraille.engine.host import Host, HostDiedError
from vbraille.errors import DeviceError, VbrailleError

_HEAD = """
import ctypes, os, subprocess, sys, time
import numpy as np
from vbraille.devices import events
from vbraille.simulation.simulated import SimulatedDevice
"""


def source_of(body, head="", kind="SimulatedDevice"):
    """A driver's module, of some lines of a class's body."""
    lines = "".join(f"    {line}\n" for line in body.splitlines())
    opener = "def open_other(address, wanted):\n    return Other(wanted)\n"
    return f"{_HEAD}{head}\nclass Other({kind}):\n{lines}\n{opener}"


@pytest.fixture
def driver(tmp_path, monkeypatch):
    """Install a driver ``other`` of some lines of a class's body; its module's lines."""

    def install(body, head="", kind="SimulatedDevice"):
        source = source_of(body, head, kind)
        folder = drivers.install(tmp_path, "other", "open_other", source)["PYTHONPATH"]
        monkeypatch.setenv("PYTHONPATH", folder)
        return source.splitlines()

    return install


def line_of(lines, part):
    return next(number for number, line in enumerate(lines, 1) if part in line)


def test_what_a_driver_prints_is_no_answer(driver, capfd):
    driver(
        """
def read(self):
    print("a print", '{"ready": 1}')
    os.write(1, b"a write\\n")
    if self.frames == 100:
        subprocess.run(["echo", "a program"])
    return super().read()
""",
        head='print("while it is loaded")',
    )
    with Host("other:", info(), ROOM) as host:
        until(host, lasting(300))
        assert host.display == info()
    said = capfd.readouterr()
    for part in ("while it is loaded\n", "a print", "a write\n", "a program\n"):
        assert part in said.err
    assert said.out == ""


@pytest.mark.parametrize(
    "body", ["def read(self):\n    return 1 / 0  # mark", "def _release(self):\n    mark"]
)
def test_what_a_driver_raises_is_said_by_the_parent(driver, monkeypatch, capfd, tmp_path, body):
    lines = driver(body)
    before = descriptors()
    monkeypatch.setenv("VBRAILLE_TRACEBACK", "1")
    with pytest.raises(DeviceError) as raised, Host("other:", info(), ROOM) as host:
        until(host, lambda new: new.size and host._mailbox.stop())
    said = str(raised.value)
    assert said.startswith("the driver other (other:open_other), which is not vbraille's own, has")
    place = f'File "{tmp_path}/other.py", line {line_of(lines, "mark")}'
    assert place in capfd.readouterr().err
    assert descriptors() == before


_PARENT = """
import time
from tests.engine.test_host import ROOM, info
from vbraille.engine.host import Host
hosts = [Host(f"{name}:", info(), ROOM) for name in ("opened", "closed", "read")]
for host in hosts:
    host.launch()
print(*(host.process_id for host in hosts), flush=True)
for host in hosts[1:]:
    host.start()
while min(host.tally.ticks for host in hosts[1:]) < 50:
    time.sleep(0.01)
    for host in hosts[1:]:
        host.poll()
print("reading", flush=True)
time.sleep(600)
"""
# It holds all of Python: no thread and no signal's handler of Python's own runs meanwhile.
_WAIT = "ctypes.PyDLL(None).sleep(600)"
_STUCK = {
    "opened": "def __init__(self, wanted):\n    print('stuck', flush=True)\n    {wait}",
    "closed": "def _release(self):\n    {wait}",
    "read": "def read(self):\n    if self.frames > 200:\n        {wait}\n    return super().read()",
}


def test_a_driver_that_waits_for_ever_outlives_a_killed_parent_by_seconds(tmp_path):
    for name, body in _STUCK.items():
        source = source_of(body.format(wait=_WAIT))
        environment = drivers.install(tmp_path, name, "open_other", source)
    hosts = []
    parent = subprocess.Popen(
        [sys.executable, "-c", _PARENT],
        env={**environment, "PYTHONPATH": f"{environment['PYTHONPATH']}:."},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    try:
        hosts = [os.pidfd_open(int(number)) for number in parent.stdout.readline().split()]
        assert len(hosts) == len(_STUCK)
        assert parent.stderr.readline() == "stuck\n"
        assert parent.stdout.readline() == "reading\n"
        parent.kill()
        for host in hosts:
            assert select.select([host], [], [], PATIENCE_S)[0], "the host goes on for ever"
    finally:
        parent.kill()
        parent.communicate()
        for host in hosts:
            os.close(host)


def test_a_driver_that_waits_for_ever_is_told_of_and_ended_while_its_parent_lives(
    tmp_path, monkeypatch
):
    for name, body in _STUCK.items():
        source = source_of(body.format(wait=_WAIT))
        monkeypatch.setenv(
            "PYTHONPATH", drivers.install(tmp_path, name, "open_other", source)["PYTHONPATH"]
        )
    hosts = {name: Host(f"{name}:", info(), ROOM) for name in _STUCK}
    for host in hosts.values():
        host.launch()
    for name in ("closed", "read"):
        hosts[name].start()
    told = []
    until(
        hosts["read"],
        lambda _new: (
            told.extend(hosts["read"].take_events())
            or any(isinstance(event, Stalled) for event in told)
        ),
    )
    (stalled,) = (event for event in told if isinstance(event, Stalled))
    assert 1000 < stalled.stalled_ms < 2000
    processes = [host.process_id for host in hosts.values()]
    # That it is waited for long enough, other tests see: here both are waited for in vain.
    monkeypatch.setattr("vbraille.engine.host.OPEN_S", 2.0)
    monkeypatch.setattr("vbraille.engine.host._END_S", 1.5)
    with ThreadPoolExecutor() as pool:
        ending = {
            "the driver opened did not open its device within 2 s": hosts["opened"].start,
            "the driver closed did not let the device go within 1.5 s": hosts["closed"].close,
            "the driver read did not let the device go within 1.5 s": hosts["read"].close,
        }
        for said, ended in {said: pool.submit(end) for said, end in ending.items()}.items():
            with pytest.raises(DeviceError, match=said):
                ended.result(PATIENCE_S)
    for host in hosts.values():
        host.close()  # it has ended, and was told of
    assert not any(Path(f"/proc/{number}").exists() for number in processes)


def test_a_driver_that_blocks_once_is_told_of_and_so_is_its_return(driver):
    driver(
        """
def read(self):
    if self.frames == 300:
        time.sleep(1.5)
    return super().read()
"""
    )
    told = []
    with Host("other:", info(), ROOM) as host:
        until(host, lambda _new: told.extend(host.take_events()) or Back() in told)
    kinds = [type(event) for event in told if isinstance(event, Stalled | Back)]
    assert kinds == [Stalled, Back]


@pytest.mark.parametrize("let_go", ["return 1 / 0", "os._exit(7)"])
def test_a_driver_that_fails_to_let_go_is_told_of_after_all_else_went_well(driver, let_go):
    driver(f"def _release(self):\n    {let_go}")
    before = descriptors()
    host = Host("other:", info(), ROOM)
    host.start()
    until(host, lasting(100))
    with pytest.raises(VbrailleError, match=r"ZeroDivisionError|exit code 7"):
        host.close()
    assert descriptors() == before


def test_an_error_is_not_hidden_by_a_driver_that_fails_to_let_go(driver):
    driver("def _release(self):\n    return 1 / 0")

    def fail(_ticks):
        raise KeyError

    with pytest.raises(KeyError), Host("other:", info(), ROOM) as host:
        until(host, fail)


_FORKS = """
def __init__(self, wanted):
    super().__init__(wanted)
    child = os.fork()
    if child == 0:
        os.setsid()
        time.sleep(600)
        os._exit(0)
    path, = [p for p in sys.path if os.path.exists(os.path.join(p, "other.py"))]
    open(os.path.join(path, "child"), "w").write(str(child))
"""


@pytest.fixture
def child(tmp_path):
    """Number of the process that a driver forked, which holds the pipe to the parent."""
    yield lambda: int((tmp_path / "child").read_text())
    os.kill(int((tmp_path / "child").read_text()), signal.SIGKILL)


def spent_s():
    used = resource.getrusage(resource.RUSAGE_SELF)
    return used.ru_utime + used.ru_stime


def test_a_host_is_closed_while_a_child_of_its_driver_holds_the_pipe(driver, child):
    driver(_FORKS)
    with Host("other:", info(), ROOM) as host:
        until(host, lasting(30))
        process, busy_s = host._process, spent_s()
    assert process.returncode == 0  # it did not have to be killed
    assert spent_s() - busy_s < 1.0
    os.kill(child(), 0)  # which is still there


def test_a_host_s_death_is_seen_while_a_child_of_its_driver_holds_the_pipe(driver, child):
    driver(_FORKS)
    with Host("other:", info(), ROOM) as host:
        until(host, lasting(30))
        os.kill(host.process_id, signal.SIGKILL)
        with pytest.raises(HostDiedError, match="signal 9"):
            until(host, lambda _new: False)
        assert child()


def test_a_host_that_dies_when_it_starts_is_seen_while_a_child_holds_the_pipe(driver, child):
    driver(_FORKS + "    os._exit(7)\n")
    with pytest.raises(HostDiedError, match="exit code 7"):
        Host("other:", info(), ROOM).__enter__()
    assert child()


FACE = "\U0001f600"


def told_by(driver, *events):
    """What comes of events that a driver tells once, but for what the system refuses."""
    told_at_once = ", ".join(events)
    driver(f"def take_events(self):\n    return [{told_at_once}] if self.frames == 99 else []")
    told = []
    with Host("other:", info(), ROOM) as host:
        until(host, lambda new: told.extend(host.take_events()) or lasting(200)(new))
    return [event for event in told if not isinstance(event, NotInTime)]


def test_events_come_as_they_were_told_and_long_texts_whole_or_cut(driver):
    made = {
        "events.Changed((events.Difference('name', 'a', 'b'),), gain=3, "
        "placing=events.Placing.STOP, times=2)": Changed(
            (Difference("name", "a", "b"),), gain=3, placing=Placing.STOP, times=2
        ),
        f"events.Notice(3, {FACE!r} * 9999)": Notice(3, FACE * 300),
        f"events.Stranger({FACE!r} * 250, {FACE!r} * 250, fault={FACE!r} * 999)": Stranger(
            FACE * 60, FACE * 60, fault=FACE * 60
        ),
    }
    assert told_by(driver, *made) == list(made.values())


def test_what_is_no_event_ends_the_reading_in_a_sentence(driver):
    with pytest.raises(DeviceError, match="tells 'too hot', which is no event of vbraille"):
        told_by(driver, "'too hot'")
