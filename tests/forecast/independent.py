"""Power of a crossed design, by studies that are drawn and analysed one by one."""

import numpy as np
from scipy.special import expit
from scipy.stats import norm

from vbraille.analysis.statistics.comparisons import CellDesign, CellShares, effects
from vbraille.forecast.power import PowerQuestion, power
from vbraille.forecast.workers import Workers
from vbraille.sessions.planning.protocolfiles import parse_protocol

PEOPLE, BETWEEN, DIFFERING = 12, 0.6, 0.3
TEXT = """
format = 1
name = "crossed"
title = "Texture and contrast, in two groups"
source = "ours"
model = "stress2"

[design]
kind = "list"
strings = ["bace", "dfih", "gjam", "kolp", "nest", "quip", "rvex", "zywt"]
repeats = 2

[[factors]]
name = "texture"
levels = [{ name = "flat", texture = 0.0 }, { name = "rough", texture = 1.0 }]

[[factors]]
name = "contrast"
levels = [
    { name = "a", contrast = 0.4 }, { name = "b", contrast = 0.7 }, { name = "c", contrast = 1.0 },
]

[[factors]]
name = "mapping"
between = true
levels = [{ name = "near", mapping = "alternate" }, { name = "other", mapping = "paired" }]

[practice]
trials = 0
"""
# By texture, contrast and group.
SHARES = np.array([[[0.45, 0.5], [0.5, 0.55], [0.55, 0.7]], [[0.5, 0.6], [0.6, 0.7], [0.65, 0.9]]])


def drawn(studies, seed=11):
    """Studies in which each effect, in order, and each difference in it, is found; as shares."""
    random = np.random.default_rng(seed)
    places = np.array(list(np.ndindex(SHARES.shape)))
    design = CellDesign(places)
    group = np.arange(PEOPLE) % 2
    asked = np.where(places[:, 2] == group[:, None], 16, 0)
    middles = _log_odds(SHARES.ravel())
    found = 0
    for _ in range(studies):
        eta = middles + BETWEEN * random.normal(size=(PEOPLE, 1))
        eta = eta + DIFFERING * random.normal(size=(PEOPLE, 12))
        correct = random.binomial(asked, expit(eta))
        tested = effects(CellShares(correct, asked, design), "holm")
        p = [
            one
            for effect in tested
            for one in (effect.p, *(p for pair, _, p in effect.pairs if _is_told(pair)))
        ]
        found = found + (np.array([1.0 if one is None else one for one in p]) < 0.05)
    return found / studies


def off_by(studies):
    """Largest difference of any power from that of `vbraille power`, and of what."""
    effect = {
        f"{group}:{texture}-{contrast}": f"{SHARES[t, c, g]}"
        for g, group in enumerate(("near", "other"))
        for t, texture in enumerate(("flat", "rough"))
        for c, contrast in enumerate("abc")
    }
    question = PowerQuestion(
        parse_protocol(TEXT, "crossed.toml"), effect, (PEOPLE,), BETWEEN, DIFFERING, studies=studies
    )
    rows = power(question, Workers()).rows
    off = np.abs(np.array([row.power for row in rows]) - drawn(studies))
    return float(off.max()), rows[int(off.argmax())].compared


def _is_told(pair):
    return pair.at is not None or pair.factor == 1  # the only difference of two levels is an effect


def _log_odds(shares):
    """Log odds whose mean share over people is this, by plain sums over a normal variable."""
    at = (np.arange(4000) + 0.5) / 4000
    people = np.hypot(BETWEEN, DIFFERING) * norm.ppf(at)
    grid = np.linspace(-6, 6, 4001)
    means = expit(grid[:, None] + people[::8]).mean(axis=1)
    return np.interp(shares, means, grid)
