"""Power of t-tests in closed form, which simulated studies are held against."""

import math

import numpy as np
from scipy.special import expit
from scipy.stats import nct
from scipy.stats import t as student

_NODES, _WEIGHTS = np.polynomial.hermite_e.hermegauss(80)


def of_row(question, row):
    """Power of a row of two conditions, if shares were normal."""
    plan = question.plan()
    mean, spread = mean_and_spread(plan, 0, 1, plan.trials[0])
    return t_power(mean / spread, row.participants)


def t_power(d, n, alpha=0.05):
    """Power of a two-sided paired t-test, by the noncentral t distribution.

    Parameters
    ----------
    d
        Mean of the differences by their standard deviation.
    n
        Number of differences, 2 or more.
    alpha
        Level of the test.
    """
    critical, off = float(student.ppf(1 - alpha / 2, n - 1)), abs(d) * math.sqrt(n)
    return float(nct.sf(critical, n - 1, off) + nct.cdf(-critical, n - 1, off))


def mean_and_spread(plan, first, second, trials):
    """Mean and s.d. over people of a difference of shares, exactly; by equation 1.

    Parameters
    ----------
    plan
        What is simulated.
    first, second
        Conditions; the second is None for the difference of the first to one half.
    trials
        Trials of a participant in each condition.
    """
    weights = _WEIGHTS / _WEIGHTS.sum()
    own = []
    for condition in (first,) if second is None else (first, second):
        # Shares given a participant's z, and what varies beside it.
        log_odds = plan.middles[condition] + plan.between * _NODES
        shares = expit(log_odds[:, None] + plan.differing * _NODES)
        mean = shares @ weights
        within = (shares * (1 - shares)) @ weights / trials[condition]
        own.append((mean, within + (shares - mean[:, None]) ** 2 @ weights))
    apart = own[0][0] - (0.5 if second is None else own[1][0])
    mean = float(apart @ weights)
    variance = sum(of[1] for of in own) @ weights + (apart - mean) ** 2 @ weights
    return mean, float(np.sqrt(variance))
