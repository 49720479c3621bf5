"""Devices on a serial port, a pseudo-terminal or a socket, by the wire protocol.

`SerialDevice` joins a `Line` and a `Conversation`; a driver for another protocol is a file like
this one.
"""

from __future__ import annotations

import logging
import time
from typing import TYPE_CHECKING, Final

import numpy as np

from vbraille.devices.base import Device, Particulars
from vbraille.devices.events import Placed, Placing, Unplugged
from vbraille.devices.line import Line, find_again, parse_address, usb_identity
from vbraille.devices.protocol import VERSION, Conversation
from vbraille.errors import DeviceError, VbrailleError

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from vbraille.devices.events import Event
    from vbraille.devices.line import Address
    from vbraille.display import Display, Pose

BOOT_S: Final = 5.0  # that a board may take to start, since opening its port may reset it
_SOCKET_S: Final = 2.0  # after which a socket that is silent is opened again
_LOOK_S: Final = 0.001
_AGAIN_NS: Final = 100_000_000  # between attempts to open a port that is gone
_log = logging.getLogger(__name__)


class SerialDevice(Device):
    """A device that speaks the wire protocol.

    Parameters
    ----------
    address
        Where it is; the option ``boot`` has the seconds that its board may take to start.
    now_ns
        Clock of nanoseconds.
    pause
        Function that waits for a number of seconds.

    Raises
    ------
    InputError, DeviceError
        If the port cannot be opened, or no device answers at it.
    """

    acknowledges = True

    def __init__(
        self,
        address: Address,
        now_ns: Callable[[], int] = time.monotonic_ns,
        pause: Callable[[float], None] = time.sleep,
    ) -> None:
        from vbraille.devices.levels import pack  # loads numba

        self._pack = pack
        self._address = address
        self._boot_s = address.options.get("boot", BOOT_S)
        self._now_ns, self._pause = now_ns, pause
        self._identity = None if address.is_socket else usb_identity(address.where)
        self._silent_ns = round((_SOCKET_S if address.is_socket else self._boot_s) * 1e9)
        self._line = Line(address)
        self._away = False  # whether its port is gone, and looked for
        self._look_ns = 0
        self._events: list[Event] = []
        self._losses = self._unsent = 0
        self._talk = Conversation(now_ns())
        self._since_ns = now_ns()  # since when nothing has come, or the port is open
        try:
            self._greet()
        except BaseException:
            self._line.close()
            raise

    def _greet(self) -> None:
        """Wait until the device says what it is, and whether it knows its place."""
        until_ns = self._now_ns() + round(self._boot_s * 1e9)
        talk = self._talk
        while talk.state is None:
            if self._now_ns() > until_ns:
                raise DeviceError(
                    f"no vbraille device answers at {self._address.where} within "
                    f"{self._boot_s:g} s; see that it is on and speaks version {VERSION} of the "
                    f"protocol, at {self._address.baud} baud; where its board starts for longer, "
                    f"give ?boot=SECONDS behind the address"
                )
            self._pause(_LOOK_S)
            try:
                talk.hear(self._line.read(), self._now_ns())
                self._line.write(talk.due(self._now_ns()))
            except OSError as fault:
                raise DeviceError(f"{self._address.where} hung up: {fault}") from None
        info = talk.info
        assert info is not None
        self.display: Display = info.display
        self.serial_number = info.serial
        self.particulars = Particulars(
            protocol=f"serial {VERSION}",
            fastest=info.fast / info.top,
            buttons=info.buttons,
            knobs=info.knobs,
            analog=tuple(info.analog),
        )
        self.placing = Placing.DONE if talk.placed else Placing.STOP
        self.descriptor = self._line.descriptor
        self._top = info.top
        self._packed = np.zeros(info.level_bytes, np.uint8)

    @property
    def rested(self) -> int:  # type: ignore[override]
        """Number of times that the actuators went to rest by themselves."""
        return self._talk.rests

    @property
    def taking(self) -> bool:  # type: ignore[override]
        """Tell whether frames reach the actuators."""
        return self._talk.live

    @property
    def acknowledged_ns(self) -> int | None:  # type: ignore[override]
        """Time from when the last frame was sent to when the device said that it has it."""
        return self._talk.acknowledged_ns

    @property
    def watchdog_trips(self) -> int | None:  # type: ignore[override]
        """Number of times that the device's watchdog brought the actuators to rest."""
        return self._talk.trips

    @property
    def tripped_ms(self) -> float | None:  # type: ignore[override]
        """Time from the last frame to when the watchdog last tripped, by the device's clock."""
        return self._talk.tripped_ms

    def read(self) -> Pose | None:
        """Newest pose since the last call, or None."""
        now_ns = self._now_ns()
        if self._away and not self._is_back(now_ns):
            return None
        talk = self._talk
        try:
            chunk = self._line.read()
            pose = None
            if chunk:
                self._since_ns = now_ns
                pose = talk.hear(chunk, now_ns)
            was_live = talk.live
            if message := talk.due(now_ns):
                if was_live and not talk.live:
                    self._line.drop_unsent()
                self._line.write(message)
            if now_ns - self._since_ns > self._silent_ns:
                self._lose(now_ns)
        except OSError:
            self._events.append(Unplugged())
            self._lose(now_ns)
            return None
        placing = Placing.DONE if talk.placed else Placing.STOP
        if placing is not self.placing and talk.state is not None:
            self.placing = placing
            self._events.append(Placed(placing))
        return pose

    def _send(self, frame: NDArray[np.float64]) -> bool:
        talk = self._talk
        if not talk.live:
            return False
        self._pack(frame, self._top, self._packed)
        now_ns = self._now_ns()
        message = talk.frame(self._packed.tobytes(), now_ns)
        try:
            if message and self._line.write(message):
                talk.sent(now_ns)
                return True
        except OSError:
            return False  # `read` finds it gone
        self._unsent += 1
        return False

    def set_zero(self) -> None:
        """Take the carriage's place for the left stop: the reader says that it is there."""
        self._talk.zero(self._now_ns())

    def take_events(self) -> list[Event]:
        """Events since the last call."""
        told = [*self._events, *self._talk.events]
        self._events.clear()
        self._talk.events.clear()
        return told

    def counts(self) -> dict[str, int]:
        """Counts of what went wrong, by name."""
        talk = self._talk
        return {
            "damaged lines": talk.lines.damaged,
            "states missed": talk.missed,
            "states late or doubled": talk.old,
            "lines dropped by the device": talk.dropped,
            "frames not sent": self._unsent,
            "watchdog trips": talk.trips,
            "reconnections": self._losses,
        }

    def _lose(self, now_ns: int) -> None:
        """Close the port, and look for it: the device is gone, or has said nothing for long."""
        _log.info("%s is opened again", self._address.where)
        self._losses += 1
        self._away, self.descriptor = True, None
        self._look_ns = now_ns + _AGAIN_NS
        self._talk.greet(now_ns)
        self._line.close()

    def _is_back(self, now_ns: int) -> bool:
        """Look whether the port can be opened again."""
        if now_ns < self._look_ns:
            return False
        try:
            self._line = Line(find_again(self._address, self._identity))
        except (VbrailleError, OSError, KeyError):
            self._look_ns = self._now_ns() + _AGAIN_NS
            return False
        self._away, self.descriptor = False, self._line.descriptor
        self._since_ns = self._now_ns()
        self._talk.greet(self._since_ns)
        return True

    def _release(self) -> None:
        if self._away:
            return
        try:
            self._line.write(self._talk.goodbye())
        except OSError:
            pass
        finally:
            self._line.close()


def open_serial(address: str, _wanted: Display | None) -> SerialDevice:
    """Open ``serial:PORT``, as in ``serial:/dev/ttyACM0?baud=115200&boot=8``.

    Raises
    ------
    InputError, DeviceError
        If the port cannot be opened, or no device answers at it.
    """
    return SerialDevice(parse_address(address, boot=BOOT_S))
