"""Signals: numbers from 0 to 1 by which a picture answers to the hand, to keys and to time.

A scene names them, and its patterns use them: as what a blend chooses by, as the factor of a layer
or of a pulse, as the speed of a motion. They are computed once a tick. Lévesque 2009, 9.4 and 9.5.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Literal, NamedTuple

from vbraille.errors import check_range
from vbraille.scene.measures import Angle, Measured, Share, limits

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

MOST_SIGNALS = 8
MOST_LEVELS = 8
MOST_KEYS = 8
SWITCH_BITS = 3  # of a state

Below = Annotated[float, limits(0.0, 1000.0, " mm/s")]
Transition = Annotated[float, limits(0.1, 1000.0, " mm/s")]
Duration = Annotated[float, limits(0.0, 10.0, " s")]


class Speed(Measured, frozen=True, kw_only=True, tag_field="kind", tag="speed"):
    """1 under a hand that is slow, 0 under one that is fast: Lévesque 2009, eqs. 9.6 and 9.7.

    Parameters
    ----------
    below_mm_s
        Speed of the hand below which it is 1.
    transition_mm_s
        How much faster the hand goes where it has fallen to 0.
    delay_s
        How long it waits once the hand has become slow, and over how long it then rises; 0 for
        neither.

    Raises
    ------
    ValueError
        If a number is out of range.
    """

    below_mm_s: Below = 5.0
    transition_mm_s: Transition = 5.0
    delay_s: Duration = 0.25


class Direction(Measured, frozen=True, kw_only=True, tag_field="kind", tag="direction"):
    """1 where the hand goes in a direction, 0 elsewhere: Lévesque 2009, eqs. 9.8-9.10.

    Parameters
    ----------
    angle_deg
        The direction, from +x (right) towards +y (down).
    axis
        Whether the opposite direction counts as well.
    tolerance_deg, transition_deg
        How far from it the hand may go for 1, and how much farther it goes for 0.
    at_rest
        Under a hand that is slow: "high" for 1 (eq. 9.9), "low" for 0 (eq. 9.10), or "keep" for
        what it was before; at first that is 1.
    below_mm_s, slow_transition_mm_s
        Speed below which a hand is slow, and how much faster it goes where it is so no more.

    Raises
    ------
    ValueError
        If a number is out of range.
    """

    angle_deg: Angle = 0.0
    axis: bool = False
    tolerance_deg: Annotated[float, limits(0.0, 180.0, "°")] = 30.0
    transition_deg: Annotated[float, limits(0.1, 180.0, "°")] = 20.0
    at_rest: Literal["high", "low", "keep"] = "keep"
    below_mm_s: Below = 0.0
    slow_transition_mm_s: Transition = 5.0


class Switch(Measured, frozen=True, kw_only=True, tag_field="kind", tag="switch"):
    """A level that a key of ``vbraille feel`` changes, such as of a layer: Lévesque 2009, 9.5.

    Parameters
    ----------
    key
        Number of the key, 1 to 8; the same key may change several signals of as many levels.
    levels
        Levels of the states that the key goes through, and back to the first.
    states
        What these states are called, for the person who presses the key; empty for their numbers.
    title
        What the key changes.
    fade_s
        Time for a change from 0 to 1.

    Raises
    ------
    ValueError
        If a number is out of range, or states and levels are not as many.
    """

    key: Annotated[int, limits(1, MOST_KEYS)] = 1
    levels: tuple[Share, ...] = (0.0, 1.0)
    states: tuple[str, ...] = ()
    title: str = ""
    fade_s: Duration = 0.1

    def __post_init__(self) -> None:
        super().__post_init__()
        check_range("number of levels", len(self.levels), 2, MOST_LEVELS)
        if self.states and len(self.states) != len(self.levels):
            raise ValueError(f"states are {len(self.states)}; there is one for each level")


class Pulse(Measured, frozen=True, kw_only=True, tag_field="kind", tag="time"):
    """A pulse that repeats by itself, since the picture was put under the hand.

    Parameters
    ----------
    shape
        "sine", from 0 to 1 and back; "square", 0 in the first half and 1 in the second; "ramp",
        from 0 to 1, where it begins again.
    period_s
        Time after which it repeats.

    Raises
    ------
    ValueError
        If a number is out of range.
    """

    shape: Literal["sine", "square", "ramp"] = "sine"
    period_s: Annotated[float, limits(0.02, 3600.0, " s")] = 1.0


class Product(Measured, frozen=True, kw_only=True, tag_field="kind", tag="product"):
    """Signals multiplied: 1 where all of them are.

    Parameters
    ----------
    of
        Names of the signals, two or more.

    Raises
    ------
    ValueError
        If there are fewer, or too many.
    """

    of: tuple[str, ...]

    def __post_init__(self) -> None:
        check_range("number of names in of", len(self.of), 2, MOST_SIGNALS)


class Inverse(Measured, frozen=True, kw_only=True, tag_field="kind", tag="inverse"):
    """1 where another signal is 0, and 0 where that is 1.

    Parameters
    ----------
    of
        Name of the other signal.
    """

    of: str


AnySignal = Speed | Direction | Switch | Pulse | Product | Inverse


class OrderedSignal(NamedTuple):
    """A signal as it is computed, after those that it is made of.

    Parameters
    ----------
    name
        Name of the signal.
    signal
        How it is made; None for the integral over time of the signal that ``of`` names, s.
    of
        Numbers of the signals that it is made of.
    """

    name: str
    signal: AnySignal | None
    of: tuple[int, ...] = ()


def made_of(signal: AnySignal) -> tuple[str, ...]:
    """Names of the signals that a signal is made of."""
    if isinstance(signal, Product):
        return signal.of
    return (signal.of,) if isinstance(signal, Inverse) else ()


def ordered(signals: Mapping[str, AnySignal], driving: Iterable[str] = ()) -> list[OrderedSignal]:
    """Put signals into an order in which to compute them.

    Parameters
    ----------
    signals
        The signals by their names.
    driving
        Names of those that are the speed of a motion; the integral of each comes last.

    Raises
    ------
    ValueError
        If a signal is made of itself; its arguments are names of which each is made of the next.
    """
    found: dict[str, int] = {}
    order: list[OrderedSignal] = []

    def put(name: str, way: tuple[str, ...]) -> int:
        if name in way:
            raise ValueError(*way[way.index(name) :], name)
        if name not in found:
            of = tuple(put(one, (*way, name)) for one in made_of(signals[name]))
            found[name] = len(order)
            order.append(OrderedSignal(name, signals[name], of))
        return found[name]

    for name in signals:
        put(name, ())
    return order + [OrderedSignal(name, None, (found[name],)) for name in dict.fromkeys(driving)]


def packed(states: Mapping[int, int], signals: Mapping[str, AnySignal]) -> int:
    """Put states of switches into the number that a tick takes.

    Parameters
    ----------
    states
        State of each key, from 0; a key that is not there is in its first.
    signals
        The signals of a scene.
    """
    bits = 0
    for number, one in enumerate(ordered(signals)):
        if isinstance(one.signal, Switch):
            bits |= states.get(one.signal.key, 0) << SWITCH_BITS * number
    return bits
