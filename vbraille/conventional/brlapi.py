"""A display that BRLTTY drives, through BRLTTY's own library.

The library is called by ctypes: Debian's Python binding of it is for Debian's Python only, and
twelve functions are all that is needed. What a connection actually uses (its last argument) is
not asked for, since the library leaves garbage there.
"""

from __future__ import annotations

import ctypes
import re
from functools import cache
from typing import TYPE_CHECKING, Any, Final

import msgspec

from vbraille.errors import DeviceError, InputError
from vbraille.wording import setting

if TYPE_CHECKING:
    from collections.abc import Iterator


class CellsWanted(msgspec.Struct, frozen=True):
    """Cells that are to stand on the display.

    Parameters
    ----------
    number
        Number of what is shown; it grows.
    cells
        Dot masks of the cells from the left, as many as there are; the others are blank. None to
        give the display back to other programs until cells are wanted again.
    """

    number: int
    cells: bytes | None


class DisplayStands(msgspec.Struct, frozen=True, tag=True):
    """The display is there, and takes cells.

    Parameters
    ----------
    driver
        Name of its driver, such as HandyTech.
    model
        What the driver calls its model; empty if it does not say it.
    columns, rows
        Number of its cells in a row, and of its rows.
    """

    driver: str
    model: str
    columns: int
    rows: int = 1

    @property
    def title(self) -> str:
        """Name of the display for people."""
        return f"{self.driver} {self.model}".strip()


class DisplayAway(msgspec.Struct, frozen=True, tag=True):
    """The display is not there, or takes no cells.

    Parameters
    ----------
    why
        Why, and what helps, in words for people.
    """

    why: str


class CellsTaken(msgspec.Struct, frozen=True, tag=True):
    """Cells have been given to what drives the display's pins.

    Parameters
    ----------
    number
        Number of what was shown.
    at_ns
        Time of that by the machine's monotonic clock, in ns.
    """

    number: int
    at_ns: int


class KeyPressed(msgspec.Struct, frozen=True, tag=True):
    """A key of the display was pressed.

    Parameters
    ----------
    name
        Name of the command that it stands for, as BRLTTY has it, such as FWINRT or ROUTE.
    argument
        Number that belongs to it: of ROUTE the cell, from 0.
    """

    name: str
    argument: int = 0


class KeyTyped(msgspec.Struct, frozen=True, tag=True):
    """Something was typed on the keyboard of the display.

    Parameters
    ----------
    key
        The character, or the name of the key, as a terminal's keys are named.
    """

    key: str


FromDisplay = DisplayStands | DisplayAway | CellsTaken | KeyPressed | KeyTyped


LIBRARY: Final = "libbrlapi.so.0.8"
_SPEC: Final = re.compile(r"brlapi(?::(|[^\s:]*:[0-9]{1,5}|/\S+))?")
_NO_DRIVER: Final = "NoBraille"
_ONLINE: Final = 9  # BRLAPI_PARAM_DEVICE_ONLINE
_GLOBAL: Final = 1  # BRLAPI_PARAMF_GLOBAL
_WHERE_I_AM: Final = -1  # BRLAPI_TTY_DEFAULT
_TEXT_BYTES: Final = 256
# Errors of the library (enum brlapi_error) that people can do something about.
_REFUSED, _GAI, _LIBC, _VERSION, _EOF, _AUTHENTICATION = 8, 10, 11, 13, 14, 17
_TYPE_MASK: Final = 0xE000_0000
_COMMAND: Final = 0x2000_0000
_SYMBOL_MASK: Final = 0x1FFF_FFFF
# Keys of X11's keysymdef.h that are no characters, by the names that a terminal's keys have.
_NAMED: Final = {
    0xFF08: "\x7f",
    0xFF09: "\t",
    0xFF0D: "\n",
    0xFF1B: "escape",
    0xFF50: "home",
    0xFF51: "left",
    0xFF52: "up",
    0xFF53: "right",
    0xFF54: "down",
    0xFF55: "pageup",
    0xFF56: "pagedown",
    0xFF57: "end",
    0xFF63: "insert",
    0xFFFF: "delete",
    **{0xFFBE + number: f"f{number + 1}" for number in range(12)},
}
_UNICODE: Final = 0x0100_0000  # keysyms of all other characters begin here


class _Settings(ctypes.Structure):
    _fields_ = (("auth", ctypes.c_char_p), ("host", ctypes.c_char_p))


class _Error(ctypes.Structure):
    _fields_ = (
        ("number", ctypes.c_int),
        ("libc", ctypes.c_int),
        ("gai", ctypes.c_int),
        ("function", ctypes.c_char_p),
    )


