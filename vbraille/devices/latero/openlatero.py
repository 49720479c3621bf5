"""``latero:HOST[:PORT]``: find the Latero, see that it is one, and have it guarded."""

from __future__ import annotations

import socket
import time
from typing import TYPE_CHECKING, Final

from vbraille.devices.latero.address import LateroAddress, parse_latero_address
from vbraille.devices.latero.conversation import LateroConversation, power_off
from vbraille.devices.latero.datagrams import NO_IO, full_request
from vbraille.devices.latero.guardian import POWER
from vbraille.devices.latero.guarding import Guarding
from vbraille.devices.latero.hearing import OPENING, LateroStage
from vbraille.devices.latero.laterodevice import DISPLAY, LateroDevice
from vbraille.errors import DeviceError, InputError
from vbraille.wording import setting

if TYPE_CHECKING:
    from collections.abc import Callable

    from vbraille.display import Display

ANSWER_S: Final = 1.5
# The guardian of a client that was killed has a second to bring the blades to rest.
_ALONE_S: Final = 2.0
_LOOK_S: Final = 0.001
# Frames must come more often than the guardian takes the client for dead.
LOWEST_RATE_HZ: Final = 40.0


def open_latero(
    address: str,
    wanted: Display | None,
    *,
    now_ns: Callable[[], int] = time.monotonic_ns,
    pause: Callable[[float], None] = time.sleep,
) -> LateroDevice:
    """Open ``latero:HOST[:PORT][?offsets=N,N,N&power=ADDRESS]``.

    Parameters
    ----------
    address
        What comes after ``latero:``.
    wanted
        Display that the page was laid out for, of which only the rate is looked at.
    now_ns, pause
        Clock, and function that waits for a number of seconds.

    Raises
    ------
    InputError
        If the address is none, or there is no such host.
    DeviceError
        If nothing answers there, something else does, or another program drives the Latero.
    """
    place = parse_latero_address(address)
    rate_hz = DISPLAY.rate_hz if wanted is None else wanted.rate_hz
    if rate_hz < LOWEST_RATE_HZ:
        raise InputError(
            f"the Latero's guardian takes it to rest when frames are 50 ms apart, and {rate_hz:g} "
            f"a second are asked for; choose {setting('rate')} {LOWEST_RATE_HZ:g} or more"
        )
    found = _resolve(place)
    opened: list[socket.socket] = []
    guarding = None
    try:
        kept = _keep_others_away(place, found, pause)
        opened.append(kept)
        line = _connect(place, found)
        opened.append(line)
        spare = _connect(place, found)  # the guardian's
        opened.append(spare)
        conversation = LateroConversation(
            now_ns(),
            period_ns=round(1e9 / rate_hz),
            half_span_mm=DISPLAY.span_mm / 2,
            offsets=place.offsets,
            power=place.power,
            trusted=place.trusted,
        )
        register = place.power or 0
        guarding = Guarding(
            bytes(full_request()), bytes(power_off(register)), spare.fileno(), [kept.fileno()]
        )
        spare.close()
        guarding.beat(now_ns())
        device = LateroDevice(line, conversation, guarding, kept, now_ns, pause)
        _greet(device, place, now_ns, pause)
        guarding.board.words[POWER] = conversation.power is not None
    except BaseException:  # a signal's exception, too
        if guarding is not None:
            guarding.close()
        for one in opened:
            one.close()
        raise
    return device


def _resolve(place: LateroAddress) -> tuple[str, int]:
    """Address of the host; the Latero knows IPv4 only."""
    try:
        found = socket.getaddrinfo(place.host, place.port, socket.AF_INET, socket.SOCK_DGRAM)
    except (OSError, UnicodeError):
        raise InputError(
            f"there is no host {place.host}; give the Latero's name or address"
        ) from None
    return str(found[0][4][0]), place.port


def _keep_others_away(
    place: LateroAddress, found: tuple[str, int], pause: Callable[[float], None]
) -> socket.socket:
    """Socket that one program on this computer can have for a Latero, as long as it lives.

    Raises
    ------
    DeviceError
        If another program has it.
    """
    kept = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
    name = f"\0vbraille-latero-{found[0]}:{found[1]}"
    for left in reversed(range(round(_ALONE_S / 0.05))):
        try:
            kept.bind(name)
        except OSError:
            if left:
                pause(0.05)
                continue
            kept.close()
            raise DeviceError(
                f"another program on this computer drives the Latero at {place.text}; end it, and "
                f"try again"
            ) from None
        break
    return kept


def _connect(place: LateroAddress, found: tuple[str, int]) -> socket.socket:
    """Socket that hears nobody but the Latero."""
    line = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    try:
        line.connect(found)
    except OSError as error:
        line.close()
        raise DeviceError(
            f"{place.text} cannot be reached ({error.strerror}); look at the network and its cable"
        ) from None
    line.setblocking(False)
    return line


def _greet(
    device: LateroDevice,
    place: LateroAddress,
    now_ns: Callable[[], int],
    pause: Callable[[float], None],
) -> None:
    """Ask until the Latero has answered, with its blades at rest.

    Raises
    ------
    DeviceError
        If it does not.
    """
    conversation = device.conversation
    begun_ns = now_ns()
    while True:
        device.read()
        answer = conversation.answer
        if conversation.stage not in OPENING and conversation.stage is not LateroStage.RAMPING:
            return
        if now_ns() - begun_ns > ANSWER_S * 1e9:
            if conversation.stage is LateroStage.RAMPING:
                return  # answers are lost on the way, and it will be seen
            if answer is not None and answer.interface == NO_IO:
                raise DeviceError(
                    f"the I/O interface of the Latero at {place.text} is unplugged or has no "
                    f"power; plug it in, and try again"
                )
            raise _no_answer(conversation, place)
        pause(_LOOK_S)


def _no_answer(conversation: LateroConversation, place: LateroAddress) -> DeviceError:
    if conversation.other_version:
        return DeviceError(
            f"the Latero at {place.text} speaks another version of its protocol than 1.1, which is "
            f"the only one that vbraille knows; it cannot be read on"
        )
    if conversation.numbering.unasked and not conversation.foreign:
        return DeviceError(
            f"the Latero at {place.text} does not repeat the numbers of requests, so that a late "
            f"answer cannot be told from a new one; it cannot be read on"
        )
    if conversation.foreign:
        return DeviceError(
            f"what answers at {place.text} is no Latero; choose another host or port"
        )
    return DeviceError(
        f"no Latero answers at {place.text}; see that it is on and on this network, or choose "
        f"another host or port"
    )
