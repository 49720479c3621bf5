"""Specs of conventional displays, such as "brlapi" or "brlapi:HOST:N", to what opens them."""

from __future__ import annotations

import re
from functools import partial
from typing import TYPE_CHECKING, Final

from vbraille.errors import InputError
from vbraille.wording import setting

if TYPE_CHECKING:
    from collections.abc import Callable

    from vbraille.conventional.driver import CellDriver

BRLAPI: Final = "brlapi"
DOT_PAD: Final = "dotpad"
HID: Final = "hid"
_ADDRESS: Final = re.compile(r"[^\s:]*:[0-9]{1,5}|/\S+|")
_PINS: Final = "?pins"


def opener_of(spec: str) -> Callable[[], CellDriver]:
    """Give the function that opens the display of a spec.

    It raises `DisplayGoneError` if the display is not there, and may wait for it.

    Raises
    ------
    InputError
        If the text is no spec, or what the display needs is not installed.
    """
    kind, _, address = spec.partition(":")
    openers = {BRLAPI: _brlapi, DOT_PAD: _dot_pad, HID: _hid}
    if kind not in openers:
        raise InputError(
            f"{setting('also')} is {spec!r}; give brlapi, brlapi:HOST:N for BRLTTY on another "
            f"machine, dotpad:PORT for a Dot Pad, or hid for a display with USB's own protocol"
        )
    return openers[kind](spec, address)


# Only who asks for a display needs its library.


def _brlapi(spec: str, address: str) -> Callable[[], CellDriver]:
    if not _ADDRESS.fullmatch(address):
        raise InputError(
            f"{setting('also')} is {spec!r}; after brlapi: there must be a host and a number, as "
            f"in brlapi:127.0.0.1:0"
        )
    from vbraille.conventional.brlapi import BrlapiDisplay, load_library

    load_library()
    return partial(BrlapiDisplay, address)


def _dot_pad(spec: str, address: str) -> Callable[[], CellDriver]:
    port = address.removesuffix(_PINS)
    if not port.startswith("/") or "?" in port:
        raise InputError(
            f"{setting('also')} is {spec!r}; after dotpad: there must be the path of a serial "
            f"port, as in dotpad:/dev/ttyUSB0, and ?pins for its area of pins"
        )
    from vbraille.conventional.dotpad import DotPadDisplay

    return partial(DotPadDisplay, port, pins=port != address)


def _hid(spec: str, address: str) -> Callable[[], CellDriver]:
    if spec != HID and not address.startswith("/"):
        raise InputError(
            f"{setting('also')} is {spec!r}; after hid: there must be a path, as in "
            f"hid:/dev/hidraw0, or give hid for the first display that there is"
        )
    from vbraille.conventional.hid import open_hid

    return partial(open_hid, address)
