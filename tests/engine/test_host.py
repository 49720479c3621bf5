"""The host in its own process, whose parent and whose device may fail."""

import mmap
import os
import select
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

from tests import drivers
from tests.engine.test_loop import info, picture
from vbraille.devices.events import HandHeld, Notice
from vbraille.engine.host import Host, HostDiedError
from vbraille.engine.mailbox import watch
from vbraille.engine.record import Flag
from vbraille.errors import DeviceError, InputError
from vbraille.render import STRESS2, VBD
from vbraille.simulation.steering import BeAt, Pointer, ReadLine, Steering

PATIENCE_S = 60.0
ROOM = STRESS2.style.room(STRESS2.display, 26)  # lines of so many cells


def until(host, enough):
    """Poll until there is enough; all records."""
    ticks = [host.poll()]
    end = time.monotonic() + PATIENCE_S
    while not enough(ticks[-1]):
        assert time.monotonic() < end
        select.select([], [], [], 0.01)
        ticks.append(host.poll())
    return np.concatenate(ticks)


def lasting(ticks):
    """Until so many ticks are done."""
    return lambda new: new.size and new["tick"][-1] >= ticks


def descriptors():
    return len(list(Path("/proc/self/fd").iterdir()))


@pytest.mark.new_processes
def test_a_life():
    """Start, a line, a pause, a death, another start, an end: with one process, for its time.

    Keys of the terminal do not stop it, and a picture for another array is refused here.
    """
    before = descriptors()
    with Host("sim:?hand=sweep:100", info(), ROOM) as host:
        line = picture(mapping="sheared")
        host.show(line, 7)
        ticks = until(host, lasting(400))
        assert host.display == info()
        assert ticks["tick"].tolist() == list(range(ticks.size))
        assert host.lost == 0
        assert ticks["line"][-1] == 7
        assert (np.diff(ticks["time_ns"]) > 0).all()
        want = np.zeros((6, 10))
        shown = ticks[ticks["share"] == 1][-1]
        line.frame(float(shown["x_mm"]), want)
        assert want.any()
        np.testing.assert_array_equal(shown["frame"], want.astype(np.float32))

        for number in (signal.SIGTSTP, signal.SIGTTIN, signal.SIGTTOU):
            os.kill(host.process_id, number)  # as keys of the terminal do
        other = VBD.style.render(np.zeros(1, np.uint8), VBD.display)
        with pytest.raises(ValueError, match="for 1 × 12 actuators"):
            host.show(other, 1)
        until(host, lasting(host.tally.ticks + 100))

        host.paused = True
        until(host, lambda new: new.size and not new["frame"][-1].any())
        assert host.newest["flags"] & Flag.PAUSED
        host.paused = False

        done = host.tally.ticks
        os.kill(host.process_id, signal.SIGKILL)
        with pytest.raises(HostDiedError, match="signal 9"):
            until(host, lambda _new: False)
        host.start()
        ticks = until(host, lasting(300))
        assert ticks["tick"][0] == 0
        assert ticks["line"][-1] == 7
        assert ticks["frame"][-1].any()
        assert host.tally.ticks >= done + 300
        process = host.process_id
    assert host.process_id is None
    with pytest.raises(ProcessLookupError):
        os.kill(process, 0)
    assert descriptors() == before


def test_notes_counts_and_the_device_s_fault(tmp_path, monkeypatch):
    monkeypatch.setenv("PYTHONPATH", drivers.install(tmp_path)["PYTHONPATH"])
    told = []
    with Host(f"logged:{tmp_path / 'log'},gone", info(), ROOM) as host:
        with pytest.raises(DeviceError, match="the device is gone"):
            until(host, lambda _new: told.extend(host.take_events()))
        told += host.take_events()
    assert Notice(255, "three hundred frames") in told
    assert host.counts == {"frames": 300}


def seen(log):
    """Frames that a driver has logged so far."""
    return np.fromfile(log).reshape(-1, 6, 10)


def test_what_a_host_did_before_its_death_is_still_told(tmp_path, monkeypatch):
    monkeypatch.setenv("PYTHONPATH", drivers.install(tmp_path)["PYTHONPATH"])
    log = tmp_path / "log"
    with Host(f"logged:{log}", info(), ROOM) as host:
        host.show(picture(mapping="sheared"), 1)
        before = until(host, lasting(400))  # its notice is told by then, and no more is to be heard
        done = len(seen(log))
        with os.fdopen(os.pidfd_open(host.process_id)) as ended:
            while len(seen(log)) < done + 100:
                select.select([], [], [], 0.01)
            os.kill(host.process_id, signal.SIGKILL)
            assert select.select([ended], [], [], PATIENCE_S)[0]
        ticks = host.poll()
        assert ticks["tick"][0] == before["tick"][-1] + 1
        assert (np.diff(ticks["tick"]) == 1).all()
        # All but the last frame, whose record may be half written.
        ours = seen(log)[-ticks.size - 1 :].astype(np.float32)
        assert ticks.size >= 99
        assert any((ours[n : n + ticks.size] == ticks["frame"]).all() for n in (0, 1))
        with pytest.raises(HostDiedError, match="signal 9"):
            host.poll()


