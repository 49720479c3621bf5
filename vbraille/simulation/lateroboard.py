"""The inside of a simulated Latero: what it answers to a datagram, without I/O and without time.

It is as the real one to the author's own client, which numbers nothing: it answers every client,
shows what it is told last, and has no watchdog.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from vbraille.devices.latero.wire import (
    BLADES,
    BUTTONS,
    CONTROLLER,
    FULL,
    FULLR0,
    NO_BUTTON,
    NO_IO,
    PAGE,
    POWERED_OFF,
    POWERED_ON,
    RAW,
    REST,
    WRITE,
    Answer,
    LateroRequest,
    RawAnswer,
    pack_answer,
    pack_raw_answer,
    parse_request,
)

_VERSION: Final = 0x0100  # version 1, revision 0, of both boards
STATUS: Final = 0x00  # ours: which register switches the real one's power is not published
_HALF: Final = 0x8000


class LateroBoard:
    """The boards of a Latero.

    Attributes
    ----------
    levels : uint8[64]
        Levels of the blades, by the last FULL.
    powered : bool
        Whether motor power is on.
    encoders : tuple of four int
        Counts of the encoders.
    buttons : int
        Bits of the buttons that are held, bit 0 for the left one.
    interface : bool
        Whether the I/O interface is plugged in.
    encoder_errors : int
        Bits of the encoders that have lost steps.
    register : int or None
        Register of the controller that switches motor power; None if none does.
    fulls, raws, foreign, beyond : int
        How many requests of either kind were taken, how many datagrams were no requests, and how
        many blades were told a level above `REST`.
    """

    def __init__(self, register: int | None = STATUS) -> None:
        self.levels = np.full(BLADES, REST, np.uint8)
        self.powered = self.interface = True
        self.encoders: tuple[int, int, int, int] = (0, 0, 0, 0)
        self.buttons = self.encoder_errors = 0
        self.register = register
        self.fulls = self.raws = self.foreign = self.beyond = 0
        self._page = 0

    @property
    def at_rest(self) -> bool:
        """Tell whether all blades are at rest."""
        return bool((self.levels >= REST).all())

    @property
    def status(self) -> int:
        """Status word of the controller."""
        return _VERSION | (POWERED_ON if self.powered else POWERED_OFF) | self._page * PAGE

    def receive(self, datagram: bytes) -> bytes | None:
        """Take a datagram; give the answer, or None if it is no request."""
        request = parse_request(datagram)
        if request is None:
            self.foreign += 1
            return None
        if request.kind == RAW:
            self.raws += 1
            return pack_raw_answer(self._do(request))
        if request.kind == FULL:
            self.fulls += 1
            self._page ^= 1
            self.levels[:] = np.frombuffer(request.blades, np.uint8)
            self.beyond += int((self.levels > REST).sum())
        pressed = sum(mask for n, mask in enumerate(BUTTONS) if self.buttons >> n & 1)
        answer = Answer(
            sequence=request.sequence,
            dio_in=NO_BUTTON & ~pressed if self.interface else 0,
            controller=self.status,
            interface=_VERSION | self.encoder_errors if self.interface else NO_IO,
            encoders=self.encoders,
            adc=(_HALF, _HALF, _HALF, _HALF),
        )
        return pack_answer(answer, FULLR0 + self._page)

    def _do(self, request: LateroRequest) -> RawAnswer:
        """Read or write the register of motor power; any other one holds 0."""
        command, content = request.command, 0
        if command & CONTROLLER and request.address == self.register:
            if command & WRITE and request.data & (POWERED_OFF | POWERED_ON):
                self.powered = not request.data & POWERED_OFF
            content = self.status
        return RawAnswer(request.sequence, command, request.address, content)
