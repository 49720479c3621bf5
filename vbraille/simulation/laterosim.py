"""A Latero made of software, at a UDP port: its boards, a hand, and what goes wrong on the way.

simulator = LateroSimulator(LateroCarriage(parse_hand("slow")), say=print)
simulator.run(stopped=lambda: False)
"""

from __future__ import annotations

import heapq
import random
import select
import socket
import time
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Final

import numpy as np

from vbraille.carriers import latero
from vbraille.devices.latero.device import DISPLAY
from vbraille.devices.latero.wire import BUTTONS, FULLR0, PORT, VERSION, Answer, pack_answer
from vbraille.errors import InputError, check_range
from vbraille.simulation.carriage import Carriage, area_of
from vbraille.simulation.controls import Controls
from vbraille.simulation.lateroboard import LateroBoard
from vbraille.simulation.recorded import Recorded

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

    from vbraille.simulation.controls import ControlEvent
    from vbraille.simulation.hand import Hand

# Counts of encoders 0, 1 and 2 at angle 0: any, and none of them 0, for clients must mind them.
OFFSETS: Final = (4452, 4_294_960_000, 120_034)
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

    def __init__(self, hand: Hand | Recorded, lines: int = 1, pitch_mm: float = 10.0) -> None:
        if isinstance(hand, Recorded) and hand.y_mm is None:  # it reads the first line
            hand = replace(hand, y_mm=np.full(hand.t_s.size, pitch_mm / 2))
        super().__init__(DISPLAY, hand, area_of(DISPLAY, pitch_mm, lines), latero.HEIGHT_MM)

    def encoders(self, now_us: int) -> tuple[int, int, int, int]:
        """Return the counts of the four encoders; the last stands still."""
        return *latero.encoders_of(latero.joints_at(*self.at(now_us)), OFFSETS), 0


@dataclass(frozen=True, slots=True)
class LateroFaults:
    """Faults of the network: what it does to datagrams, and what else comes along.

    Parameters
    ----------
    drop
        Chance of a datagram, in either direction, to be lost.
    late, late_s
        Chance of an answer to be late, and by how much, in seconds.
    double
        Chance of a datagram, in either direction, to come twice.
    foreign
        Chance of another sender's datagram to come with an answer.
    seed
        Seed of the random draws.

    Raises
    ------
    ValueError
        If a chance is out of range.
    """

    drop: float = 0.0
    late: float = 0.0
    double: float = 0.0
    foreign: float = 0.0
    late_s: float = 0.02
    seed: int = 1

    def __post_init__(self) -> None:
        for name in ("drop", "late", "double", "foreign"):
            check_range(name, getattr(self, name), 0, 1)


@dataclass(slots=True)
class LateroTally:
    """Counts of datagrams that met a fault."""

    requests_lost: int = 0
    answers_lost: int = 0
    answers_late: int = 0
    requests_doubled: int = 0
    answers_doubled: int = 0
    foreign: int = 0