class _KeyCode(ctypes.Structure):
    """brlapi_describedKeyCode_t."""

    _fields_ = (
        ("type", ctypes.c_char_p),
        ("command", ctypes.c_char_p),
        ("argument", ctypes.c_uint),
        ("flags", ctypes.c_uint),
        ("flag", ctypes.c_char_p * 32),
        ("values", ctypes.c_uint * 4),
    )


_Handler = ctypes.CFUNCTYPE(
    None, ctypes.c_void_p, ctypes.c_int, ctypes.c_uint32, ctypes.c_void_p, ctypes.c_size_t
)


class DisplayGoneError(DeviceError):
    """The display is not there, or no longer; it may come back. The message says what helps."""


def host_of(spec: str) -> str:
    """Give the address in the spec of a display, once BRLTTY's library is loaded.

    Parameters
    ----------
    spec
        "brlapi", or "brlapi:HOST:N" for BRLTTY at another address.

    Returns
    -------
    str
        Address for `BrlapiDisplay`.

    Raises
    ------
    InputError
        If the text is no spec, or the library is not installed.
    """
    found = _SPEC.fullmatch(spec)
    if found is None:
        raise InputError(
            f"{setting('also')} is {spec!r}; give brlapi for the display of BRLTTY on this "
            f"machine, or brlapi:HOST:N, as in brlapi:127.0.0.1:0, for one elsewhere"
        )
    load_library()
    return found[1] or ""


@cache
def load_library(name: str = LIBRARY) -> Any:
    """Load BRLTTY's library.

    Parameters
    ----------
    name
        File name of the library.

    Raises
    ------
    InputError
        If it is not installed.
    """
    try:
        library = ctypes.CDLL(name)
    except OSError:
        raise InputError(
            f"{setting('also')} brlapi needs BRLTTY's library {name}; install Debian's "
            f"packages brltty and libbrlapi0.8, or leave it out"
        ) from None
    library.brlapi_getHandleSize.restype = ctypes.c_size_t
    library.brlapi_error_location.restype = ctypes.POINTER(_Error)
    library.brlapi_strerror.restype = ctypes.c_char_p
    library.brlapi__getParameter.restype = ctypes.c_ssize_t
    library.brlapi__getParameter.argtypes = (
        *(ctypes.c_void_p, ctypes.c_int, ctypes.c_uint64, ctypes.c_uint32),
        *(ctypes.c_void_p, ctypes.c_size_t),
    )
    library.brlapi__setExceptionHandler.restype = ctypes.c_void_p
    library.brlapi_describeKeyCode.argtypes = (ctypes.c_uint64, ctypes.POINTER(_KeyCode))
    return library


