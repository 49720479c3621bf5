"""Mixed designs: against published numbers, and against a regression with statsmodels."""

import numpy as np
import pandas as pd
import pytest
import statsmodels.formula.api as smf
from statsmodels.stats.anova import anova_lm

from vbraille.analysis.statistics.anova import anova
from vbraille.analysis.statistics.intervals import Unanswerable

# O'Brien and Kaiser 1985, table 7: scores before, after and later, five hours each.
SCORES = """
control M 1 2 4 2 1 3 2 5 3 2 2 3 2 4 4
control M 4 4 5 3 4 2 2 3 5 3 4 5 6 4 1
control M 5 6 5 7 7 4 5 7 5 4 7 6 9 7 6
control F 5 4 7 5 4 2 2 3 5 3 4 4 5 3 4
control F 3 4 6 4 3 6 7 8 6 3 4 3 6 4 3
A M 7 8 7 9 9 9 9 10 8 9 9 10 11 9 6
A M 5 5 6 4 5 7 7 8 10 8 8 9 11 9 8
A F 2 3 5 3 2 2 4 8 6 5 6 6 7 5 6
A F 3 3 4 6 4 4 5 6 4 1 5 4 7 5 4
B M 4 4 5 3 4 6 7 6 8 8 8 8 9 7 8
B M 3 3 4 2 3 5 4 7 5 4 5 6 8 6 5
B M 6 7 8 6 3 9 10 11 9 6 8 7 10 8 7
B F 5 5 6 8 6 4 6 6 8 6 7 7 8 10 8
B F 2 2 3 1 2 5 6 7 5 2 6 7 8 6 3
B F 2 2 3 4 4 6 6 7 9 7 7 7 8 6 7
B F 4 5 7 5 4 7 7 8 6 7 7 8 10 8 7
"""


@pytest.fixture(scope="module")
def published():
    """Their analysis by what each effect is called."""
    rows = [
        (str(who), line.split()[0], line.split()[1], str(phase), str(hour), float(score))
        for who, line in enumerate(SCORES.strip().splitlines())
        for (phase, hour), score in zip(np.ndindex(3, 5), line.split()[2:], strict=True)
    ]
    who, treatment, gender, phase, hour, score = zip(*rows, strict=True)
    found = anova(
        who, {"phase": phase, "hour": hour}, score, {"treatment": treatment, "gender": gender}
    )
    return {effect.name: effect for effect in found.effects}


# As the help of R's car::Anova prints them: Fox and Weisberg 2019, univariate type III tests.
@pytest.mark.parametrize(
    ("name", "df1", "df2", "f", "p"),
    [
        ("treatment", 2, 10, 3.9405, 0.0547069),
        ("gender", 1, 10, 3.6591, 0.0848003),
        ("treatment × gender", 2, 10, 2.8555, 0.1044692),
        ("phase", 2, 20, 16.1329, 6.732e-05),
        ("treatment × phase", 4, 20, 4.8510, 0.0067232),
        ("hour", 4, 40, 16.6856, 4.027e-08),
    ],
)
def test_as_published(published, name, df1, df2, f, p):
    effect = published[name]
    assert (effect.df1, effect.df2) == (df1, df2)
    assert effect.f == pytest.approx(f, abs=1e-4)
    assert effect.p == pytest.approx(p, rel=1e-3)


@pytest.mark.parametrize(
    ("name", "epsilon"),
    [("phase", 0.79953), ("treatment × phase", 0.79953), ("hour", 0.46028),
     ("phase × hour", 0.44950)],
)  # fmt: skip
def test_epsilons_as_published(published, name, epsilon):
    assert published[name].epsilon == pytest.approx(epsilon, abs=1e-5)


def made(groups=(4, 6, 3), levels=3, seed=1):
    """Scores in long form of groups of unequal size."""
    random = np.random.default_rng(seed)
    frame = pd.DataFrame(
        [
            (f"P{who}", f"G{group}", f"L{level}")
            for who, group in enumerate(np.repeat(range(len(groups)), groups))
            for level in range(levels)
        ],
        columns=["who", "group", "level"],
    )
    own = random.normal(size=sum(groups))
    score = np.repeat(own, levels) + random.normal(size=len(frame)) + (frame["level"] == "L1")
    return frame.assign(score=score)


def of_frame(frame):
    return anova(
        frame["who"].tolist(),
        {"level": frame["level"].tolist()},
        frame["score"].tolist(),
        {"group": frame["group"].tolist()},
    )


def test_as_by_regression():
    """Type III sums of squares of a regression with a code for each participant."""
    frame = made()
    found = {effect.name: effect for effect in of_frame(frame).effects}
    within = frame["score"] - frame.groupby("who")["score"].transform("mean")
    model = smf.ols("within ~ C(level, Sum) * C(group, Sum)", frame.assign(within=within)).fit()
    table = anova_lm(model, typ=3)["sum_sq"]
    error = table["Residual"]
    for name, term in (
        ("level", "C(level, Sum)"),
        ("group × level", "C(level, Sum):C(group, Sum)"),
    ):
        effect = found[name]
        assert effect.f == pytest.approx(table[term] / effect.df1 / (error / effect.df2))
    means = frame.groupby(["who", "group"], as_index=False)["score"].mean()
    other = anova_lm(smf.ols("score ~ C(group, Sum)", means).fit(), typ=3)
    assert found["group"].f == pytest.approx(other["F"].iloc[1])
    assert found["group"].p == pytest.approx(other["PR(>F)"].iloc[1])


def test_who_misses_a_cell_is_named():
    frame = made()
    found = of_frame(frame.drop(index=0))
    assert found.dropped == (("P0", (("L0",),)),)
    assert found.effects[0].df2 == 9


def test_scores_alike_have_no_f():
    frame = made()
    alike = frame["level"].map({"L0": 1.0, "L1": 2.0, "L2": 4.0})
    effect = of_frame(frame.assign(score=alike)).effects[1]
    assert effect.f is None
    assert effect.note == "all participants of a group are alike; F has no value"


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        (lambda f: f.assign(group="G0"), "everybody has the same group, 'G0'"),
        (lambda f: f.assign(group=f["level"]), "participant 'P0' is in two groups, 'L0' and 'L1'"),
        (lambda f: f.groupby("group").head(3), "3 participants in 3 groups; some group needs two"),
    ],
    ids=["one group", "two groups of one", "one each"],
)
def test_what_is_no_mixed_design(change, reason):
    with pytest.raises(Unanswerable, match=reason):
        of_frame(change(made()))


def test_a_group_that_nobody_is_in():
    frame = made().assign(other=lambda f: f["group"].map({"G0": "x", "G1": "y", "G2": "x"}))
    with pytest.raises(Unanswerable, match="no participant with every score is in 'G0, y'"):
        anova(
            frame["who"].tolist(),
            {"level": frame["level"].tolist()},
            frame["score"].tolist(),
            {"group": frame["group"].tolist(), "other": frame["other"].tolist()},
        )
