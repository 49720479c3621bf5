"""A client, its watchdog and the boards of a Latero in memory, by a clock that the test turns."""

from __future__ import annotations

import heapq

import numpy as np

from tests.devices.latero.network import LateroFaults, Network
from vbraille.carriers import latero
from vbraille.devices.latero.device import LateroAddress, LateroDevice
from vbraille.devices.latero.watchdog import ACTING, MEMORY_BYTES, Board, Watchdog
from vbraille.devices.latero.wire import CONTROLLER, WRITE, full_request, raw_request
from vbraille.simulation.lateroboard import LateroBoard

MS = 1_000_000
OFFSETS = (4452, 4_294_960_000, 120_034)
FELT = np.linspace(0.1, 1, 64).reshape(8, 8)


class Line:
    """A socket: what is sent arrives at once, and answers a little later, if the network lets."""

    def __init__(self, bench):
        self.bench, self.coming, self.count = bench, [], 0

    def send(self, request):
        bench = self.bench
        for _ in range(0 if bench.cut else bench.network.carry_request()):
            joints = latero.joints_at(bench.x_mm(bench.now_ns), 100.0, 0.1)
            bench.board.encoders = (*latero.encoders_of(joints, OFFSETS), 0)
            before = bench.board.fulls
            answer = bench.board.receive(bytes(request))
            assert answer is not None
            if bench.board.fulls != before:
                bench.levels.append(bench.board.levels.copy())
            for late_s, arriving in bench.network.carry_answer(answer):
                self.count += 1
                due_ns = bench.now_ns + round(late_s * 1e9) + MS // 10
                heapq.heappush(self.coming, (due_ns, self.count, arriving))

    def receive(self):
        """Give the next datagram that has come, or nothing."""
        while self.coming and self.coming[0][0] <= self.bench.now_ns:
            datagram = self.bench.spoil(heapq.heappop(self.coming)[2])
            if datagram:
                return datagram
        return b""

    def recv_into(self, room):
        datagram = self.receive()
        if not datagram:
            raise BlockingIOError
        room[: len(datagram)] = datagram
        return len(datagram)

    def close(self):
        pass


class Beside:
    """A watchdog in memory, in place of its process."""

    def __init__(self, bench, register=0):
        self.alive, self.ended = True, False
        self.board = Board(bytearray(MEMORY_BYTES))
        self.board.full[:] = full_request()
        self.board.off[:] = raw_request(WRITE | CONTROLLER, register, 2)
        line = Line(bench)
        self.watchdog = Watchdog(self.board, line.send, line.receive)
        self.bench = bench

    def rest(self):
        self.board.words[ACTING] = 1
        self.watchdog.begin(self.bench.now_ns)
        self.watchdog.step(self.bench.now_ns)

    def close(self):
        self.rest()
        while self.watchdog.acting:
            self.bench.pause(0.001)


class Bench:
    """A client that shows the same frame at each tick, and a Latero whose array moves along x.

    Parameters
    ----------
    faults
        What the network does.
    speed_mm_s
        Speed of the array.
    register
        Register by which the Latero switches motor power.
    address
        What the client knows of it.
    """

    def __init__(self, faults=None, speed_mm_s=100.0, register=0, powered=True, **address):
        self.now_ns, self.speed_mm_s = 0, speed_mm_s
        self.board, self.network = LateroBoard(register), Network(faults or LateroFaults())
        self.board.powered = powered
        self.cut, self.spoil = False, lambda datagram: datagram
        self.poses, self.events, self.levels = [], [], []  # levels of each FULL that arrived
        self.frame = FELT
        self.beside = Beside(self)
        known = LateroAddress("it", **{"offsets": OFFSETS, **address})
        self.device = LateroDevice(
            Line(self), self.beside, known, now_ns=lambda: self.now_ns, pause=self.pause
        )
        self.device.greet()

    def x_mm(self, now_ns):
        """Where the array is on the tray, from the left, to and fro."""
        way = self.speed_mm_s * now_ns / 1e9 % 400
        return 40 + min(way, 400 - way)

    def pause(self, seconds):
        """Let time go by, in which the watchdog works."""
        self.now_ns += round(seconds * 1e9)
        self.beside.watchdog.step(self.now_ns)

    def run(self, ticks):
        """Do ticks, 1 ms each; give the bench."""
        for _ in range(ticks):
            self.pause(0.001)
            self.poses.append(self.device.read())
            if self.frame is not None:
                self.device.write(self.frame)
            self.events += self.device.take_events()
        return self

    def of(self, kind):
        """Events of a kind."""
        return [event for event in self.events if isinstance(event, kind)]

    @property
    def steps(self):
        """Steps of the blades towards rest from one FULL to the next; int[n, 64]."""
        return np.diff(np.array(self.levels).astype(int), axis=0)
