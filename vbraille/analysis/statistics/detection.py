"""Sensitivity d′ and criterion, with intervals.

For yes and no, for which of two, and for same or different (Macmillan and Creelman 2005, ch. 1, 2,
7 and 9). Shares of 0 and 1 have no z; the log-linear correction adds half an answer to each
(Hautus 1995). Intervals are of this participant: trials are its sample.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

from scipy.special import ndtr, ndtri

from vbraille.analysis.statistics.intervals import TAIL, Interval, Unanswerable

if TYPE_CHECKING:
    from collections.abc import Callable

LARGEST_D = 12.0  # d′ beyond which no share of answers tells it from more


class Detection(NamedTuple):
    """Sensitivity and bias.

    Parameters
    ----------
    d_prime, d_interval
        Distance of the two things in standard deviations of what is felt of each.
    criterion, criterion_interval
        Where between them the answer changes: 0 in the middle, above it for too few "yes", or
        "second", or "different".
    """

    d_prime: float
    d_interval: Interval
    criterion: float
    criterion_interval: Interval


def yes_no(hits: int, signals: int, false_alarms: int, noises: int) -> Detection:
    """Sensitivity d′ = z(H) - z(F) and criterion c = -(z(H) + z(F)) / 2 of yes and no.

    Intervals are Gourevitch and Galanter's (1967), with shares after the log-linear correction.

    Parameters
    ----------
    hits, signals
        Number of "yes" among trials with something, and of these trials.
    false_alarms, noises
        The same of trials with nothing.

    Raises
    ------
    Unanswerable
        If there are no trials of one kind.
    ValueError
        If there are more answers than trials.
    """
    z_hit, hit_variance = _z(hits, signals, "with something")
    z_false, false_variance = _z(false_alarms, noises, "with nothing")
    half = float(ndtri(1 - TAIL)) * math.sqrt(hit_variance + false_variance)
    d, c = z_hit - z_false, -(z_hit + z_false) / 2
    return Detection(
        d,
        Interval(d - half, d + half),
        c,
        Interval(c - half / 2, c + half / 2),
    )


def two_alternatives(hits: int, firsts: int, false_alarms: int, seconds: int) -> Detection:
    """Sensitivity of which of two: d′ = (z(H) - z(F)) / √2, for two looks at the difference.

    Parameters
    ----------
    hits, firsts
        Number of answers "first" where the first was it, and of these trials.
    false_alarms, seconds
        Number of answers "first" where the second was, and of these trials.

    Raises
    ------
    Unanswerable
        If there are no trials of one order.
    ValueError
        If there are more answers than trials.
    """
    return _scaled(yes_no(hits, firsts, false_alarms, seconds), lambda d: d / math.sqrt(2))


def same_different(
    hits: int,
    differents: int,
    false_alarms: int,
    sames: int,
) -> Detection:
    """Sensitivity of same or different, where "different" is the yes.

    By differencing, as where pairs vary from trial to trial, the difference felt is held against a
    criterion k: F = 2 Φ(-k / √2), H = Φ((d′ - k) / √2) + Φ((-d′ - k) / √2). The criterion is that
    of yes and no.

    Parameters
    ----------
    hits, differents
        Number of "different" among trials with two that differ, and of these trials.
    false_alarms, sames
        The same of trials with two alike.

    Raises
    ------
    Unanswerable
        If there are no trials of one kind.
    ValueError
        If there are more answers than trials.
    """
    found = yes_no(hits, differents, false_alarms, sames)
    z_false, _ = _z(false_alarms, sames, "with nothing")
    middle = float(ndtr(z_false))

    def roved(d_yes_no: float) -> float:
        # The false alarms stay what they are; hits are what would give this d′ of yes and no.
        return _differenced(float(ndtr(ndtri(middle) + d_yes_no)), middle)

    return _scaled(found, roved)


def _scaled(found: Detection, change: Callable[[float], float]) -> Detection:
    """The same with d′ and its interval changed by a function that rises."""
    ends = found.d_interval
    return found._replace(
        d_prime=change(found.d_prime), d_interval=Interval(change(ends.low), change(ends.high))
    )


def _differenced(hits: float, false_alarms: float) -> float:
    """d′ of same or different by the difference felt; 0 where hits are no more than others."""
    if hits <= false_alarms:
        return 0.0
    k = -math.sqrt(2) * float(ndtri(false_alarms / 2))

    def excess(d: float) -> float:
        return float(ndtr((d - k) / math.sqrt(2)) + ndtr((-d - k) / math.sqrt(2))) - hits

    if excess(4 * LARGEST_D) <= 0:
        return 4 * LARGEST_D
    from scipy.optimize import root_scalar  # takes a while to load

    return float(root_scalar(excess, bracket=(0.0, 4 * LARGEST_D)).root)


def _z(yes: int, trials: int, what: str) -> tuple[float, float]:
    """Z of a share with the log-linear correction, and its variance by the binomial one."""
    if not 0 <= yes <= trials:
        raise ValueError(f"{yes} answers of {trials} trials")
    if not trials:
        raise Unanswerable(f"no trials {what}")
    share = (yes + 0.5) / (trials + 1)
    z = float(ndtri(share))
    return z, share * (1 - share) / trials / (math.exp(-(z**2)) / (2 * math.pi))
