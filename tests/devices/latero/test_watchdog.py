"""The watchdog: what it sends, step by step, and as a process that outlives its driver."""

import os
import select
import signal
import socket
import subprocess
import sys
import threading
import time
from contextlib import suppress

import numpy as np
import pytest

from tests.devices.latero.peers import PATIENCE_S, address_of, simulated, until
from vbraille.devices.latero import watchdog
from vbraille.devices.latero.device import WatchdogProcess
from vbraille.devices.latero.wire import (
    CONTROLLER,
    FULL,
    POWERED_OFF,
    RAW,
    WRITE,
    full_request,
    parse_request,
    raw_request,
)
from vbraille.simulation.lateroboard import LateroBoard

MS = 1_000_000


OFF = raw_request(WRITE | CONTROLLER, 0, POWERED_OFF)


class Guarded:
    """A watchdog in memory, and the Latero that it speaks with."""

    def __init__(self, *, power=True, deaf=False):
        self.latero = LateroBoard()
        self.board = watchdog.Board(bytearray(watchdog.MEMORY_BYTES))
        self.board.full[:] = full_request()
        self.board.off[:] = OFF
        self.board.words[watchdog.POWER] = power
        self.show(bytes(np.linspace(0, 150, 64).astype(np.uint8)))
        self.sent, self.answers, self.deaf = [], [], deaf
        self.watchdog = watchdog.Watchdog(self.board, self.send, self.receive)

    def show(self, levels):
        """Have the driver show levels, and beat."""
        self.board.levels[:] = levels
        self.latero.levels[:] = np.frombuffer(levels, np.uint8)
        self.board.words[watchdog.BEAT] = 1

    def send(self, datagram):
        self.sent.append(parse_request(bytes(datagram)))
        answer = self.latero.receive(bytes(datagram))
        if not self.deaf:
            self.answers.append(answer)

    def receive(self):
        return self.answers.pop(0) if self.answers else b""

    def act(self, begun_ns=0):
        """Have it do its work; give how long that took, in ms."""
        now_ns = begun_ns
        self.watchdog.begin(now_ns)
        while self.watchdog.acting:
            now_ns = max(self.watchdog.step(now_ns), now_ns + 1)
        return (now_ns - begun_ns) / MS


def test_blades_go_along_the_ramp_and_power_off():
    guarded = Guarded()
    took_ms = guarded.act()
    assert guarded.latero.at_rest
    assert not guarded.latero.powered
    assert 19 <= took_ms <= 26
    levels = np.array([list(one.blades) for one in guarded.sent if one.kind == FULL])
    steps = np.diff(levels.astype(int), axis=0)
    assert steps.min() >= 0
    assert steps.max() <= 8
    assert levels[0].min() <= 8
    assert bytes(guarded.board.levels) == bytes((150,)) * 64
    assert guarded.board.words[watchdog.ACTING] == 0


def test_it_says_so_again_until_it_is_answered_or_patience_ends():
    guarded = Guarded(deaf=True)
    assert 1000 <= guarded.act() <= 1006
    assert len([one for one in guarded.sent if one.kind == RAW]) > 150


def test_it_leaves_power_alone_where_its_register_is_not_known():
    guarded = Guarded(power=False)
    guarded.act()
    assert guarded.latero.at_rest
    assert guarded.latero.powered
    assert all(one.kind == FULL for one in guarded.sent)


def test_its_requests_are_numbered_and_never_twice_alike():
    guarded = Guarded()
    guarded.act()
    guarded.act(50 * MS)
    numbers = [one.sequence for one in guarded.sent]
    assert len(set(numbers)) == len(numbers)


@pytest.mark.parametrize(("level", "after_ms"), [(0, 50), (150, 1000)])
def test_it_acts_once_when_no_beat_comes(level, after_ms):
    guarded = Guarded()
    now_ns = 0
    guarded.show(bytes((level,)) * 64)
    while not guarded.watchdog.acting:
        acted_ns, now_ns = now_ns, guarded.watchdog.step(now_ns)
    assert guarded.sent
    assert acted_ns / MS == pytest.approx(after_ms, abs=0.1)
    while now_ns < 5000 * MS:
        now_ns = max(guarded.watchdog.step(now_ns), now_ns + 1)
    assert guarded.board.words[watchdog.TRIPS] == 1
    assert guarded.board.words[watchdog.AFTER] / MS == pytest.approx(after_ms, abs=0.1)


