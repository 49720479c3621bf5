"""An answer that has no confidence yet."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from vbraille.sessions.planning.stimuli import Trial


@dataclass(frozen=True, slots=True)
class HalfAnswer:
    """An answer whose confidence is waited for.

    Parameters
    ----------
    trial
        Trial that was answered.
    told
        Fields of the journal's event.
    at_s
        Seconds of the session at the answer.
    """

    trial: Trial
    told: dict[str, Any]
    at_s: float