class Network:
    """Effects of a network on the datagrams of a Latero, without one.

    Parameters
    ----------
    faults
        Chances of what it does.

    Attributes
    ----------
    tally : LateroTally
        What it did.
    """

    def __init__(self, faults: LateroFaults) -> None:
        self.tally = LateroTally()
        self._faults = faults
        self._random = random.Random(faults.seed)

    def carry_request(self) -> int:
        """Tell how often a request arrives: 0, 1 or 2 times."""
        if self._meets("requests_lost", self._faults.drop):
            return 0
        return 1 + self._meets("requests_doubled", self._faults.double)

    def carry_answer(self, answer: bytes) -> list[tuple[float, bytes]]:
        """Return the datagrams that arrive for an answer, each with how late it is, in seconds."""
        faults = self._faults
        arriving = []
        if self._meets("foreign", faults.foreign):
            arriving.append((0.0, self._foreign(answer)))
        if self._meets("answers_lost", faults.drop):
            return arriving
        late_s = faults.late_s * self._meets("answers_late", faults.late)
        copies = 1 + self._meets("answers_doubled", faults.double)
        return arriving + copies * [(late_s, answer)]

    def _meets(self, fault: str, chance: float) -> bool:
        """Draw whether a datagram meets a fault, and count it."""
        met = chance > 0 and self._random.random() < chance
        setattr(self.tally, fault, getattr(self.tally, fault) + met)
        return met

    def _foreign(self, answer: bytes) -> bytes:
        """Return what a Latero would not answer: noise, a part, another version, a question."""
        far = (int.from_bytes(answer[3:5]) + 0x4000) & 0xFFFF
        draw = self._random
        return draw.choice(
            (
                draw.randbytes(draw.randrange(1, 120)),
                answer[: draw.randrange(1, len(answer))],
                answer[:1] + bytes((VERSION + 1,)) + answer[2:],
                answer[:2] + b"\x01" + answer[3:],
                answer + b"\xff",
                # The right form, and a number that no request has had for a long time.
                pack_answer(Answer(far, 0, 0x104, 0x100, (9, 9, 9, 9)), FULLR0),
            )
        )


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
    faults
        What the network does.
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
    network : Network
        What became of the datagrams.

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
        faults: LateroFaults | None = None,
        script: Sequence[ControlEvent] = (),
        keys: Callable[[], Iterable[str]] = tuple,
        wait_s: float = 1.0,
    ) -> None:
        self.board = LateroBoard()
        self.network = Network(faults or LateroFaults())
        self.carriage = carriage
        self._say = say
        self._controls, self._keys = Controls(script), keys
        self._wait_s = wait_s
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
        self._on_way: list[tuple[int, int, bytes, tuple[str, int]]] = []
        self._count = 0
        self._asked_us: int | None = None  # when it was asked last
        self._first_us: int | None = None  # since the client came that asks now
        self._ever_us: int | None = None  # since anybody has asked
        self._client: tuple[str, int] | None = None
        self._was_at_rest, self._was_powered = True, True

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
            left_s = _LOOK_S
            if self._on_way:
                left_s = min(max(self._on_way[0][0] - self.now_us, 0) / 1e6, _LOOK_S)
            if select.select([self._socket], (), (), left_s)[0]:
                self._answer()
            while self._on_way and self._on_way[0][0] <= self.now_us:
                _, _, answer, client = heapq.heappop(self._on_way)
                self._send(answer, client)
            self._mind(self.now_us)

    def close(self) -> None:
        """Let the port go."""
        self._socket.close()

    def _answer(self) -> None:
        """Answer what has come."""
        try:
            datagram, client = self._socket.recvfrom(_ROOM_BYTES)
        except OSError:  # nothing has come, or a client is gone that was answered
            return
        for _ in range(self.network.carry_request()):
            now_us = self.now_us
            self.board.encoders = self.carriage.encoders(now_us)
            answer = self.board.receive(datagram)
            if answer is None:
                continue
            self._note(client, now_us)
            for late_s, arriving in self.network.carry_answer(answer):
                if late_s:
                    self._count += 1
                    due_us = now_us + round(late_s * 1e6)
                    heapq.heappush(self._on_way, (due_us, self._count, arriving, client))
                else:
                    self._send(arriving, client)

    def _note(self, client: tuple[str, int], now_us: int) -> None:
        """Note who has asked, and move the hand once it has waited for long enough."""
        if client != self._client:
            self._client = client
            self._say(f"asked by {client[0]}:{client[1]}")
        self._ever_us = now_us if self._ever_us is None else self._ever_us
        self._first_us = now_us if self._first_us is None else self._first_us
        self._asked_us = now_us
        if now_us - self._first_us >= self._wait_s * 1e6:
            self.carriage.set_out()
        at_rest, powered = self.board.at_rest, self.board.powered
        if powered != self._was_powered:
            rest = "at rest" if at_rest else "not at rest"
            self._say(f"motor power: {'on' if powered else f'off, blades {rest}'}")
        elif at_rest and not self._was_at_rest and not powered:
            self._say("blades: at rest")
        self._was_at_rest, self._was_powered = at_rest, powered

    def _mind(self, now_us: int) -> None:
        """Press what is to be pressed, and let the hand go back once no client asks."""
        if self._ever_us is not None:
            since_s = (now_us - self._ever_us) / 1e6
            self._controls.advance(since_s)
            for key in self._keys():
                if key in ("1", "2"):
                    self._say(self._controls.type(key, since_s))
            self.board.buttons = self._controls.buttons & ((1 << len(BUTTONS)) - 1)
        if self._asked_us is not None and now_us - self._asked_us > GONE_S * 1e6:
            self._asked_us = self._first_us = None
            self.carriage.go_back(now_us)
            if not self.board.at_rest:
                self._say("no client asks, and blades are not at rest")

    def _send(self, answer: bytes, client: tuple[str, int]) -> None:
        try:
            self._socket.sendto(answer, client)
        except OSError:
            self.network.tally.answers_lost += 1
