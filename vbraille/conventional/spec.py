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
_ADDRESS: Final = re.compile(r"[^\s:]*:[0-9]{1,5}|/\S+|")


def opener_of(spec: str) -> Callable[[], CellDriver]:
    """Give the function that opens the display of a spec.

    It raises `DisplayGoneError` if the display is not there, and may wait for it.

    Raises
    ------
    InputError
        If the text is no spec, or what the display needs is not installed.
    """
    kind, _, address = spec.partition(":")
    if kind != BRLAPI:
        raise InputError(
            f"{setting('also')} is {spec!r}; give brlapi, or brlapi:HOST:N for BRLTTY on another "
            f"machine"
        )
    if not _ADDRESS.fullmatch(address):
        raise InputError(
            f"{setting('also')} is {spec!r}; after brlapi: there must be a host and a number, as "
            f"in brlapi:127.0.0.1:0"
        )
    # Only who asks for such a display needs its library.
    from vbraille.conventional.brlapi import BrlapiDisplay, load_library

    load_library()
    return partial(BrlapiDisplay, address)
