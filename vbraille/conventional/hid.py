"""A braille display that Linux has as a human interface device. It was never tried on a real one.

The kernel hands its reports through a file (/dev/hidraw0 and so on): one report a read or write.
"""

from __future__ import annotations

import fcntl
import os
import struct
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Final

from vbraille.conventional.driver import DisplayGoneError
from vbraille.conventional.hidbraille import braille_of
from vbraille.conventional.messages import DisplayStands
from vbraille.conventional.opening import not_opened

if TYPE_CHECKING:
    from vbraille.conventional.hidbraille import HidBraille
    from vbraille.conventional.messages import KeyPressed

DEVICES: Final = Path("/sys/class/hidraw")
_DRIVER: Final = "HID"
_KIND: Final = "HID device"
_MOST_BYTES: Final = 4096  # of a descriptor (HID_MAX_DESCRIPTOR_SIZE), and of a report
_DESCRIPTOR: Final = struct.Struct(f"=I{_MOST_BYTES}s")
_NAME_BYTES: Final = 256
# Questions of linux/hidraw.h: HIDIOCGRDESCSIZE, HIDIOCGRDESC, HIDIOCGRAWNAME.
SIZE, DESCRIPTOR, NAME = 1, 2, 4
_READ: Final = 2 << 30


class HidDisplay:
    """A `CellDriver` of a braille display whose reports go through an open file.

    Parameters
    ----------
    descriptor
        Number of the open file, which does not wait; it is closed in the end.
    braille
        What its report descriptor says.
    name
        Name of the display.
    path
        Path of the file, for people.
    """

    def __init__(self, descriptor: int, braille: HidBraille, name: str, path: str) -> None:
        self._descriptor = descriptor
        self._braille = braille
        self._path = path
        self._stands = DisplayStands(_DRIVER, name, braille.columns, len(braille.rows))
        self._down: dict[int, frozenset[KeyPressed]] = {}  # by the report that tells of them
        self._pressed: list[KeyPressed] = []
        self._open = True

    @property
    def descriptor(self) -> int:
        """Number of the open file."""
        return self._descriptor

    def check(self) -> DisplayStands:
        """Say what it is, if it is there."""
        self._take()
        return self._stands

    def write(self, cells: bytes) -> None:
        """Have cells stand there."""
        for report in self._braille.packed(cells):
            try:
                os.write(self._descriptor, report)
            except OSError:
                raise self._gone() from None

    def pressed(self) -> list[KeyPressed]:
        """Take the keys that have come."""
        self._take()
        pressed, self._pressed = self._pressed, []
        return pressed

    def close(self) -> None:
        """Close the file."""
        if self._open:
            self._open = False
            os.close(self._descriptor)

    def _take(self) -> None:
        while True:
            try:
                told = os.read(self._descriptor, _MOST_BYTES)
            except BlockingIOError:
                return
            except OSError:
                raise self._gone() from None
            if not told:
                raise self._gone()
            report, down = self._braille.keys_down(told)
            new = down - self._down.get(report, frozenset())
            self._pressed += sorted(new, key=lambda key: (key.name, key.argument))
            self._down[report] = down

    def _gone(self) -> DisplayGoneError:
        return DisplayGoneError(f"the braille display at {self._path} is gone; plug it in again")


def open_hid(path: str = "", devices: Path = DEVICES) -> HidDisplay:
    """Open a braille display.

    Parameters
    ----------
    path
        Path of its file; empty for the first that the system has.
    devices
        Directory in which the system describes such files.

    Raises
    ------
    DisplayGoneError
        If there is none, it may not be opened, or it is no braille display.
    """
    path = path or _found(devices)
    try:
        descriptor = os.open(path, os.O_RDWR | os.O_NONBLOCK | os.O_CLOEXEC)
    except OSError as fault:
        raise not_opened(fault, path, _KIND) from None
    try:
        (size,) = struct.unpack("=I", asked(descriptor, SIZE, bytes(4)))
        whole = asked(descriptor, DESCRIPTOR, _DESCRIPTOR.pack(size, b""))
        _, told = _DESCRIPTOR.unpack(whole)
        name = asked(descriptor, NAME, bytes(_NAME_BYTES))
    except OSError as fault:
        os.close(descriptor)
        raise not_opened(fault, path, _KIND) from None
    braille = braille_of(told[:size])
    if braille is None:
        os.close(descriptor)
        raise DisplayGoneError(
            f"{path} is no braille display by its descriptor; give another path, or hid for the "
            f"first that there is"
        )
    said = name.partition(b"\0")[0].decode("utf-8", "replace")
    return HidDisplay(descriptor, braille, said, path)


def request(question: int, size: int) -> int:
    """Number of a question to the kernel's driver, with room for so many bytes of answer.

    >>> hex(request(SIZE, 4)), hex(request(DESCRIPTOR, 4100))
    ('0x80044801', '0x90044802')
    """
    return _READ | size << 16 | ord("H") << 8 | question


def asked(descriptor: int, question: int, content: bytes) -> bytes:
    """Ask the kernel's driver something.

    Parameters
    ----------
    descriptor
        Number of the open file.
    question
        What is asked: `SIZE`, `DESCRIPTOR` or `NAME`.
    content
        What is asked with, of the length of the answer.

    Raises
    ------
    OSError
        If it is another file.
    """
    answer = bytearray(content)  # Python lends the kernel only what can be written to, if long
    fcntl.ioctl(descriptor, request(question, len(answer)), answer)
    return bytes(answer)


def _found(devices: Path) -> str:
    """Path of the first file whose descriptor, which everybody may read, has a braille display."""
    for device in sorted(devices.glob("hidraw*"), key=lambda found: (len(found.name), found.name)):
        with suppress(OSError):
            if braille_of((device / "device" / "report_descriptor").read_bytes()) is not None:
                return f"/dev/{device.name}"
    raise DisplayGoneError(
        "there is no braille display of HID; plug one in, or give its path, as in hid:/dev/hidraw0"
    )
