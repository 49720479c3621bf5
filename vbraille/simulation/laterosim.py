"""A Latero made of software, at a UDP port: its boards and a hand.

simulator = LateroSimulator(LateroCarriage(parse_hand("slow")), say=print)
simulator.run(stopped=lambda: False)
"""

from __future__ import annotations

import select
import socket
import time
from contextlib import suppress
from typing import TYPE_CHECKING, Final

from vbraille.carriers import latero
from vbraille.devices.latero.device import DISPLAY
from vbraille.devices.latero.wire import BUTTONS, PORT
from vbraille.errors import InputError
from vbraille.simulation.carriage import Carriage, area_of
from vbraille.simulation.controls import Controls
from vbraille.simulation.lateroboard import LateroBoard

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

    from vbraille.simulation.controls import ControlEvent
    from vbraille.simulation.hand import Hand

# Counts of encoders 0, 1 and 2 at angle 0: any, and none of them 0, for clients must mind them.
OFFSETS: Final = (4452, 4_294_960_000, 120_034)
_NS_PER_US: Final = 1000
_ROOM_BYTES: Final = 2048
_LOOK_S: Final = 0.05
# A client that asks nothing for so long has gone, and the hand goes back to the lower left.
GONE_S: Final = 0.3


class LateroCarriage(Carriage):
    """An array at the lower left, with the third arm straight up, and a hand.

    Parameters
    ----------
    hand
        Hand that reads a page again and again; a recorded hand reads once.
    lines, pitch_mm
        Lines of the page, and how far apart they are; the first begins at the top.
    """

    def __init__(self, hand: Hand, lines: int = 1, pitch_mm: float = 10.0) -> None:
        super().__init__(DISPLAY, hand, area_of(DISPLAY, pitch_mm, lines), latero.HEIGHT_MM)

    def encoders(self, now_us: int) -> tuple[int, int, int, int]:
        """Return the counts of the four encoders; the last stands still."""
        place = self.at(now_us * _NS_PER_US)
        return *latero.encoders_of(latero.joints_at(*place), OFFSETS), 0


class LateroSimulator:
    """A Latero at a UDP port of this computer, in real time.

    Parameters
    ----------
    carriage
        What the hand moves.
    say
        Function that is told what happens, a sentence at a time.
    port
        Where it listens; port 0 is any that is free.
    script
        Presses of its two buttons, in seconds since it was first asked; the left one is 1.
    keys
        Function that gives the keys typed since its last call, which press buttons.
    wait_s
        How long the hand waits at the lower left after the first question, so that its place can
        be shown.

    Attributes
    ----------
    board : LateroBoard
        The Latero's boards.

    Raises
    ------
    InputError
        If it cannot listen there.
    """

    def __init__(
        self,
        carriage: LateroCarriage,
        *,
        say: Callable[[str], None],
        port: int = PORT,
        script: Sequence[ControlEvent] = (),
        keys: Callable[[], Iterable[str]] = tuple,
        wait_s: float = 1.0,
    ) -> None:
        self.board, self.carriage, self._say = LateroBoard(), carriage, say
        self._controls, self._keys = Controls(script), keys
        self._wait_us = wait_s * 1e6
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        try:
            self._socket.bind(("127.0.0.1", port))
        except OSError as error:
            self._socket.close()
            raise InputError(
                f"no Latero can be simulated at port {port}: {error.strerror}; choose another port"
            ) from None
        self._socket.setblocking(False)
        self._begun_ns = time.monotonic_ns()
        self._ever_us: int | None = None  # when it was asked for the first time
        # When the client that asks now came, and when it asked last.
        self._came_us = self._asked_us = 0
        self._client: tuple[str, int] | None = None
        self._was = True, True  # at rest, and powered

    @property
    def spec(self) -> str:
        """Name by which a program opens this Latero, whose offsets are known."""
        host, port = self._socket.getsockname()
        return f"latero:{host}:{port}?offsets={','.join(map(str, OFFSETS))}"

    @property
    def now_us(self) -> int:
        """Time since it was begun."""
        return (time.monotonic_ns() - self._begun_ns) // 1000

    def run(self, stopped: Callable[[], bool]) -> None:
        """Answer until it is told to stop."""
        while not stopped():
            if select.select([self._socket], (), (), _LOOK_S)[0]:
                self._answer()
            self._mind(self.now_us)

    def close(self) -> None:
        """Let the port go."""
        self._socket.close()

    def _answer(self) -> None:
        """Answer what has come."""
        now_us = self.now_us
        with suppress(OSError):  # nothing has come, or a client is gone that was answered
            datagram, client = self._socket.recvfrom(_ROOM_BYTES)
            self.board.encoders = self.carriage.encoders(now_us)
            answer = self.board.receive(datagram)
            if answer is not None:
                self._note(client, now_us)
                self._socket.sendto(answer, client)

    def _note(self, client: tuple[str, int], now_us: int) -> None:
        """Note who has asked, and move the hand once it has waited for long enough."""
        if client != self._client:
            self._came_us = now_us if self._client is None else self._came_us
            self._client = client
            self._ever_us = self._ever_us or now_us
            self._say(f"asked by {client[0]}:{client[1]}")
        self._asked_us = now_us
        if now_us - self._came_us >= self._wait_us:
            self.carriage.set_out()
        was, now = self._was, (self.board.at_rest, self.board.powered)
        self._was = now
        if now[1] != was[1] or (now[0] != was[0] and not now[1]):
            rest = "at rest" if now[0] else "not at rest"
            self._say(f"motor power: {'on' if now[1] else 'off'}, blades {rest}")

    def _mind(self, now_us: int) -> None:
        """Press what is to be pressed, and let the hand go back once no client asks."""
        if self._ever_us is not None:
            since_s = (now_us - self._ever_us) / 1e6
            self._controls.advance(since_s)
            for key in self._keys():
                if key in ("1", "2"):
                    self._say(self._controls.type(key, since_s))
            self.board.buttons = self._controls.buttons & ((1 << len(BUTTONS)) - 1)
        if self._client is not None and now_us - self._asked_us > GONE_S * 1e6:
            self._client = None
            self.carriage.go_back(now_us * _NS_PER_US)
            if not self.board.at_rest:
                self._say("no client asks, and blades are not at rest")
