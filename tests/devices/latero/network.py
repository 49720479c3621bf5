"""A network that loses, delays and doubles the datagrams of a Latero."""

from __future__ import annotations

import random
from dataclasses import dataclass

from vbraille.devices.latero.wire import FULLR0, VERSION, Answer, pack_answer


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

    """

    drop: float = 0.0
    late: float = 0.0
    double: float = 0.0
    foreign: float = 0.0
    late_s: float = 0.02
    seed: int = 1


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