def test_it_never_acts_before_anything_was_shown():
    guarded = Guarded()
    guarded.board.words[watchdog.BEAT] = 0
    assert guarded.watchdog.step(60_000 * MS) == 60_010 * MS
    assert not guarded.sent


def test_a_driver_that_is_killed_just_as_it_goes_on_is_not_taken_for_back():
    """The beat of a driver that went on from a stop, and then ended, is not that it lives."""
    board = watchdog.Board(bytearray(watchdog.MEMORY_BYTES))
    board.full[:] = full_request()
    board.off[:] = OFF
    latero, felt = LateroBoard(), bytes(64)
    lifeline, driver = os.pipe()
    ours, its = socket.socketpair(socket.AF_UNIX, socket.SOCK_DGRAM)
    its.setblocking(False)
    board.levels[:] = felt
    board.words[watchdog.BEAT] = 1  # long ago
    watching = threading.Thread(target=watchdog.watch, args=(board, lifeline, its.fileno()))
    watching.start()
    latero.receive(ours.recv(256))  # it acts
    board.levels[:] = felt
    board.words[watchdog.BEAT] = time.monotonic_ns()
    os.close(driver)
    ours.settimeout(0.01)
    while watching.is_alive():
        with suppress(TimeoutError):
            ours.send(latero.receive(ours.recv(256)))
    watching.join()
    os.close(lifeline)
    ours.close()
    its.close()
    assert latero.at_rest


@pytest.fixture
def latero():
    with simulated() as latero:
        yield latero


@pytest.fixture
def process(latero):
    """A watchdog's process, whose driver has shown something."""
    line = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    line.connect(latero._socket.getsockname())
    process = WatchdogProcess(line.fileno(), 0)
    process.board.words[watchdog.POWER] = 1
    show(latero, process)
    try:
        yield process
    finally:
        if process.alive:
            process.close()
        line.close()


def show(latero, process):
    latero.board.levels[:] = 0
    process.board.levels[:] = bytes(64)
    process.board.words[watchdog.BEAT] = time.monotonic_ns()


def rests(latero):
    return latero.board.at_rest and not latero.board.powered


def test_a_driver_that_falls_silent_is_not_waited_for(latero, process):
    words = process.board.words
    until(lambda: rests(latero) and not words[watchdog.ACTING])
    assert words[watchdog.TRIPS] == 1
    assert process.alive
    show(latero, process)
    until(lambda: words[watchdog.TRIPS] == 2 and latero.board.at_rest)


def test_a_driver_that_asks_for_rest_has_it_at_once_and_goes_on(latero, process):
    process.rest()
    begun_s = time.monotonic()
    until(lambda: rests(latero) and not process.board.words[watchdog.ACTING])
    assert process.alive
    if time.monotonic() - begun_s < 0.045:  # the machine was quick
        assert process.board.words[watchdog.TRIPS] == 0


def test_a_driver_that_takes_leave_is_not_left_before_the_blades_rest(latero, process):
    process.close()
    assert rests(latero)
    assert not process.alive


def test_a_watchdog_of_a_driver_that_showed_nothing_ends_without_a_word(latero, process):
    process.board.words[watchdog.BEAT] = 0
    fulls = latero.board.fulls
    process.close()
    assert latero.board.fulls == fulls


def test_it_has_a_session_of_its_own_and_cannot_be_stopped_kindly(process):
    assert os.getsid(process._process.pid) == process._process.pid
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        os.kill(process._process.pid, number)
    time.sleep(0.05)
    assert process.alive


_DRIVER = """
import sys, time
import numpy as np
from vbraille.devices.latero.device import open_latero
device = open_latero(sys.argv[1], None)
frame = np.ones((8, 8))
while True:
    device.read()
    device.write(frame)
    if device.taking:
        print(device.watchdog._process.pid, flush=True)
    time.sleep(0.001)
"""


def test_a_driver_that_is_killed_leaves_the_blades_at_rest(latero):
    command = [sys.executable, "-c", _DRIVER, address_of(latero)]
    with subprocess.Popen(command, stdout=subprocess.PIPE) as driver:
        watching = int(driver.stdout.readline())
        until(lambda: not latero.board.at_rest)
        ended = os.pidfd_open(watching)
        driver.kill()
        until(lambda: rests(latero))
        assert select.select([ended], (), (), PATIENCE_S)[0]  # it ends by itself
        os.close(ended)
