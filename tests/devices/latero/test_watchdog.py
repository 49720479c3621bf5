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
from vbraille.devices.latero.conversation import power_off
from vbraille.devices.latero.device import WatchdogProcess
from vbraille.devices.latero.wire import FULL, RAW, full_request, parse_request
from vbraille.simulation.lateroboard import LateroBoard

MS = 1_000_000


class Guarded:
    """A watchdog in memory, and the Latero that it speaks with."""

    def __init__(self, *, power=True, deaf=False):
        self.latero = LateroBoard()
        self.board = watchdog.Board(bytearray(watchdog.MEMORY_BYTES))
        self.board.full[:] = full_request()
        self.board.off[:] = power_off(0)
        self.board.words[watchdog.POWER] = power
        levels = bytes(np.linspace(0, 150, 64).astype(np.uint8))
        self.board.levels[:] = levels
        self.latero.levels[:] = np.frombuffer(levels, np.uint8)
        self.sent, self.answers, self.deaf = [], [], deaf
        self.watchdog = watchdog.BladeWatchdog(self.board, self.send, self.receive)

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
        while (due_ns := self.watchdog.step(now_ns)) is not None:
            now_ns = max(due_ns, now_ns + 1)
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
    assert guarded.board.words[watchdog.TRIPS] == 1
    assert bytes(guarded.board.levels) == bytes((150,)) * 64


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
    numbers = [one.sequence for one in guarded.sent]
    assert len(set(numbers)) == len(numbers)
    first = len(numbers)
    guarded.act(50 * MS)
    again = [one.sequence for one in guarded.sent[first:]]
    assert not set(again) & set(numbers)


def test_it_stops_when_its_driver_beats_again():
    guarded = Guarded()
    guarded.watchdog.begin(0)
    guarded.watchdog.step(0)
    guarded.watchdog.step(5 * MS)
    guarded.board.words[watchdog.BEAT] = 5 * MS
    assert guarded.watchdog.step(6 * MS) is None
    assert len(guarded.sent) == 2
    assert guarded.board.words[watchdog.ACTING] == 0


def test_a_driver_that_is_killed_just_as_it_goes_on_is_not_taken_for_back():
    """The beat of a driver that went on from a stop, and then ended, is not that it lives."""
    board = watchdog.Board(bytearray(watchdog.MEMORY_BYTES))
    board.full[:] = full_request()
    board.off[:] = power_off(0)
    latero, felt = LateroBoard(), bytes(64)
    lifeline, driver = os.pipe()
    ours, its = socket.socketpair(socket.AF_UNIX, socket.SOCK_DGRAM)
    its.setblocking(False)
    board.levels[:] = felt
    board.words[watchdog.BEAT] = 1  # long ago
    watching = threading.Thread(target=watchdog.watch, args=(board, lifeline, its.fileno()))
    watching.start()
    latero.receive(ours.recv(256))  # it acts
    os.close(driver)
    board.levels[:] = felt
    board.words[watchdog.BEAT] = time.monotonic_ns()
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
    process = WatchdogProcess(bytes(full_request()), bytes(power_off(0)), line.fileno())
    process.board.words[watchdog.POWER] = 1
    process.beat(time.monotonic_ns())
    latero.board.levels[:] = 0
    process.board.levels[:] = bytes(64)
    try:
        yield process
    finally:
        if process.alive:
            process.close()
        line.close()


def test_a_driver_that_falls_silent_is_not_waited_for(latero, process):
    until(lambda: latero.board.at_rest and not latero.board.powered)
    assert process.trips == 1
    assert process.alive
    latero.board.levels[:] = 0
    process.board.levels[:] = bytes(64)
    process.beat(time.monotonic_ns())
    until(lambda: process.trips == 2 and latero.board.at_rest)


def test_a_driver_that_takes_leave_has_it_end_without_a_word(latero, process):
    for _ in range(20):
        process.beat(time.monotonic_ns())
        time.sleep(0.001)
    trips, fulls = process.trips, latero.board.fulls
    process.close()
    assert not process.alive
    if not trips:  # the machine has let us beat in time
        assert latero.board.fulls == fulls


def test_it_has_a_session_of_its_own_and_cannot_be_stopped_kindly(process):
    assert os.getsid(process.process_id) == process.process_id
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        os.kill(process.process_id, number)
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
    if not device.conversation.blades.rests:
        print(device.watchdog.process_id, flush=True)
    time.sleep(0.001)
"""


def test_a_driver_that_is_killed_leaves_the_blades_at_rest(latero):
    command = [sys.executable, "-c", _DRIVER, address_of(latero)]
    with subprocess.Popen(command, stdout=subprocess.PIPE) as driver:
        watching = int(driver.stdout.readline())
        until(lambda: not latero.board.at_rest)
        ended = os.pidfd_open(watching)
        driver.kill()
        until(lambda: latero.board.at_rest and not latero.board.powered)
        assert select.select([ended], (), (), PATIENCE_S)[0]  # it ends by itself
        os.close(ended)
