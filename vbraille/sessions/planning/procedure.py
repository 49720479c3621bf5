"""Which trial comes next: by a plan that was made before the session, or by the answers so far.

A procedure keeps nothing of its own. All that it goes by is the history, which a session's journal
has, so that one that was killed and is gone on with asks the same question again.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from collections.abc import Sequence

    from vbraille.sessions.planning.stimuli import Trial


@dataclass(frozen=True, slots=True)
class Answered:
    """A trial that was answered.

    Parameters
    ----------
    trial
        What was shown, and asked.
    answer
        The answer that counts; `vbraille.braille.spelling` says how it is written.
    """

    trial: Trial
    answer: str


class Procedure(Protocol):
    """Says which trial comes next. The same history must always give the same trial."""

    @property
    def trials(self) -> Sequence[Trial] | None:
        """All trials in their order, if that is known before the first; None if answers say it."""
        ...

    def next(self, history: Sequence[Answered], /) -> Trial | None:
        """Trial that comes after those of a history, numbered after the last; None if none does.

        Practice is no part of the history. An answer that was taken back is not in it either, but
        the one that was given instead, in its place.
        """
        ...


@dataclass(frozen=True, slots=True)
class FixedOrder:
    """The trials of a plan, one after the other, whatever is answered.

    Parameters
    ----------
    trials
        All of them, in their order.
    """

    trials: tuple[Trial, ...]

    def next(self, history: Sequence[Answered], /) -> Trial | None:
        """Trial of the plan after so many answers; None after the last."""
        done = len(history)
        return self.trials[done] if done < len(self.trials) else None
