"""Conditions that a session is run with: its device, the source of its answers, and its pace."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from vbraille.display import check_rate
from vbraille.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Mapping

SOUNDS = ("auto", "tones", "bell", "none")


@dataclass(frozen=True, slots=True)
class LiveAddress:
    """Address at which the page of a live view is served.

    Parameters
    ----------
    host
        Name or address of this machine; None for its loopback, which no other machine reaches.
    port
        Number of the port; None for one that is free.
    """

    host: str | None = None
    port: int | None = None


@dataclass(frozen=True, slots=True)
class Conditions:
    """Conditions that a session is run with, beside its protocol and its plan.

    Parameters
    ----------
    device
        Spec of the device, such as "serial:/dev/ttyACM0"; "sim" is a simulated device.
    hand
        What moves the simulated device: "slow", "fluent" or "sweep:SPEED", among others.
    answers
        Source of the answers, unless `Session.run` is given one: "typed",
        "simulated:NOISE", or the name of a file with a line for each trial.
    rate_hz
        Number of frames that are sent in a second, 1 to 10,000.
    fast
        Whether a simulated session runs as fast as the machine can instead of in real time.
    sound
        How the participant hears signals: "auto", "tones", "bell" or "none".
    live
        Where a live view of the session is served; None for no live view.
    markers
        Other recorder that is sent a marker of each event: "lsl", "lsl:NAME", "serial:PORT" or
        "serial:PORT:BAUD"; None for none.
    also
        Conventional display, for a protocol that shows something on one, such as
        "brlapi:HOST:N"; None for the one that BRLTTY drives on this machine.

    Raises
    ------
    InputError
        If the rate is out of range, or the sound is none of those four.
    """

    device: str = "sim"
    hand: str = "slow"
    answers: str = "typed"
    rate_hz: float = 1000.0
    fast: bool = False
    sound: str = "auto"
    live: LiveAddress | None = None
    markers: str | None = None
    also: str | None = None

    def __post_init__(self) -> None:
        check_rate(self.rate_hz)
        if self.sound not in SOUNDS:
            raise InputError(f"there is no sound {self.sound!r}; give {', '.join(SOUNDS)}")

    @classmethod
    def of(cls, head: Mapping[str, Any]) -> Conditions:
        """Conditions that a session began with, read from its session.json."""
        names = ("device", "hand", "answers", "rate_hz", "fast")
        return cls(**{name: head[name] for name in names}, also=head.get("also"))


USUAL = Conditions()
