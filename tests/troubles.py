"""What goes wrong between a host and its device, at random."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import random
    from collections.abc import Callable


@dataclass(frozen=True, slots=True)
class Troubles:
    """What goes wrong; times in µs since the loop began, chances of each message.

    Parameters
    ----------
    stalls
        When the host is stopped, and for how long.
    stopped_writing
        Whether it may be stopped between what it made and what it sends, too.
    down_dead, up_dead
        When the line to the device, and to the host, carries nothing: (from, to).
    down_held
        When it carries nothing to the device, and delivers all of it afterwards.
    lost_down, lost_up, doubled, doubled_up, garbled_up, split
        Chances of a message to the device ("down") or to the host ("up") to be lost, to come
        twice (to the host up to 30 ms later), to have a bit turned over, and to come in two pieces.
    replayed
        Chance of a message to the device to come again, up to 100 ms later.
    jitter_us
        How late a message may be besides, to the device and to the host.
    """

    stalls: tuple[tuple[int, int], ...] = ()
    stopped_writing: bool = False
    down_dead: tuple[tuple[int, int], ...] = ()
    up_dead: tuple[tuple[int, int], ...] = ()
    down_held: tuple[tuple[int, int], ...] = ()
    lost_down: float = 0.0
    lost_up: float = 0.0
    doubled: float = 0.0
    doubled_up: float = 0.0
    garbled_up: float = 0.0
    split: float = 0.0
    replayed: float = 0.0
    jitter_us: tuple[int, int] = (0, 0)


def troubles_of_host(chance: random.Random, run_us: int) -> Troubles:
    """What a host can protect the actuators from, whatever the controller.

    The host is stopped, and what the device says is lost, late or spoilt in any way; the line to
    the device loses single messages, doubles and splits them, and is late by some milliseconds.
    """
    up = chance.random() < 0.5
    return Troubles(
        stalls=_spells(chance, run_us, chance.randint(1, 3), _stall_us),
        up_dead=_spells(chance, run_us, chance.randint(0, 2), _dead_us) if up else (),
        lost_down=chance.choice((0.0, 0.01, 0.05)),
        lost_up=chance.choice((0.0, 0.05, 0.5, 0.95)),
        doubled=chance.choice((0.0, 0.1)),
        doubled_up=chance.choice((0.0, 0.1)),
        garbled_up=chance.choice((0.0, 0.1)),
        split=chance.choice((0.0, 0.3)),
        jitter_us=(chance.choice((0, 500, 3000)), chance.choice((0, 2000, 30_000))),
    )


def troubles_of_line(chance: random.Random, run_us: int) -> Troubles:
    """All that, and a line to the device that is dead, held up and repeats what it carried."""
    kinds = [chance.randint(0, 2) for _ in range(3)]
    return replace(
        troubles_of_host(chance, run_us),
        stopped_writing=True,
        down_dead=_spells(chance, run_us, kinds[0], _dead_us),
        down_held=_spells(chance, run_us, kinds[1], _dead_us),
        up_dead=_spells(chance, run_us, kinds[2], _dead_us),
        lost_down=chance.choice((0.0, 0.05, 0.5, 0.9)),
        replayed=chance.choice((0.0, 0.02)),
        jitter_us=(chance.choice((0, 3000, 30_000)), chance.choice((0, 30_000))),
    )


def _spells(
    chance: random.Random, run_us: int, count: int, length_us: Callable[[random.Random], int]
) -> tuple[tuple[int, int], ...]:
    begun = sorted(chance.randrange(0, run_us) for _ in range(count))
    return tuple((at_us, length_us(chance)) for at_us in begun)


def _stall_us(chance: random.Random) -> int:
    """Most are about as long as the watchdog and its ramp take."""
    about_us = chance.choice(
        ((1000, 45_000), (45_000, 75_000), (45_000, 75_000), (75_000, 300_000))
    )
    return chance.randint(*about_us)


def _dead_us(chance: random.Random) -> int:
    return chance.choice((chance.randint(1000, 75_000), chance.randint(45_000, 150_000)))
