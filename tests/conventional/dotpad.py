"""A Dot Pad at a pseudo-terminal, written from its protocol's description alone."""

import os
import struct

from tests.conventional.plugged import PluggedDisplay

PATIENCE_S = 20.0
FEATURES = 0x80 | 0x40 | 0x08 | 0x04 | 0x02
BOARD = bytes((FEATURES, 1, 24, 4, 1, 20, 0, 1, 10, 30, 0, 3))
TEXT_ONLY = bytes((0x40, 1, 24, 0, 1, 20, 0, 1, 0, 0, 0, 0))
PERKINS, ROUTING, FUNCTION = 0x0312, 0x0322, 0x0332
PAN_RIGHT, NAV_UP = 14, 17


def checksum(body):
    """The checksum of a packet's bytes from its destination on."""
    found = 0xA5
    for byte in body:
        found ^= byte
    return found


def packet(command, content=b"", destination=0):
    """The bytes of a packet."""
    body = bytes([destination]) + struct.pack(">HB", command, 0) + bytes(content)
    return b"\xaa\x55" + struct.pack(">H", len(body) + 1) + body + bytes([checksum(body)])


class SimulatedDotPad(PluggedDisplay):
    """The display.

    Parameters
    ----------
    link
        Path at which the port is found.
    board
        What it says of itself.
    answers
        What it says of the lines that come first, in order; afterwards each is taken (0).
    """

    def __init__(self, link, board=BOARD, answers=()):
        super().__init__(link)
        self.lines = {}  # pins that stand on each line
        self.came = []  # destinations of lines, in order
        self.faults = []  # packets that a Dot Pad would not take
        self._board = board
        self._answers = list(answers)
        self.plug()

    def plug(self):
        """Plug it in; nothing stands on it."""
        self.lines.clear()
        super().plug()

    def press(self, group, number, size=4):
        """Press a key of a group, and let go of it."""
        down = bytearray(size)
        down[number // 8] = 0x80 >> number % 8
        os.write(self._master, packet(group, down) + packet(group, bytes(size)))

    def wait(self, lines):
        """Wait until these pins stand on these lines."""
        with self._changed:
            assert self._changed.wait_for(
                lambda: all(self.lines.get(at) == pins for at, pins in lines.items()), PATIENCE_S
            ), (lines, self.lines, self.faults)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.unplug()

    def _answer(self, told):
        while len(told) >= 4:
            end = 4 + struct.unpack_from(">H", told, 2)[0]
            if len(told) < end:
                break
            self._answer_packet(told[:end])
            told = told[end:]
        return told

    def _answer_packet(self, told):
        body = told[4:-1]
        if told[:2] != b"\xaa\x55" or told[-1] != checksum(body):
            self.faults.append(told)
            return
        (command,), destination, content = struct.unpack_from(">H", body, 1), body[0], body[4:]
        if command == 0x0110:
            # Something of another packet comes first, as when it was switched on in the middle.
            os.write(self._master, b"\x55\xaa\x55\xff" + packet(0x0111, self._board))
        elif command == 0x0100:
            os.write(self._master, packet(0x0101, b"DotPad320 "))
        elif command == 0x0200:
            code = self._answers.pop(0) if self._answers else 0
            os.write(self._master, packet(0x0201, [code], destination))
            with self._changed:
                self.came.append(destination)
                if code == 0:
                    assert content[0] == 0
                    self.lines[destination] = content[1:]
                self._changed.notify_all()
            if code == 0:
                os.write(self._master, packet(0x0202, [0], destination))
