"""The process that drives a conventional display: cells come, and its keys go out.

It looks for the display as long as it is not there, shows again what should stand on it when it
comes back, and ends with its orders.
"""

from __future__ import annotations

import select
import sys
import time
from functools import partial
from typing import TYPE_CHECKING, Final

from vbraille.conventional.brlapi import (
    BrlapiDisplay,
    CellsTaken,
    CellsWanted,
    DisplayAway,
    DisplayGoneError,
)
from vbraille.workers import begin

if TYPE_CHECKING:
    from collections.abc import Callable

    from vbraille.conventional.brlapi import FromDisplay
    from vbraille.workers import Incoming

CHECK_S: Final = 0.5  # from one question whether the display is still there to the next
_URGENT: Final = -10


class Driving:
    """Driving of one display.

    Parameters
    ----------
    orders
        Cells that are wanted.
    tell
        Function that is called with each message.
    open_display
        Function that opens the display.
    """

    def __init__(
        self,
        orders: Incoming[CellsWanted],
        tell: Callable[[FromDisplay], None],
        open_display: Callable[[], BrlapiDisplay],
    ) -> None:
        self._orders = orders
        self._tell = tell
        self._open_display = open_display
        self._wanted = CellsWanted(0, b"")

    def run(self) -> None:
        """Drive the display until the orders end."""
        while not self._orders.ended:
            if self._wanted.cells is None:
                self._orders.wait()
                self._take()
                continue
            try:
                display = self._open_display()
            except DisplayGoneError as error:
                self._tell(DisplayAway(str(error)))
                if self._orders.wait(CHECK_S):
                    self._take()
                    time.sleep(0 if self._orders.ended else CHECK_S)
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
            orders, keys = self._orders.descriptor, display.descriptor
            if orders in select.select([orders, keys], [], [], wait_s)[0]:
                changed = self._take()
                if self._orders.ended or self._wanted.cells is None:
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
        wanted = self._orders.take()
        if wanted:
            self._wanted = wanted[-1]
        return bool(wanted)

    def _show(self, display: BrlapiDisplay) -> None:
        display.write(self._wanted.cells or b"")
        self._tell(CellsTaken(self._wanted.number, time.monotonic_ns()))


def main() -> int:
    """Drive the display of the BRLTTY whose address is an argument; empty: the usual one."""
    # As BRLTTY itself has it: what is told now is to be felt now, however busy the machine is.
    orders, told = begin(CellsWanted, _URGENT)
    try:
        Driving(orders, told.put, partial(BrlapiDisplay, sys.argv[2])).run()
    except BrokenPipeError:  # the parent is gone
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
