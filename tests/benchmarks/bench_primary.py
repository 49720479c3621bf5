"""The report's first layer: how often its intervals hold the truth, and how often it is wrong.

Null studies are of each shipped protocol as it is planned: its people, groups, conditions and
trials, and its analysis, where people differ and conditions do not. Intervals are of studies in
which they do. Measures of one person (a threshold, d′, a preferred value) are found for a pool of
people by the program's own measures; studies are drawn from it.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import pandas as pd
from scipy.special import expit
from scipy.stats import norm

from tests.benchmarks.timing import Result
from vbraille.analysis.measures.preferences import own_values
from vbraille.analysis.statistics.comparisons import (
    CellDesign,
    CellScores,
    CellShares,
    effects,
)
from vbraille.analysis.statistics.detection import same_different, yes_no
from vbraille.analysis.statistics.intervals import Interval, Unanswerable
from vbraille.analysis.statistics.psychometric import fit_psychometric
from vbraille.forecast.power import PowerQuestion, names_of
from vbraille.forecast.studies import StudyTask, _in_cells, _scores, log_odds_of, simulate
from vbraille.sessions.planning.analysis import MEASURES
from vbraille.sessions.planning.protocolfiles import builtin_names, load_protocol

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

STUDIES, POOL = 2500, 4000
PEOPLE = (3, 5, 8, 12)
LEAST, MOST = 93.0, 98.0
FEWEST_GIVEN = 0.05  # of the studies; of fewer intervals too little is known
ANY = Interval(-math.inf, math.inf)


def run() -> Iterator[Result]:
    for name in builtin_names():
        yield false_findings(name, STUDIES)
    for each in (*shares(STUDIES), *scores(STUDIES), *of_pools(STUDIES, POOL)):
        yield each.result()


def false_findings(name: str, studies: int) -> Result:
    """Null studies of a protocol in which any test of the first layer finds something."""
    protocol = load_protocol(name)
    analysis = protocol.planned_analysis
    what = f"any finding in {studies} null studies of {name}, {analysis.participants} people"
    if not analysis.factors:
        return Result(what, "≤ 6 %", "it tests nothing", True)
    share = MEASURES[analysis.measure or ""].scale == "share"
    value = "0.6" if share else "4"
    effect = dict.fromkeys(names_of(protocol, analysis), value)
    size = analysis.participants or 12
    question = PowerQuestion(protocol, effect, (size,), between=0.8, differing=0.4)
    plan = question.plan()
    values, asked = _in_cells(plan, simulate(StudyTask(plan, 1, 0, studies)))
    wrong = 0
    for own in values:
        if plan.model == "trials":
            data: CellShares | CellScores = CellShares(own.astype(np.int64), asked, plan.design)
        else:
            data = _scores(plan, own if share else np.clip(np.round(3 * own) / 3, 1, 7), asked)
        tested = effects(data, analysis.correction)
        every = [effect.p for effect in tested] + [p for e in tested for *_, p in e.pairs]
        wrong += min((p for p in every if p is not None), default=1.0) < 0.05
    return Result(what, "≤ 6 %", f"{100 * wrong / studies:.1f} %", wrong <= 0.06 * studies)


class Coverage(NamedTuple):
    """Shares of simulated studies whose interval holds the truth, and whose interval is given."""

    what: str
    held: int
    given: int
    studies: int

    def result(self) -> Result:
        share = 100 * self.held / max(self.given, 1)
        few = self.given < FEWEST_GIVEN * self.studies
        part = f"{100 * self.given / self.studies:.0f} % given"
        shown = "not given" if not self.given else f"{share:.1f} % ({part})"
        return Result(self.what, "93 to 98 %, or not given", shown, few or LEAST <= share <= MOST)


def counted(what: str, truths: list[tuple[object, float]], studies: int) -> Coverage:
    """Coverage of estimates, each with the truth."""
    known = [(one, truth) for one, truth in truths if one.low is not None]
    held = sum(one.low <= truth <= one.high for one, truth in known)
    return Coverage(what, held, len(known), studies)


def shares(studies: int) -> Iterator[Coverage]:
    """Means, differences of two conditions and of two groups, of shares by single trials."""
    random = np.random.default_rng(1)
    design = CellDesign(np.array([[0], [1]]))
    for people in PEOPLE:
        for middle, spread in ((0.6, 0.8), (0.9, 0.8)):
            truth = [middle, middle + (0.1 if middle < 0.8 else 0.05)]
            each = math.hypot(spread, 0.4)
            means, within, between = [], [], []
            for _ in range(studies):
                own = np.array([log_odds_of_once(share, each) for share in truth])
                eta = own + spread * random.normal(size=(people, 1))
                eta = eta + 0.4 * random.normal(size=(people, 2))
                asked = np.full((people, 2), 40)
                correct = random.binomial(40, expit(eta))
                data = CellShares(correct, asked, design)
                means.append((data.mean(0), truth[0]))
                weights = np.array([1.0, -1.0])
                within.append((data.contrast(weights), truth[0] - truth[1]))
                if people > PEOPLE[0]:
                    apart = asked * (np.arange(people)[:, None] % 2 == np.arange(2))
                    data = CellShares(np.minimum(correct, apart), apart, design)
                    between.append((data.contrast(weights), truth[0] - truth[1]))
            what = f"{people} people, share {middle:g}"
            yield counted(f"mean share, {what}", means, studies)
            yield counted(f"difference of conditions, {what}", within, studies)
            if between:
                yield counted(f"difference of groups, {what}", between, studies)


_LOG_ODDS: dict[tuple[float, float], float] = {}


def log_odds_of_once(share: float, spread: float) -> float:
    """`log_odds_of`, kept."""
    if (share, spread) not in _LOG_ODDS:
        _LOG_ODDS[share, spread] = log_odds_of(share, spread)
    return _LOG_ODDS[share, spread]


def scores(studies: int) -> Iterator[Coverage]:
    """Means and differences of logarithms of durations, and of ratings from 1 to 7."""
    random = np.random.default_rng(2)
    design = CellDesign(np.array([[0], [1]]))
    weights = np.array([1.0, -1.0])
    for people in PEOPLE:
        group = np.arange(people) % 2
        for word in ("duration", "rating"):
            means, within, between = [], [], []
            middle = np.array([1.0, 1.2]) if word == "duration" else np.array([4.0, 4.8])
            truth = middle if word == "duration" else ratings_of(middle)
            for _ in range(studies):
                own = middle + 0.4 * random.normal(size=(people, 1))
                own = own + 0.2 * random.normal(size=(people, 2))
                if word == "duration":  # 20 right answers each
                    own = own + 0.4 / math.sqrt(20) * random.normal(size=(people, 2))
                else:  # the mean of nine ratings
                    each = own[..., None] + random.normal(size=(people, 2, 9))
                    own = np.clip(np.round(each), 1, 7).mean(axis=-1)
                scale = ANY if word == "duration" else Interval(1.0, 7.0)
                zero = np.zeros(people, np.int64)
                data = CellScores(own, design, zero, np.zeros(2, np.int64), scale)
                means.append((data.mean(0), truth[0]))
                within.append((data.contrast(weights), truth[0] - truth[1]))
                if people > PEOPLE[0]:
                    apart = np.where(group[:, None] == np.arange(2), own, np.nan)
                    data = CellScores(apart, design, group, np.arange(2), scale)
                    between.append((data.contrast(weights), truth[0] - truth[1]))
            yield counted(f"mean {word}, {people} people", means, studies)
            yield counted(f"difference of conditions, {word}, {people} people", within, studies)
            if between:
                yield counted(f"difference of groups, {word}, {people} people", between, studies)


def ratings_of(middle: Floats) -> Floats:
    """Mean rating over the population whose latent ratings have these means."""
    spread = math.sqrt(0.4**2 + 0.2**2 + 1)
    edges = np.arange(1.5, 7)
    return np.array([7 - norm.cdf((edges - mean) / spread).sum() for mean in middle])


def of_pools(studies: int, pool: int) -> Iterator[Coverage]:
    """Mean of a measure that each person's trials are fitted for."""
    random = np.random.default_rng(3)
    for what, truth, found in (
        ("threshold of detection", math.log(0.2), thresholds(random, pool)),
        ("preferred value of a tuning, 90 pairs", 1.8, preferred_values(random, pool // 3)),
        ("d′ of yes and no, 36 trials", 1.5, d_primes(random, pool)),
        ("d′ of same and different, 72 trials", 2.0, same_or_different(random, pool)),
    ):
        for people in PEOPLE:
            told = []
            for _ in range(studies):
                own = random.choice(found, (people, 1))
                own = own[~np.isnan(own[:, 0])]
                zero = np.zeros(len(own), np.int64)
                data = CellScores(own, CellDesign(np.zeros((1, 0), np.int64)), zero, zero[:1])
                told.append((data.mean(0), truth))
            yield counted(f"{what}, {people} people", told, studies)


def thresholds(random: np.random.Generator, pool: int) -> Floats:
    """Logarithms of thresholds by the trials of the protocol detection: 12 of each of 4."""
    levels = np.array([0.1, 0.2, 0.4])
    found = np.full(pool, np.nan)
    for at in range(pool):
        middle = 0.2 * math.exp(0.3 * random.normal())
        share = 0.1 + 0.88 * expit((levels - middle) / 0.04)
        yes = random.binomial(12, share)
        blanks = int(random.binomial(12, 0.1)), 12
        try:
            fit = fit_psychometric(
                levels, yes, np.full(3, 12), shape="logistic", guess=None, blanks=blanks,
                scale=(0.0, 1.0),
            )  # fmt: skip
        except Unanswerable:
            continue
        if fit.threshold > 0:
            found[at] = math.log(fit.threshold)
    return found


def preferred_values(random: np.random.Generator, pool: int) -> Floats:
    """Preferred values (mm) of 30 ordered pairs of six widths, 3 times each, by the model."""
    widths = np.linspace(0.5, 3.0, 6)
    pairs = np.array([(a, b) for a in widths for b in widths if a != b] * 3)
    whole = []
    for at in range(pool):
        liked = 1.8 + 0.25 * random.normal()
        felt = np.abs(pairs - liked) + 0.3 * random.normal(size=pairs.shape) / math.sqrt(2)
        whole.append(
            pd.DataFrame(
                {
                    "participant": f"P{at}",
                    "parameter": "dot_width_mm",
                    "first": pairs[:, 0],
                    "second": pairs[:, 1],
                    "chosen": felt.argmin(axis=1),
                }
            )
        )
    table = pd.concat(whole, ignore_index=True)
    table = table.assign(parameter=table["parameter"].astype("category"))
    return own_values(table, []).frame["preferred"].to_numpy(np.float64)


def d_primes(random: np.random.Generator, pool: int) -> Floats:
    """d′ of 18 trials with and 18 without a signal."""
    own = 1.5 + 0.5 * random.normal(size=pool)
    hits = random.binomial(18, norm.cdf(own / 2))
    alarms = random.binomial(18, norm.cdf(-own / 2))
    pairs = zip(hits.tolist(), alarms.tolist(), strict=True)
    return np.array([yes_no(hit, 18, alarm, 18).d_prime for hit, alarm in pairs])


def same_or_different(random: np.random.Generator, pool: int) -> Floats:
    """d′ of 36 equal and 36 different pairs, judged by the difference felt."""
    own = 2.0 + 0.5 * random.normal(size=pool)
    criterion = 1.8
    root = math.sqrt(2)

    def beyond(apart: Floats) -> Floats:
        return norm.sf((criterion - apart) / root) + norm.cdf((-criterion - apart) / root)

    hits = random.binomial(36, beyond(own))
    alarms = random.binomial(36, beyond(np.zeros(pool)))
    found = np.full(pool, np.nan)
    for at in range(pool):
        try:
            found[at] = same_different(int(hits[at]), 36, int(alarms[at]), 36).d_prime
        except Unanswerable:
            continue
    return found
