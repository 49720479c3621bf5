"""The Latero's watchdog: a process that does nothing but bring its blades to rest.

Nothing documents a watchdog in the Latero: a blade stays where the last datagram put it. So this
file is run by itself, beside the process that drives the Latero, before that sends anything to
feel. The driver beats in shared memory with each datagram. The watchdog acts when the driver has
not for `WATCHDOG_NS`, when it asks for rest by a byte in the pipe, and when its end of the pipe is
closed because it has ended: it takes the blades from their last levels to rest along a ramp,
switches motor power off, and says so again until the Latero has answered both, or for
`PATIENCE_NS`. Meanwhile the driver sends nothing. Whatever the reason, blades go to rest by this
file alone.

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
LOOK_NS = 10_000_000  # at most between two looks at the driver's beat

# The memory that is shared: words of 8 bytes, then two requests of 100 bytes.
BEAT = 0  # when the driver last sent something while frames are shown; 0 before
ACTING = 1  # whether blades are being brought to rest
TRIPS, AFTER = 2, 3  # how often the driver did not beat, and how long it had not
POWER = 4  # whether it is known how motor power is switched off
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
    """Memory that the driver and its watchdog share: at least `MEMORY_BYTES`."""

    def __init__(self, memory):
        view = memoryview(memory)
        self.words = view[:FULL_AT].cast("q")
        self.full = view[FULL_AT : FULL_AT + REQUEST_BYTES]
        self.levels = self.full[LEVELS_AT : LEVELS_AT + BLADES]
        self.off = view[OFF_AT : OFF_AT + REQUEST_BYTES]


class Watchdog:
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
    """

    def __init__(self, board, send, receive):
        self.acting = False
        self._board, self._send, self._receive = board, send, receive
        self._begun_ns = self._due_ns = 0
        self._acted_ns = 0  # beat of the driver when the blades were last brought to rest
        self._from = b""
        self._request = bytearray(REQUEST_BYTES)
        self._sequence = 0x8000
        self._resting = None  # number of the first request that had all blades at rest
        self._rested = self._unpowered = False

    def begin(self, now_ns):
        """Begin to bring the blades to rest, from the levels where they are."""
        board = self._board
        self.acting = True
        self._begun_ns = self._due_ns = max(self._due_ns, now_ns)
        self._request[:] = board.full
        self._from = bytes(board.levels)
        self._resting = None
        self._rested = False
        self._unpowered = not board.words[POWER]
        board.words[ACTING] = 1

    def step(self, now_ns):
        """Do what is due; give the time of the next step at the latest."""
        words = self._board.words
        if not self.acting:
            beat_ns = words[BEAT]
            felt = min(self._board.levels) < REST
            left_ns = beat_ns + (WATCHDOG_NS if felt else REST_WATCHDOG_NS) - now_ns
            if beat_ns == self._acted_ns or left_ns > 0:
                return now_ns + (min(left_ns, LOOK_NS) if left_ns > 0 else LOOK_NS)
            words[TRIPS] += 1
            words[AFTER] = now_ns - beat_ns
            self.begin(now_ns)
        self._hear()
        passed_ns = now_ns - self._begun_ns
        if (self._rested and self._unpowered) or passed_ns > PATIENCE_NS:
            self.acting, self._acted_ns, words[ACTING] = False, words[BEAT], 0
            return now_ns
        if now_ns >= self._due_ns:
            self._say(passed_ns)
            self._due_ns = now_ns + (STEP_NS if self._resting is None else AGAIN_NS)
        return self._due_ns

    def _say(self, passed_ns):
        """Send the blades on along the ramp, and at its end switch motor power off."""
        # The first step is one: what was to be done after 50 ms is not put off by another.
        way = -(-REST * (passed_ns + STEP_NS) // RAMP_NS)
        levels = bytes(min(REST, level + way) for level in self._from)
        self._request[LEVELS_AT : LEVELS_AT + BLADES] = levels
        self._board.levels[:] = levels
        self._number(self._request)
        if self._resting is None and min(levels) == REST:
            self._resting = self._sequence
        self._send(self._request)
        if self._resting is not None and not self._unpowered:
            off = bytearray(self._board.off)
            self._number(off)
            self._send(off)
            # Its effect is told by the next answer.
            self._number(self._request)
            self._send(self._request)

    def _number(self, request):
        self._sequence = (self._sequence + 1) & 0xFFFF
        request[SEQUENCE_AT : SEQUENCE_AT + 2] = self._sequence.to_bytes(2, "big")

    def _hear(self):
        while answer := self._receive():
            if len(answer) != FULLR_BYTES or answer[TYPE_AT] not in FULLR or self._resting is None:
                continue
            sequence = int.from_bytes(answer[SEQUENCE_AT : SEQUENCE_AT + 2], "big")
            if (sequence - self._resting) & 0xFFFF < 0x8000:
                self._rested = True
                if answer[CONTROLLER_AT + 1] & POWERED_OFF:
                    self._unpowered = True


def speaking(board, socket):
    """Make a watchdog that speaks through the descriptor of a socket, which does not block."""

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

    return Watchdog(board, send, receive)


def watch(board, lifeline, socket):
    """Watch until the driver has ended and the blades are at rest."""
    watchdog, ended = speaking(board, socket), False
    while watchdog.acting or not ended:
        due_ns = watchdog.step(time.monotonic_ns())
        waits = [socket] if watchdog.acting else []
        if not ended:
            waits.append(lifeline)
        left_s = max(due_ns - time.monotonic_ns(), 0) / 1e9
        ready, _, _ = select.select(waits, (), (), left_s)
        if lifeline in ready:
            ended = not os.read(lifeline, 64)
            if board.words[BEAT] or not ended:  # else nothing was ever shown
                watchdog.begin(time.monotonic_ns())


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
