"""The Latero's watchdog: a process that does nothing but bring its blades to rest.

Nothing documents a watchdog in the Latero: a blade stays where the last datagram put it. So this
file is run by itself, beside the process that drives the Latero, before that sends anything to
feel. The driver beats in shared memory with each datagram. When it has not for `WATCHDOG_NS`, or
its end of the pipe is closed because it has ended, the watchdog takes the blades from their last
levels to rest along a ramp, switches motor power off, and says so again until the Latero has
answered both, or for `PATIENCE_NS`. Then it ends, or, if the driver lives, watches again.

It is given the datagrams ready-made and imports next to nothing, so that it is there at once:

    python -I -S watchdog.py MEMORY LIFELINE SOCKET

These are descriptors; further ones that it inherits stay open as long as it lives. It answers with
a byte on standard output when it watches.
"""

from __future__ import annotations

import mmap
import os
import select
import signal
import sys
import time

WATCHDOG_NS = 50_000_000
# A driver that is stopped with all blades at rest has this long.
REST_WATCHDOG_NS = 1_000_000_000
RAMP_NS = 20_000_000
STEP_NS = 1_000_000
# How often what was not answered is said again, and for how long.
AGAIN_NS = 5_000_000
PATIENCE_NS = 1_000_000_000
LOOK_NS = 10_000_000  # how often it looks whether a driver that fell silent beats again

# The memory that is shared: words of 8 bytes, then three requests of 100 bytes.
BEAT, STATE, TRIPS, ACTING, POWER = range(5)  # words, by their places
WATCHED, CLOSED = 0, 1  # values of STATE
FULL_AT, OFF_AT = 64, 192  # the last FULL, and the RAW that switches motor power off
MEMORY_BYTES = 512
REQUEST_BYTES = 100
LEVELS_AT, BLADES, REST = 15, 64, 150
SEQUENCE_AT = 3
# In an answer of 35 bytes: its type, and the controller's word.
FULLR_BYTES, TYPE_AT, CONTROLLER_AT, POWERED_OFF = 35, 2, 7, 0x0002
FULLR = (0x81, 0x82)
_ABOVE_THE_HOST = 42


class Board:
    """Memory that the driver and its watchdog share.

    Parameters
    ----------
    memory
        At least `MEMORY_BYTES`, which both have mapped.
    """

    def __init__(self, memory):
        view = memoryview(memory)
        self.words = view[:FULL_AT].cast("q")
        self.full = view[FULL_AT : FULL_AT + REQUEST_BYTES]
        self.levels = self.full[LEVELS_AT : LEVELS_AT + BLADES]
        self.off = view[OFF_AT : OFF_AT + REQUEST_BYTES]


