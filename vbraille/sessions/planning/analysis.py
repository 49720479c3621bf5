"""The analysis that a protocol plans before its first session."""

from __future__ import annotations

from typing import Annotated, Literal

from msgspec import Meta

from vbraille.sessions.planning.values import Seconds, Share
from vbraille.toml import Table, WrongValue

# Measures, by their names in sentences.
MEASURES = {
    "legibility": "legibility of strings",
    "characters": "legibility of characters",
    "duration": "duration of right answers",
    "right": "right answers",
    "threshold": "threshold",
    "d_prime": "d′",
    "preferred": "preferred value",
    "rating": "rating",
    "magnitude": "magnitude",
    "adjusted": "adjusted value",
    "reading_speed": "reading speed in words a minute",
}
# Measures of each kind of question, the usual one first; of words there is none.
MEASURES_OF = {
    "identify": ("legibility", "characters", "duration", "threshold"),
    "which": ("preferred", "threshold", "right", "duration"),
    "odd": ("right", "threshold", "duration"),
    "match": ("right", "threshold", "duration"),
    "same-different": ("right", "d_prime"),
    "detect": ("d_prime", "right", "threshold"),
    "rating": ("rating",),
    "magnitude": ("magnitude",),
    "name": ("right", "duration"),
    "read": ("reading_speed",),
    "adjust": ("adjusted",),
    "free": (),
}


class Analysis(Table, frozen=True, kw_only=True):
    """Purpose of the sessions, fixed before the first of them.

    Parameters
    ----------
    measure
        Primary measure, a key of `MEASURES`; None for the usual one of the question.
    factors
        Factors that it is compared by, "condition" for conditions that are listed, or columns of
        the file of items, such as "item_size"; None for all factors.
    too_fast_s, too_slow_s
        Trials that took less, or more, are left out.
    catch_right
        A participant with a smaller share of catch trials right is left out.
    participants, stop
        How many people are planned, and in words when no more are asked.
    """

    measure: Literal[tuple(MEASURES)] | None = None  # pyright: ignore
    factors: tuple[str, ...] | None = None
    too_fast_s: Seconds | None = None
    too_slow_s: Seconds | None = None
    catch_right: Share | None = None
    participants: Annotated[int, Meta(ge=1, le=10_000)] | None = None
    stop: Annotated[str, Meta(max_length=300)] = ""

    def __post_init__(self) -> None:
        if (self.too_fast_s or 0.0) >= (self.too_slow_s or float("inf")):
            raise WrongValue("too_fast_s", "must be below too_slow_s")

    def said(self) -> str:
        """Describe it in a line."""
        if self.measure is None:
            return "none, as answers are words"
        told = [MEASURES[self.measure]]
        told[0] += " by " + " × ".join(self.factors) if self.factors else ""
        for limit, words in ((self.too_fast_s, "below"), (self.too_slow_s, "above")):
            told += [] if limit is None else [f"without trials {words} {limit:g} s"]
        if self.catch_right is not None:
            told.append(
                f"without people with less than {self.catch_right:.0%} of catch trials right"
            )
        told += [] if self.participants is None else [f"{self.participants} participants"]
        return "; ".join(filter(None, (*told, self.stop)))
