"""Time between the runs of a session, by a clock that nobody can set."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self

from vbraille.sessions.record.journal import up_s

if TYPE_CHECKING:
    from vbraille.sessions.record.eventbase import JournalEvent
    from vbraille.sessions.record.events import Run

_MOVED_S = 1.0  # smaller differences are ordinary corrections of a clock


@dataclass(frozen=True, slots=True)
class Moment:
    """A moment, by the wall clock and by the clock of the machine.

    Parameters
    ----------
    wall
        Time by the wall clock, which people and time servers set.
    up_s
        Seconds since the machine was started; None if the journal does not have them.
    boot
        Identifier of that start of the machine; empty if it is not known.
    """

    wall: datetime
    up_s: float | None
    boot: str

    @classmethod
    def now(cls) -> Self:
        """Take the present moment."""
        return cls(datetime.now(UTC), up_s(), boot())

    @classmethod
    def of(cls, event: JournalEvent, run: Run) -> Self:
        """Moment at which an event of a run happened."""
        return cls(datetime.fromisoformat(event.wall), event.up_s, run.boot)


def boot() -> str:
    """Identifier of this machine's last start; empty if the system does not tell it."""
    try:
        return Path("/proc/sys/kernel/random/boot_id").read_text().strip()
    except OSError:
        return ""


def gap(before: Moment, now: Moment) -> dict[str, Any]:
    """Fields of a run's event that tell how much time went by since the last event.

    Returns
    -------
    dict
        ``gap_s`` is the time in seconds. ``gap_by`` is the clock that it is measured by: machine,
        or wall if the machine was started anew meanwhile. ``clock_moved_s`` is how far the wall
        clock was set meanwhile, negative if back. ``gap_s`` is missing if only the wall clock
        could tell it and that clock went back.
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
    """Sentence about a clock that was set since the last event; None if it was not."""
    moved_s = told.get("clock_moved_s")
    if moved_s is None:
        return None
    how = f"{'back' if moved_s < 0 else 'forward'} by {abs(moved_s):g} s"
    if "gap_s" not in told:
        how += " or more, so that nobody knows how long the session was not run"
    return f"clock: since the last event the machine's clock was set {how}"