def test_what_a_device_did_before_its_fault_is_told_to_the_last_tick(tmp_path, monkeypatch):
    monkeypatch.setenv("PYTHONPATH", drivers.install(tmp_path)["PYTHONPATH"])
    log = tmp_path / "log"
    with Host(f"logged:{log},gone", info(), ROOM) as host:
        with os.fdopen(os.pidfd_open(host.process_id)) as ended:
            assert select.select([ended], [], [], PATIENCE_S)[0]
        ticks = host.poll()
        assert 0 < ticks.size <= 300
        assert ticks["tick"].tolist() == list(range(ticks.size))
        assert len(seen(log)) == 300 > ticks.size  # the first ones were a rehearsal
        with pytest.raises(DeviceError, match="the device is gone"):
            host.poll()


def test_a_device_that_cannot_be_opened():
    before = descriptors()
    with pytest.raises(InputError, match="no device kind 'nothing'"):
        Host("nothing:", info(), ROOM).__enter__()
    assert descriptors() == before


def test_a_device_is_opened_before_anybody_knows_how_long_lines_are():
    before = descriptors()
    host = Host("sim:?hand=sweep:100", info(travel_mm=123.0))
    try:
        assert host.open() == info(travel_mm=123.0)
        host.fit(host.display, STRESS2.style.room(STRESS2.display, 7))
        host.start()
        host.show(picture((63,) * 7, mapping="sheared"), 1)
        until(host, lambda new: new.size and new["frame"][-1].any())
    finally:
        host.close()
    unused = Host("sim", info())
    unused.open()
    unused.close()  # one that waits to be told how long lines are ends, too
    assert descriptors() == before


def test_a_simulated_hand_is_steered_and_held_past_the_engine_and_watched_at_each_start():
    steering, pointer, watching = Steering(), Pointer(), []

    def attend(descriptor, extent):
        memory = mmap.mmap(descriptor, extent.total_bytes, prot=mmap.PROT_READ)
        watching.append(watch(memoryview(memory), extent)[1])

    def at(x_mm):
        return lambda new: new.size and abs(new["x_mm"][-1] - x_mm) < 0.01

    spec = f"sim:?hand=sweep:1000&steering={steering.descriptor}&pointer={pointer.descriptor}"
    host = Host(spec, info(), 26, pass_fds=[steering.descriptor, pointer.descriptor])
    host.on_share = attend
    with host:
        (home_mm,) = set(until(host, lasting(100))["x_mm"])
        steering.give(ReadLine(50.0))
        ticks = until(host, lambda new: new.size and steering.done_at(int(new["device_ns"][-1])))
        assert 45 < ticks["x_mm"].max() - home_mm - info().span_mm <= 50
        assert ticks["x_mm"][-1] == home_mm
        pointer.hold(BeAt(40.0))
        until(host, at(40.0))
        (seen,) = watching
        assert seen.drain()[-1]["x_mm"] == pytest.approx(40.0, abs=0.01)
        assert HandHeld(held=True) in host.take_events()
        os.kill(host.process_id, signal.SIGKILL)
        with pytest.raises(HostDiedError):
            until(host, lambda _new: False)
        steering.give(ReadLine(50.0))  # while no process can take it
        host.start()
        until(host, at(40.0))  # it is held where it was
        _, seen = watching
        assert seen.drain()[-1]["tick"] >= host.newest["tick"]
        pointer.let_go()
        until(host, lambda _new: HandHeld(held=False) in host.take_events())
        assert {40.0} == set(until(host, lasting(host.tally.ticks + 100))["x_mm"])
        steering.give(ReadLine(50.0))
        until(host, lambda new: new.size and steering.done_at(int(new["device_ns"][-1])))
        assert host.x_mm == home_mm


_PARENT = """
import sys, time
from tests.engine.test_host import ROOM, info, picture
from vbraille.engine.host import Host
with Host(sys.argv[1], info(), ROOM) as host:
    host.show(picture(mapping="sheared"), 1)
    while host.tally.ticks < 400:
        time.sleep(0.01)
        host.poll()
    print(host.process_id, flush=True)
    time.sleep(600)
"""


def test_a_killed_parent_leaves_no_host_and_no_actuator_deflected(tmp_path):
    log = tmp_path / "log"
    folder = drivers.install(tmp_path)["PYTHONPATH"]
    environment = {**os.environ, "PYTHONPATH": f"{folder}:."}
    parent = subprocess.Popen(
        [sys.executable, "-c", _PARENT, f"logged:{log}"],
        env=environment,
        stdout=subprocess.PIPE,
        text=True,
    )
    with parent:
        host = os.pidfd_open(int(parent.stdout.readline()))
        try:
            parent.kill()
            assert select.select([host], [], [], PATIENCE_S)[0], "the host goes on without a parent"
        finally:
            os.close(host)
    frames = np.fromfile(log).reshape(-1, 6, 10)
    assert frames.max() == 1.0
    assert not frames[-1].any()
    row = frames[:, 0].max(axis=1)  # off the dots it stands at full swing
    down = row[np.flatnonzero(row == 1.0)[-1] :]
    assert ((down > 0.02) & (down < 0.98)).any()


def test_without_the_right_to_real_time_a_sentence_says_how_to_get_it():
    script = (
        "import os, resource\n"
        "from vbraille.engine.realtime import go_real_time\n"
        "resource.setrlimit(resource.RLIMIT_MEMLOCK, (65536, 65536))\n"
        "resource.setrlimit(resource.RLIMIT_RTPRIO, (0, 0))\n"
        "if os.geteuid() == 0: os.setuid(65534)\n"
        "print(go_real_time().say())\n"
    )
    said = subprocess.run(
        [sys.executable, "-c", script], check=True, capture_output=True, text=True
    ).stdout
    assert said.startswith("timing: no real-time priority and no locked memory, so that")
    assert "/etc/security/limits.d" in said
    assert said.count("\n") == 1
