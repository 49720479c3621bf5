"""The handshake with a device on a serial line, and what can be wrong with it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from vbraille.devices.base import Particulars
from vbraille.devices.messages import (
    ANSWER_MS,
    HELLO_PERIOD_MS,
    VERSION,
    Encoder,
    Error,
    Hello,
    Info,
    State,
    Watchdog,
)
from vbraille.devices.ports import BAUD
from vbraille.devices.wire import DELIMITER, Decoder, OtherVersion, encode
from vbraille.display import Display
from vbraille.errors import DeviceError

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

    from vbraille.devices.ports import Address
    from vbraille.devices.serialport import SerialPort
    from vbraille.devices.wire import Event

# The zero ends whatever was on the line before.
HELLO: Final = DELIMITER + encode(Hello())
_LISTEN_S = 0.005
_NS_PER_MS = 1_000_000


@dataclass(frozen=True, slots=True)
class Greeted:
    """What a device answered to HELLO.

    Parameters
    ----------
    info
        Its INFO.
    decoder
        In the midst of what follows.
    events
        What has followed already.
    """

    info: Info
    decoder: Decoder
    events: Sequence[Event]


def greet(port: SerialPort, now_ns: Callable[[], int], pause: Callable[[float], None]) -> Greeted:
    """Say HELLO until a device answers, for some seconds: it may restart when it is opened.

    Raises
    ------
    DeviceError
        If none does, or it speaks another version.
    """
    decoder = Decoder()
    begun_ns = hello_ns = now_ns()
    heard = speaks = False
    while now_ns() - begun_ns < ANSWER_MS * _NS_PER_MS:
        if now_ns() >= hello_ns and port.write(HELLO):
            hello_ns += HELLO_PERIOD_MS * _NS_PER_MS
        chunk = port.read()
        if port.gone:
            raise DeviceError(f"{port.address.url} went away; plug the device in and try again")
        heard = heard or bool(chunk)
        events = decoder.feed(chunk)
        if decoder.bad_info:
            raise _cannot_be(decoder.bad_info, port.address)
        for i, event in enumerate(events):
            if isinstance(event, Info):
                _check(event, port.address)
                return Greeted(event, decoder, events[i + 1 :])
            if isinstance(event, OtherVersion):
                raise DeviceError(
                    f"the device at {port.address.url} speaks version {event.version} of the "
                    f"protocol and this vbraille version {VERSION}; update the older of the two"
                )
            speaks = speaks or isinstance(event, State | Watchdog | Error)
        pause(_LISTEN_S)
    raise _no_answer(port.address, heard, speaks)


def _no_answer(address: Address, heard: bool, speaks: bool) -> DeviceError:
    if speaks:
        return DeviceError(
            f"the device at {address.url} sends, but does not answer; "
            f"switch it off and on, or check its cable"
        )
    if heard:
        return DeviceError(
            f"what {address.url} sends makes no sense: it is no vbraille device, or not set to "
            f"{address.baud or BAUD} baud; choose another port, or ?baud="
        )
    return DeviceError(
        f"nothing answers at {address.url}; see that the device is on, or choose another port"
    )


def misfit(info: Info) -> str:
    """Why a device cannot be read on, with the fields and their values; empty if it can."""
    if info.encoder is Encoder.INCREMENTAL:
        return ""
    # Where the carriage is when the conversation begins is told by one count alone.
    counts, told = info.travel_um * info.counts_per_m // 1_000_000, 1 << (info.count_bits - 1)
    if counts < told:
        return ""
    return (
        f"travel_um is {info.travel_um}, which takes {counts} counts with a counts_per_m of "
        f"{info.counts_per_m}; it must take less than {told}, half the range of count_bits "
        f"{info.count_bits}"
    )


def _check(info: Info, address: Address) -> None:
    fault = misfit(info)
    if fault:
        raise _cannot_be(fault, address)


def _cannot_be(fault: str, address: Address) -> DeviceError:
    return DeviceError(
        f"the device at {address.url} says in its INFO what cannot be: {fault}; "
        f"mend its firmware or its settings"
    )


def info_of(info: Info) -> Display:
    """What a device says of itself, in mm."""
    return Display(
        name=info.name,
        rows=info.rows,
        columns=info.columns,
        column_pitch_mm=info.column_pitch_nm / 1e6,
        row_pitch_mm=info.row_pitch_nm / 1e6,
        levels=info.top_level + 1,
        rest_side=info.rest_side.name.lower(),
        travel_mm=info.travel_um / 1e3,
        counts_per_mm=info.counts_per_m / 1e3,
        rate_hz=float(info.rate_hz),
    )


_ENCODERS: Final = {
    Encoder.ABSOLUTE: "absolute",
    Encoder.INDEX: "relative, with an index mark that must be passed",
    Encoder.INCREMENTAL: "relative, and must be shown the left stop",
}


def particulars_of(info: Info) -> Particulars:
    """What a device says of itself that reading does not ask for."""

    def where(chosen: Iterable[bool]) -> tuple[tuple[int, int], ...]:
        return tuple(divmod(at, info.columns) for at, is_one in enumerate(chosen) if is_one)

    return Particulars(
        firmware=info.firmware,
        encoder=_ENCODERS[info.encoder],
        largest_slew_per_s=info.largest_slew_per_s,
        disabled=where(not (on and gain) for on, gain in zip(info.enabled, info.gain, strict=True)),
        inverted=where(map(bool, info.inverted)),
    )
