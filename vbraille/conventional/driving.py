"""The process that drives a conventional display: cells on standard input, its keys on output.

It looks for the display as long as it is not there, shows again what should stand on it when it
comes back, and ends with its standard input.
"""

from __future__ import annotations

import os
import select
import sys
import time
from contextlib import suppress
from functools import partial
from typing import TYPE_CHECKING, Final

from vbraille.conventional.brlapi import BrlapiDisplay, DisplayGoneError
from vbraille.conventional.messages import (
    TO_JSON,
    WANTED_FROM_JSON,
    CellsTaken,
    CellsWanted,
    DisplayAway,
)

if TYPE_CHECKING:
    from collections.abc import Callable

    from vbraille.conventional.messages import FromDisplay

CHECK_S: Final = 0.5  # from one question whether the display is still there to the next
_PIPE_BYTES: Final = 1 << 16  # all that a pipe holds
_URGENT: Final = -10


class Driving:
    """Driving of one display.

    Parameters
    ----------
    orders
        Descriptor from which `CellsWanted` come, a line of JSON each.
    tell
        Function that is called with each message.
    open_display
        Function that opens the display.
    """

    def __init__(
        self,
        orders: int,
        tell: Callable[[FromDisplay], None],
        open_display: Callable[[], BrlapiDisplay],
    ) -> None:
        self._orders = orders
        self._tell = tell
        self._open_display = open_display
        self._begun = b""  # a line that has not come to its end
        self._wanted = CellsWanted(0, b"")
        self._ended = False

    def run(self) -> None:
        """Drive the display until the orders end."""
        while not self._ended:
            if self._wanted.cells is None:
                self._take()
                continue
            try:
                display = self._open_display()
            except DisplayGoneError as error:
                self._tell(DisplayAway(str(error)))
                if select.select([self._orders], [], [], CHECK_S)[0]:
                    self._take()
                    time.sleep(0 if self._ended else CHECK_S)
                continue
            try:
                self._drive(display)
            except DisplayGoneError as error:
                self._tell(DisplayAway(str(error)))
            finally:
                display.close()

    def _drive(self, display: BrlapiDisplay) -> None:
        """Show what is wanted until the display goes away, is to be given back, or orders end."""
        self._tell(display.check())
        self._show(display)
        due_s = time.monotonic() + CHECK_S
        while True:
            wait_s = max(0.0, due_s - time.monotonic())
            ready = select.select([self._orders, display.descriptor], [], [], wait_s)[0]
            if self._orders in ready:
                changed = self._take()
                if self._ended or self._wanted.cells is None:
                    display.write(b"")
                    return
                if changed:
                    self._show(display)
            if time.monotonic() >= due_s:
                self._tell(display.check())
                due_s = time.monotonic() + CHECK_S
            for key in display.pressed():
                self._tell(key)

    def _take(self) -> bool:
        """Take what is wanted, of several the newest; whether anything new is."""
        chunk = os.read(self._orders, _PIPE_BYTES)
        self._ended = not chunk
        *lines, self._begun = (self._begun + chunk).split(b"\n")
        if lines:
            self._wanted = WANTED_FROM_JSON.decode(lines[-1])
        return bool(lines)

    def _show(self, display: BrlapiDisplay) -> None:
        display.write(self._wanted.cells or b"")
        self._tell(CellsTaken(self._wanted.number, time.monotonic_ns()))


def main() -> int:
    """Drive the display of the BRLTTY whose address is the first argument; empty: the usual one."""

    def tell(message: FromDisplay) -> None:
        os.write(1, TO_JSON.encode(message) + b"\n")

    # As BRLTTY itself has it: what is told now is to be felt now, however busy the machine is.
    with suppress(PermissionError):
        os.nice(_URGENT)
    try:
        Driving(sys.stdin.fileno(), tell, partial(BrlapiDisplay, sys.argv[1])).run()
    except BrokenPipeError:  # whoever was told is gone
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