def ramped(level, passed_ns):
    """Level of a blade that was at a level when the ramp to rest began, so long ago."""
    return min(REST, level + -(-REST * passed_ns // RAMP_NS))


class BladeWatchdog:
    """Steps of the watchdog, one after the other; `watch` does nothing else.

    Parameters
    ----------
    board
        Memory that is shared with the driver.
    send
        Sends a datagram to the Latero; what cannot be sent is lost.
    receive
        Gives the next datagram that has come, or nothing.

    Attributes
    ----------
    acting : bool
        Whether blades are being brought to rest.
    beat_ns : int
        Last beat of the driver before it fell silent.
    """

    def __init__(self, board, send, receive):
        self.acting = False
        self._board = board
        self._send = send
        self._receive = receive
        self._begun_ns = self._due_ns = self.beat_ns = 0
        self._from = b""
        self._request = bytearray(REQUEST_BYTES)
        self._sequence = 0
        self._resting = None  # number of the first request that had all blades at rest
        self._rested = self._unpowered = False

    def begin(self, now_ns):
        """Begin to bring the blades to rest."""
        board = self._board
        self.acting, self._begun_ns, self._due_ns = True, now_ns, now_ns
        self.beat_ns = board.words[BEAT]
        self._request[:] = board.full
        self._from = bytes(board.levels)
        self._sequence = (board.words[TRIPS] * 4096 + 0x8000) & 0xFFFF
        self._resting = None
        self._rested = False
        self._unpowered = not board.words[POWER]
        board.words[TRIPS] += 1
        board.words[ACTING] = 1

    def step(self, now_ns):
        """Say what is due; give the time of the next step, or None when all is done."""
        self._hear()
        passed_ns = now_ns - self._begun_ns
        if (self._rested and self._unpowered) or passed_ns > PATIENCE_NS:
            self._end()
            return None
        if self._board.words[BEAT] != self.beat_ns:  # the driver is back, and does it itself
            self._end()
            return None
        if now_ns < self._due_ns:
            return self._due_ns
        # The first step is one: what was to be done after 50 ms is not put off by another.
        levels = bytes(ramped(level, passed_ns + STEP_NS) for level in self._from)
        self._request[LEVELS_AT : LEVELS_AT + BLADES] = levels
        self._number(self._request)
        self._board.levels[:] = levels
        self._send(self._request)
        at_rest = min(levels) == REST
        if at_rest:
            if self._resting is None:
                self._resting = self._sequence
            if not self._unpowered:
                off = bytearray(self._board.off)
                self._number(off)
                self._send(off)
                # Its effect is told by the next answer.
                self._number(self._request)
                self._send(self._request)
        self._due_ns = now_ns + (AGAIN_NS if at_rest else STEP_NS)
        return self._due_ns

    def _number(self, request):
        self._sequence = (self._sequence + 1) & 0xFFFF
        request[SEQUENCE_AT], request[SEQUENCE_AT + 1] = self._sequence >> 8, self._sequence & 0xFF

    def _hear(self):
        while answer := self._receive():
            if len(answer) != FULLR_BYTES or answer[TYPE_AT] not in FULLR or self._resting is None:
                continue
            sequence = answer[SEQUENCE_AT] << 8 | answer[SEQUENCE_AT + 1]
            if (sequence - self._resting) & 0xFFFF < 0x8000:
                self._rested = True
                if answer[CONTROLLER_AT + 1] & POWERED_OFF:
                    self._unpowered = True

    def _end(self):
        self.acting = False
        self._board.words[ACTING] = 0


def watch(board, lifeline, socket):
    """Watch until the driver has ended and the blades are at rest."""

    def send(datagram):
        try:  # noqa: SIM105 - contextlib takes time to load
            os.write(socket, datagram)
        except OSError:
            pass  # no Latero hears it: it may hear the next

    def receive():
        try:
            return os.read(socket, 256)
        except OSError:
            return b""

    watchdog = BladeWatchdog(board, send, receive)
    words = board.words
    ended, tripped_ns = False, 0  # without any beat there is nothing to bring to rest
    while True:
        now_ns = time.monotonic_ns()
        beat_ns = words[BEAT]
        if watchdog.acting:
            due_ns = watchdog.step(now_ns)
            if due_ns is None:
                # A driver that beat again may have been killed right after that: then once more.
                if ended and words[BEAT] == watchdog.beat_ns:
                    return
                tripped_ns = watchdog.beat_ns
                continue
        elif ended:
            if words[STATE] == CLOSED:
                return
            watchdog.begin(now_ns)
            continue
        elif beat_ns == tripped_ns:
            due_ns = now_ns + LOOK_NS
        else:
            felt = min(board.levels) < REST
            due_ns = beat_ns + (WATCHDOG_NS if felt else REST_WATCHDOG_NS)
            if now_ns >= due_ns:
                watchdog.begin(now_ns)
                continue
            if not felt:
                due_ns = min(due_ns, now_ns + WATCHDOG_NS // 2)
        waits = [socket] if watchdog.acting else []
        if not ended:
            waits.append(lifeline)
        left_s = max(due_ns - time.monotonic_ns(), 0) / 1e9
        ready, _, _ = select.select(waits, (), (), left_s)
        if lifeline in ready and not ended:
            ended = not os.read(lifeline, 1)


def main(memory, lifeline, socket):
    """Watch by these descriptors."""
    for number in (signal.SIGINT, signal.SIGHUP, signal.SIGTERM):
        signal.signal(number, signal.SIG_IGN)  # it ends when its driver has ended
    try:  # noqa: SIM105 - contextlib takes time to load
        os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(_ABOVE_THE_HOST))
    except OSError:
        pass  # as its driver has to do without
    os.set_blocking(socket, False)
    board = Board(mmap.mmap(memory, MEMORY_BYTES))
    os.write(1, b".")
    os.close(1)
    watch(board, lifeline, socket)


if __name__ == "__main__":
    main(*map(int, sys.argv[1:4]))
