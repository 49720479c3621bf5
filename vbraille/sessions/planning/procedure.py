"""Choice of the next trial: by a plan made before the session, or by the answers so far.

A procedure has no memory of its own. It decides by the history alone, which the session's journal
keeps. So a session that was killed and is resumed asks the same question again.
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
        The trial; as it was shown, if the answers choose what is shown.
    answer
        The answer that counts; `vbraille.braille.spelling` says how it is written.
    t_s
        Seconds of the session at the answer; if it was taken back, at the one given instead.
    """

    trial: Trial
    answer: str
    t_s: float = 0.0


class Procedure(Protocol):
    """Rule that chooses the next trial. The same history must always give the same trial."""

    @property
    def trials(self) -> Sequence[Trial] | None:
        """All trials in order, if they are known beforehand; None if they depend on the answers."""
        ...

    def next(self, history: Sequence[Answered], /) -> Trial | None:
        """Trial that follows a history, with the next number; None if there are no more trials.

        The history leaves practice out. Where an answer was taken back, the history has in its
        place the answer that was given instead.
        """
        ...

    def found(self, history: Sequence[Answered], /) -> Sequence[str]:
        """Sentences on what the answers have shown; none if the procedure does not go by them."""
        ...


@dataclass(frozen=True, slots=True)
class FixedOrder:
    """Procedure that follows a plan, whatever is answered.

    Parameters
    ----------
    trials
        All trials of the plan, in order.
    """

    trials: tuple[Trial, ...]

    def next(self, history: Sequence[Answered], /) -> Trial | None:
        """Trial of the plan that follows the answered ones; None after the last."""
        done = len(history)
        return self.trials[done] if done < len(self.trials) else None

    def found(self, _history: Sequence[Answered], /) -> Sequence[str]:
        """No sentence: nothing is made of the answers."""
        return ()
