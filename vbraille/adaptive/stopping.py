"""When enough was asked: by trials, by precision, by time."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Sequence

    from vbraille.adaptive.estimates import GridEstimate


@dataclass(frozen=True, slots=True)
class Asked:
    """A question that was answered.

    Parameters
    ----------
    stimulus
        What was shown: a value, or an ordered pair of values.
    outcome
        Number of the outcome. 1 is the positive one: yes, right, or the first of the pair.
    t_s
        Seconds of the session at the answer.
    """

    stimulus: tuple[float, ...]
    outcome: int
    t_s: float = 0.0


@dataclass(frozen=True, slots=True)
class StopRule:
    """Limits, of which the first that is reached ends the questions.

    Parameters
    ----------
    trials
        Most questions; None for no limit.
    sd
        Largest standard deviation of the estimate that is precise enough; None for no limit.
    width
        Largest width of the credible interval of 95 % that is precise enough; None for no limit.
    at_least
        Number of questions before precision counts, since a few lucky answers look precise.
    seconds
        Seconds of the session after which nothing more is asked; None for no limit.

    Raises
    ------
    ValueError
        If a limit is not above 0.
    """

    trials: int | None = None
    sd: float | None = None
    width: float | None = None
    at_least: int = 1
    seconds: float | None = None

    def __post_init__(self) -> None:
        limits = ("trials", "sd", "width", "at_least", "seconds")
        for name in limits:
            value = getattr(self, name)
            if value is not None and not value > 0:
                raise ValueError(f"{name} is {value:g}; it must be above 0")

    @property
    def by_precision(self) -> bool:
        """Whether an estimate is needed to say whether enough was asked."""
        return self.sd is not None or self.width is not None

    def out_of_limits(self, history: Sequence[Asked]) -> bool:
        """Whether there were as many questions, or as many seconds, as are allowed."""
        if self.trials is not None and len(history) >= self.trials:
            return True
        return self.seconds is not None and bool(history) and history[-1].t_s >= self.seconds

    def precise(self, asked: int, found: GridEstimate) -> bool:
        """Whether an estimate after a number of questions is precise enough."""
        if asked < self.at_least or not self.by_precision:
            return False
        return (self.sd is None or found.sd <= self.sd) and (
            self.width is None or found.width <= self.width
        )