class BrlapiDisplay:
    """The display that a BRLTTY drives. A method raises `DisplayGoneError` if it is gone.

    Parameters
    ----------
    host
        Where BRLTTY listens: "HOST:N", or ":N" on this machine; empty for the usual place.

    Raises
    ------
    DisplayGoneError
        If no BRLTTY answers, it lets no program in, or it has no display.
    InputError
        If its library is not installed.
    """

    def __init__(self, host: str = "") -> None:
        self._library = library = load_library()
        self._where = f"at {host}" if host else "on this machine"
        self._handle = ctypes.create_string_buffer(library.brlapi_getHandleSize())
        self._refused = 0  # error that BRLTTY has told by itself
        settings = _Settings(None, host.encode() or None)
        self._descriptor: int = library.brlapi__openConnection(
            self._handle, ctypes.byref(settings), None
        )
        self._open = self._descriptor >= 0
        if not self._open:
            raise self._gone()
        # Unless told otherwise, the library ends the process when BRLTTY refuses something.
        self._handler = _Handler(self._take_refusal)
        library.brlapi__setExceptionHandler(self._handle, self._handler)
        try:
            self.check()
            self._enter()
        except DisplayGoneError:
            self.close()
            raise

    @property
    def descriptor(self) -> int:
        """Number of the connection's open file."""
        return self._descriptor

    def check(self) -> DisplayStands:
        """Ask BRLTTY which display it drives, and whether that is plugged in."""
        driver = self._text(self._library.brlapi__getDriverName)
        columns, rows = ctypes.c_uint(), ctypes.c_uint()
        self._do(self._library.brlapi__getDisplaySize, ctypes.byref(columns), ctypes.byref(rows))
        # Without a display BRLTTY says that it has one of one cell, or of none.
        if driver == _NO_DRIVER or columns.value * rows.value <= 1:
            raise DisplayGoneError(f"BRLTTY {self._where} drives no display; plug one in")
        if not self._online():
            raise DisplayGoneError(
                f"the {driver} display is not there; plug it in, or switch it on"
            )
        self._count = columns.value * rows.value
        model = self._text(self._library.brlapi__getModelIdentifier)
        return DisplayStands(driver, model, columns.value, rows.value)

    def write(self, cells: bytes) -> None:
        """Show cells from the left, as many as have room, and nothing beside them.

        Parameters
        ----------
        cells
            Dot masks of the cells.
        """
        self._do(self._library.brlapi__writeDots, cells[: self._count].ljust(self._count, b"\0"))

    def pressed(self) -> list[KeyPressed | KeyTyped]:
        """Take the keys that have come."""
        return list(self._pressed())

    def close(self) -> None:
        """Leave the display to BRLTTY."""
        if self._open:
            self._open = False
            self._library.brlapi__leaveTtyMode(self._handle)
            self._library.brlapi__closeConnection(self._handle)

    def _enter(self) -> None:
        """Ask for the display where this program's terminal is, or everywhere if that is unknown.

        A terminal in a window, or at the other end of a network, has no number that BRLTTY knows.
        """
        library, handle = self._library, self._handle
        if library.brlapi__enterTtyMode(handle, _WHERE_I_AM, None) < 0:
            self._do(library.brlapi__enterTtyModeWithPath, None, 0, None)

    def _pressed(self) -> Iterator[KeyPressed | KeyTyped]:
        code, described = ctypes.c_uint64(), _KeyCode()
        while self._do(self._library.brlapi__readKey, 0, ctypes.byref(code)):
            if code.value & _TYPE_MASK == _COMMAND:
                self._library.brlapi_describeKeyCode(code, ctypes.byref(described))
                name = (described.command or b"").decode("ascii", "replace")
                yield KeyPressed(name, described.argument)
            elif key := typed(code.value & _SYMBOL_MASK):
                yield KeyTyped(key)

    def _online(self) -> bool:
        """Tell whether the display is plugged in; writing to one that is not succeeds, too."""
        online = ctypes.c_uint8(1)
        size = self._library.brlapi__getParameter(
            self._handle, _ONLINE, 0, _GLOBAL, ctypes.byref(online), 1
        )
        return size < 1 or bool(online.value)  # some drivers cannot tell

    def _text(self, ask: Any) -> str:
        text = ctypes.create_string_buffer(_TEXT_BYTES)
        self._do(ask, text, _TEXT_BYTES)
        return text.value.decode("utf-8", "replace")

    def _do(self, function: Any, *arguments: Any) -> int:
        """Call a function of the library."""
        done: int = function(self._handle, *arguments)
        if done < 0 or self._refused:
            raise self._gone()
        return done

    def _take_refusal(self, _handle: object, error: int, *_: object) -> None:
        self._refused = error

    def _gone(self) -> DisplayGoneError:
        """Make the error that says what the library's last error means."""
        error = self._library.brlapi_error_location()
        number = self._refused or error.contents.number
        where = self._where
        if number == _AUTHENTICATION:
            return DisplayGoneError(
                f"BRLTTY {where} does not let you in; join the group that may read /etc/brlapi.key"
            )
        if number == _VERSION:
            return DisplayGoneError(
                f"what answers {where} is no BRLTTY of today; give another address"
            )
        if number in (_REFUSED, _GAI, _LIBC, _EOF):
            return DisplayGoneError(f"no BRLTTY answers {where}; start it, or give its address")
        if self._refused:
            return DisplayGoneError(f"BRLTTY {where} does not take what is shown (error {number})")
        said = self._library.brlapi_strerror(error).decode("utf-8", "replace")
        return DisplayGoneError(f"BRLTTY {where} does not give the display: {said}")


def typed(symbol: int) -> str:
    r"""Name of a key that a display's keyboard has sent, or its character; empty if it is neither.

    Parameters
    ----------
    symbol
        Number of the key as X11 numbers them (keysym).

    >>> typed(0x61), typed(0xFF0D), typed(0x1000416)
    ('a', '\n', 'Ж')
    """
    if symbol in _NAMED:
        return _NAMED[symbol]
    if 0x20 <= symbol <= 0x7E or 0xA0 <= symbol <= 0xFF:
        return chr(symbol)
    if _UNICODE < symbol <= _UNICODE + 0x10FFFF:
        return chr(symbol - _UNICODE)
    return ""
