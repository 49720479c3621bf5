"""The process that drives a display, with a display made of values at one end."""

import os

import pytest

from vbraille.conventional.brlapi import (
    CellsTaken,
    CellsWanted,
    DisplayAway,
    DisplayGoneError,
    DisplayStands,
    KeyPressed,
)
from vbraille.conventional.driving import Driving
from vbraille.workers import Incoming, Outgoing

STANDS = DisplayStands("Made", "of values", 4)


class Pins:
    """A display whose keys are ready as long as its pipe has bytes."""

    def __init__(self, gone_after=None):
        self.written = []
        self.closed = False
        self.on_close = lambda: None
        self._gone_after = gone_after
        self.descriptor, self._keys = os.pipe()
        os.set_blocking(self.descriptor, False)

    def press(self):
        os.write(self._keys, b"k")

    def check(self):
        return STANDS

    def write(self, cells):
        if len(self.written) == self._gone_after:
            raise DisplayGoneError("it is gone")
        self.written.append(cells)

    def pressed(self):
        try:
            return [KeyPressed("LNDN")] * len(os.read(self.descriptor, 100))
        except BlockingIOError:
            return []

    def close(self):
        if not self.closed:
            os.close(self.descriptor)
            os.close(self._keys)
            self.on_close()
        self.closed = True


@pytest.fixture
def orders():
    reads, writes = os.pipe()
    yield Incoming(reads, CellsWanted), Outgoing(writes).put, writes
    os.close(reads)


def test_the_newest_is_shown_keys_are_told_and_the_end_leaves_it_blank(orders):
    reads, want, writes = orders
    pins, told = Pins(), []

    def tell(message):
        told.append(message)
        if message == KeyPressed("LNDN"):
            os.close(writes)

    want(CellsWanted(1, b"\1"))
    want(CellsWanted(2, b"\2"))
    pins.press()
    Driving(reads, tell, lambda: pins).run()
    # What waited came before anything that was wanted later.
    assert pins.written == [b"", b"\2", b""]
    assert pins.closed
    assert [m for m in told if not isinstance(m, CellsTaken)] == [STANDS, KeyPressed("LNDN")]
    assert [m.number for m in told if isinstance(m, CellsTaken)] == [0, 2]


def test_what_should_stand_there_is_shown_again_when_it_comes_back(orders):
    reads, want, writes = orders
    first, second, told = Pins(gone_after=1), Pins(), []
    displays = [first, second]

    def tell(message):
        told.append(message)
        if isinstance(message, CellsTaken) and displays == []:
            os.close(writes)

    want(CellsWanted(7, b"\7"))
    Driving(reads, tell, lambda: displays.pop(0)).run()
    assert DisplayAway("it is gone") in told
    assert (first.written, first.closed) == ([b""], True)
    assert second.written[0] == b"\7"


def test_it_is_given_back_until_cells_are_wanted_again(orders):
    reads, want, writes = orders
    first, second, taken = Pins(), Pins(), []
    displays = [first, second]
    first.on_close = lambda: want(CellsWanted(3, b"\3"))

    def tell(message):
        if isinstance(message, CellsTaken):
            taken.append(message.number)
            if message.number == 0:
                want(CellsWanted(2, None))
            else:
                os.close(writes)

    Driving(reads, tell, lambda: displays.pop(0)).run()
    assert (first.written, second.written) == ([b"", b""], [b"\3", b""])
    assert taken == [0, 3]
