"""Addresses of Lateros: ``HOST[:PORT][?offsets=N,N,N&power=ADDRESS]``."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Final

from vbraille.devices.latero.datagrams import PORT
from vbraille.errors import InputError

_U16, _U32 = 0xFFFF, 0xFFFF_FFFF
_EXAMPLE: Final = "latero:192.168.1.111"
NO_POWER: Final = "none"


@dataclass(frozen=True, slots=True)
class LateroAddress:
    """Address of a Latero, and what is known of it beforehand.

    Parameters
    ----------
    host
        Name or address of the Latero on the network.
    port
        UDP port; every Latero has 8900.
    offsets
        Counts of encoders 0, 1 and 2 at angle 0 of their joints; None if the reader shows the
        device where it is.
    power
        Register of the controller by which motor power is switched; None if it never is.
    trusted
        Whether somebody said so; otherwise the Latero is asked first.
    """

    host: str
    port: int = PORT
    offsets: tuple[int, int, int] | None = None
    power: int | None = 0
    trusted: bool = False

    @property
    def text(self) -> str:
        """Host and port, as a reader knows them."""
        return f"{self.host}:{self.port}"


def parse_latero_address(text: str) -> LateroAddress:
    """Address of a text.

    Raises
    ------
    InputError
        If it is none, or an option is unknown or out of range.
    """
    place, _, query = text.partition("?")
    host, colon, port = place.partition(":")
    if not re.fullmatch(r"[A-Za-z0-9._-]{1,253}", host):
        raise InputError(f"latero: needs the name or the address of a host, as in {_EXAMPLE}")
    if colon and not (re.fullmatch(r"[0-9]{1,5}", port) and 1 <= int(port) <= _U16):
        raise InputError(f"port is {port!r}; it must be a whole number from 1 to {_U16}")
    address = LateroAddress(host, int(port) if colon else PORT)
    offsets, power, trusted = address.offsets, address.power, False
    for option in filter(None, query.split("&")):
        name, _, value = option.partition("=")
        if name == "offsets":
            offsets = _offsets(value)
        elif name == "power":
            power, trusted = _power(value), True
        else:
            raise InputError(f"there is no option {name!r} of a Latero; there is offsets and power")
    return LateroAddress(host, address.port, offsets, power, trusted)


def _offsets(text: str) -> tuple[int, int, int]:
    found = re.fullmatch(r"(-?[0-9]{1,10}),(-?[0-9]{1,10}),(-?[0-9]{1,10})", text)
    if found is None:
        raise InputError(
            f"offsets are {text!r}; give three whole numbers, the counts of encoders 0, 1 and 2 "
            f"at angle 0, such as offsets=4452,9928,2004"
        )
    first, second, third = (int(count) & _U32 for count in found.groups())
    return first, second, third


def _power(text: str) -> int | None:
    if text == NO_POWER:
        return None
    found = re.fullmatch(r"0x[0-9a-fA-F]{1,4}|[0-9]{1,5}", text)
    register = int(text, 16 if text.startswith("0x") else 10) if found else -1
    if not 0 <= register <= _U16:
        raise InputError(
            f"power is {text!r}; give the controller's register that switches motor power, 0 to "
            f"{_U16}, or {NO_POWER}"
        )
    return register
