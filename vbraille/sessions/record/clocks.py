"""Time between the runs of a session, by a clock that nobody sets."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self

from vbraille.sessions.record.journal import up_s

if TYPE_CHECKING:
    from vbraille.sessions.record.events import Event, Run

_MOVED_S = 1.0  # less than that is a clock that is kept right


@dataclass(frozen=True, slots=True)
class Moment:
    """A moment, by the clocks that there are.

    Parameters
    ----------
    wall
        By the wall clock, which people and time servers set.
    up_s
        Seconds since the machine was started; None where that was not written down.
    boot
        Which start of the machine that is; empty if not known.
    """

    wall: datetime
    up_s: float | None
    boot: str

    @classmethod
    def now(cls) -> Self:
        """Tell the moment that it is."""
        return cls(datetime.now(UTC), up_s(), boot())

    @classmethod
    def of(cls, event: Event, run: Run) -> Self:
        """Moment of an event of a run."""
        return cls(datetime.fromisoformat(event.wall), event.up_s, run.boot)


def boot() -> str:
    """Which start of this machine it is; empty if the system does not tell."""
    try:
        return Path("/proc/sys/kernel/random/boot_id").read_text().strip()
    except OSError:
        return ""


def gap(before: Moment, now: Moment) -> dict[str, Any]:
    """What a run tells of the time since the last event.

    Returns
    -------
    dict
        ``gap_s`` in seconds, and by which clock that is: ``gap_by`` machine, or wall where the
        machine was started anew meanwhile. ``clock_moved_s``, by how much the wall clock was set
        meanwhile, back if below 0. A gap of which only the wall clock tells, and that ends
        before it began, has no ``gap_s``.
    """
    wall_s = (now.wall - before.wall).total_seconds()
    if before.up_s is None or now.up_s is None or not now.boot or before.boot != now.boot:
        if wall_s < 0:
            return {"gap_by": "wall", "clock_moved_s": round(wall_s, 3)}
        return {"gap_s": round(wall_s, 3), "gap_by": "wall"}
    gap_s = now.up_s - before.up_s
    told: dict[str, Any] = {"gap_s": round(gap_s, 3), "gap_by": "machine"}
    if abs(wall_s - gap_s) > _MOVED_S:
        told["clock_moved_s"] = round(wall_s - gap_s, 3)
    return told


def say_moved(told: dict[str, Any]) -> str | None:
    """Say that the clock was set meanwhile; None if it was not."""
    moved_s = told.get("clock_moved_s")
    if moved_s is None:
        return None
    how = f"{'back' if moved_s < 0 else 'forward'} by {abs(moved_s):g} s"
    if "gap_s" not in told:
        how += " or more, so that nobody knows how long the session was not run"
    return f"clock: since the last event the machine's clock was set {how}"
