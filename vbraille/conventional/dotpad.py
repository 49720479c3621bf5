"""A Dot Pad at a serial port, without BRLTTY. It was never tried on a real one."""

from __future__ import annotations

import os
import select
import termios
import time
from contextlib import suppress
from functools import partial
from typing import TYPE_CHECKING, Final

from serial import Serial, SerialTimeoutException

from vbraille.conventional.dotpadlines import (
    RETRY_S,
    DotPadLines,
    graphic_lines,
    graphic_size,
    text_lines,
)
from vbraille.conventional.dotpadpackets import (
    BAUD,
    DotPadCommand,
    DotPadPacket,
    board_of,
    decode_packets,
    encode_packet,
    is_keys,
    keys_down,
    keys_named,
)
from vbraille.conventional.driver import DisplayGoneError
from vbraille.conventional.messages import DisplayStands
from vbraille.conventional.opening import not_opened

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from vbraille.conventional.messages import KeyPressed

_DRIVER: Final = "DotPad"
_KIND: Final = "serial port"
_TRIES: Final = 3
_ANSWER_S: Final = 0.5  # for an answer to a question; all of them stay below the silence allowed
_END_S: Final = 1.0  # for lines to be taken away at the end
_WRITE_S: Final = 1.0
_BYTES: Final = 4096


class DotPadDisplay:
    """A `CellDriver` of a Dot Pad.

    Parameters
    ----------
    path
        Path of its serial port.
    pins
        Whether cells stand in its area of pins, and not on its line of text.

    Raises
    ------
    DisplayGoneError
        If there is no such port, it may not be opened, or no Dot Pad answers there.
    """

    def __init__(self, path: str, pins: bool = False) -> None:
        self._path = path
        self._received = b""
        self._heard = False
        self._down: dict[int, frozenset[int]] = {}  # keys that are down, by their command
        self._pressed: list[KeyPressed] = []
        self._lines = DotPadLines(0.0)
        self._lines_of: Callable[[bytes], Mapping[int, bytes]] = lambda _: {}
        try:
            # An inter-byte timeout of 0 has a read tell a line that was hung up from a quiet one.
            self._port = Serial(
                path,
                BAUD,
                timeout=0,
                inter_byte_timeout=0.0,
                write_timeout=_WRITE_S,
                exclusive=True,
            )
        except OSError as fault:
            raise not_opened(fault, path, _KIND) from None
        except (termios.error, ValueError):
            raise not_opened(OSError(), path, _KIND) from None
        self._open, self._gone = True, False
        self._descriptor: int = self._port.fileno()
        try:
            self._meet(pins)
        except DisplayGoneError:
            self.close()
            raise

    def _meet(self, pins: bool) -> None:
        """Ask what it is, and choose its area."""
        where = f"at {self._path}"
        board = board_of(self._ask(DotPadCommand.ASK_BOARD, DotPadCommand.TELL_BOARD, _TRIES))
        if board is None and self._heard:
            raise DisplayGoneError(f"what is {where} is no Dot Pad; give another port")
        if board is None:
            raise DisplayGoneError(
                f"no Dot Pad answers {where}; switch it on, or give another port"
            )
        name = self._ask(DotPadCommand.ASK_NAME, DotPadCommand.TELL_NAME, 1)
        model = name.decode("ascii", "replace").strip(" \0")
        if pins and board.graphic is None:
            raise DisplayGoneError(
                f"the Dot Pad {where} has no area of pins; leave ?pins out for its line of text"
            )
        text, graphic = board.text, board.graphic
        if graphic is not None and (pins or text is None):
            rows, columns = graphic_size(graphic, board.cell_height)
            self._lines_of = partial(graphic_lines, area=graphic, cell_height=board.cell_height)
            self._lines = DotPadLines(graphic.refresh_s)
        else:
            assert text is not None  # a board has one area or both
            rows, columns = text.rows, text.columns
            self._lines_of = partial(text_lines, area=text)
            self._lines = DotPadLines(text.refresh_s)
        self._stands = DisplayStands(_DRIVER, model.removeprefix(_DRIVER), columns, rows)

    @property
    def descriptor(self) -> int:
        """Number of the port's open file."""
        return self._descriptor

    def check(self) -> DisplayStands:
        """Say what it is, if nothing that was sent is without an answer."""
        self._go_on()
        return self._stands

    def write(self, cells: bytes) -> None:
        """Have cells stand there: the first line that changes is sent, the others follow it."""
        self._lines.want(self._lines_of(cells))
        self._go_on()

    def pressed(self) -> list[KeyPressed]:
        """Take what has come, send the next line if it is due, and give the keys."""
        self._go_on()
        pressed, self._pressed = self._pressed, []
        return pressed

    def close(self) -> None:
        """Close the port when what is wanted stands there, or after a second."""
        if not self._open:
            return
        end_s = time.monotonic() + _END_S
        with suppress(DisplayGoneError):
            while not (self._gone or self._lines.settled) and self._wait(end_s):
                self._go_on()
        self._open = False
        with suppress(OSError, termios.error):
            self._port.close()

    def _go_on(self) -> None:
        """Take what has come, and send the next line if it is due."""
        now_s = time.monotonic()
        for packet in self._receive():
            self._lines.take(packet, now_s)
        if self._lines.silent(now_s):
            raise DisplayGoneError(
                f"the Dot Pad at {self._path} answers no more; switch it on, or plug it in again"
            )
        if self._lines.refused:
            raise DisplayGoneError(
                f"the Dot Pad at {self._path} takes no lines; switch it off and on again"
            )
        self._send(self._lines.send(now_s))

    def _ask(self, question: DotPadCommand, answer: DotPadCommand, tries: int) -> bytes:
        """Ask, and give what the answer carries; empty if none comes."""
        for _ in range(tries):
            self._send(encode_packet(DotPadPacket(question)))
            end_s = time.monotonic() + _ANSWER_S
            while self._wait(end_s):
                for packet in self._receive():
                    if packet.command == answer:
                        return packet.content
        return b""

    def _wait(self, end_s: float) -> bool:
        """Wait until something has come, a little while, or until a time; whether that is left."""
        left_s = end_s - time.monotonic()
        if left_s > 0:
            select.select([self._descriptor], [], [], min(left_s, RETRY_S))
        return left_s > 0

    def _receive(self) -> list[DotPadPacket]:
        """Take the packets that have come, and note which keys they say are down."""
        try:
            chunk = os.read(self._descriptor, _BYTES)
        except BlockingIOError:
            return []
        except OSError:
            raise self._unplugged() from None
        if not chunk:
            raise self._unplugged()
        self._heard = True
        packets, self._received = decode_packets(self._received + chunk)
        for packet in packets:
            if is_keys(packet.command):
                down = keys_down(packet.content)
                pressed = down - self._down.get(packet.command, frozenset())
                self._pressed += keys_named(packet.command, pressed)
                self._down[packet.command] = down
        return packets

    def _send(self, sent: bytes) -> None:
        if not sent:
            return
        try:
            self._port.write(sent)
        except SerialTimeoutException:
            raise DisplayGoneError(
                f"the Dot Pad at {self._path} takes nothing; switch it off and on again"
            ) from None
        except (OSError, termios.error):
            raise self._unplugged() from None

    def _unplugged(self) -> DisplayGoneError:
        self._gone = True
        return DisplayGoneError(f"the Dot Pad at {self._path} is gone; plug it in again")
