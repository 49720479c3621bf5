import time
from itertools import combinations

import numpy as np
import pandas as pd
import pytest
from scipy.stats import f
from statsmodels.stats.anova import AnovaRM

from vbraille.analysis.statistics.anova import anova, orthonormal_contrasts


def long_form(cube, names=("A", "B", "X", "Y")):
    """Participants, factors and scores of a cube float64[participants, levels, …]."""
    index = np.indices(cube.shape).reshape(cube.ndim, -1)
    factors = {
        name: [f"{name}{i}" for i in column] for name, column in zip(names, index[1:], strict=False)
    }
    return [f"S{i}" for i in index[0]], factors, cube.ravel()


def frame(participants, factors, scores):
    return pd.DataFrame({"who": participants, **factors, "score": scores})


def random_cube(rng, *shape):
    """Scores with effects, and unequal variances so that sphericity fails."""
    spread = rng.uniform(1, 6, shape[1:])
    return rng.normal(50, 8, (shape[0], *[1] * (len(shape) - 1))) + rng.normal(
        rng.normal(0, 3, shape[1:]), spread, shape
    )


def projections(cube):
    """F and sums of squares by projecting on the full Kronecker product of centring matrices."""
    n, *levels = cube.shape
    y, found = cube.reshape(n, -1), {}
    subsets = [s for size in range(len(levels) + 1) for s in combinations(range(len(levels)), size)]
    for subset in subsets:
        part = np.ones((1, 1))
        for axis, k in enumerate(levels):
            flat = np.full((k, k), 1 / k)
            part = np.kron(part, np.eye(k) - flat if axis in subset else flat)
        z = y @ part
        mean = z.mean(axis=0)
        found[subset] = n * (mean**2).sum(), ((z - mean) ** 2).sum(), np.cov(z.T)
    return found


# pingouin 0.7 asks pandas 3.1 in a way it is going to drop.
@pytest.mark.filterwarnings("ignore:The inplace keyword:DeprecationWarning")
@pytest.mark.parametrize("shape", [(6, 2), (6, 3), (12, 4), (5, 7)])
def test_one_factor_is_pingouins(rng, pingouin, shape):
    table = long_form(random_cube(rng, *shape))
    (ours,) = anova(*table).effects
    data = frame(*table)
    named = {"data": data, "dv": "score", "within": "A", "subject": "who"}
    theirs = pingouin.rm_anova(**named, correction=True).iloc[0]
    n, k = shape
    assert ours.note == ""
    assert (ours.df1, ours.df2) == (k - 1, (k - 1) * (n - 1))
    assert ours.f == pytest.approx(theirs["F"])
    assert ours.p == pytest.approx(theirs["p_unc"])
    assert ours.epsilon == pytest.approx(theirs["eps"])
    if k == 2:
        assert ours.p_corrected == ours.p
    else:
        assert ours.p_corrected == pytest.approx(theirs["p_GG_corr"])


@pytest.mark.parametrize("shape", [(6, 3, 2), (9, 2, 4), (10, 3, 3)])
def test_two_factors_are_pingouins(rng, pingouin, shape):
    table = long_form(random_cube(rng, *shape))
    named = {"data": frame(*table), "dv": "score", "within": ["A", "B"], "subject": "who"}
    theirs = pingouin.rm_anova(**named)
    for i, ours in enumerate(anova(*table).effects):
        row = theirs.iloc[i]
        assert (ours.df1, ours.df2) == (row["ddof1"], row["ddof2"])
        assert ours.f == pytest.approx(row["F"])
        assert ours.p == pytest.approx(row["p_unc"])
        # Of interactions too in pingouin 0.6 and later; before, of those with a factor of two.
        if " × " not in ours.name or 2 in shape[1:]:
            assert ours.epsilon == pytest.approx(row["eps"])
            assert ours.p_corrected == pytest.approx(row["p_GG_corr"])


@pytest.mark.no_cover
@pytest.mark.parametrize("shape", [(6, 3), (8, 3, 3), (9, 3, 2, 4), (4, 2, 3, 2, 2)])
def test_any_number_of_factors_is_statsmodels_and_the_projections(rng, shape):
    cube = random_cube(rng, *shape)
    table = long_form(cube)
    found = anova(*table)
    names = list(table[1])
    theirs = AnovaRM(frame(*table), "score", "who", names).fit().anova_table
    parts = projections(cube)
    assert len(found.effects) == 2 ** len(names) - 1 == len(theirs)
    for ours in found.effects:
        acting = ours.name.split(" × ")
        row = theirs.loc[":".join(acting)]
        assert ours.f == pytest.approx(row["F Value"])
        assert (ours.df1, ours.df2) == (row["Num DF"], row["Den DF"])
        assert ours.p == pytest.approx(row["Pr > F"])
        *_, covariance = parts[tuple(names.index(n) for n in acting)]
        # Box 1954, from the doubly centred covariance: no contrasts are chosen.
        box = np.trace(covariance) ** 2 / (ours.df1 * np.trace(covariance @ covariance))
        assert ours.epsilon == pytest.approx(box)
        assert ours.p_corrected == pytest.approx(
            f.sf(ours.f, ours.epsilon * ours.df1, ours.epsilon * ours.df2)
        )


def test_missing_and_repeated_cells(rng, pingouin):
    participants, factors, scores = long_form(random_cube(rng, 7, 3, 2))
    scores = scores.copy()
    scores[[1 * 6 + 4, 4 * 6, 4 * 6 + 1]] = np.nan  # S1 lacks one cell, S4 two
    again = [0, 0, 3, 6 * 6 + 5, 1 * 6]  # S0 has three of one and two of another, S6 two of one
    participants += [participants[i] for i in again] + ["S9"]
    factors = {n: column + [column[i] for i in again] + ["A1"] for n, column in factors.items()}
    factors["B"][-1] = "B0"
    scores = np.r_[scores, rng.normal(50, 5, len(again)), 50]
    found = anova(participants, factors, scores)
    assert found.participants == ("S0", "S2", "S3", "S5", "S6")
    assert found.dropped[:2] == (("S1", (("A2", "B0"),)), ("S4", (("A0", "B0"), ("A0", "B1"))))
    assert (found.dropped[2][0], len(found.dropped[2][1])) == ("S9", 5)
    assert found.averaged == (("S0", 2), ("S6", 1))
    data = frame(participants, factors, scores).dropna()
    means = data.groupby(["who", "A", "B"], as_index=False)["score"].mean()
    means = means[means["who"].isin(found.participants)]
    theirs = pingouin.rm_anova(means, dv="score", within=["A", "B"], subject="who")
    np.testing.assert_allclose([e.f for e in found.effects], theirs["F"])


def test_rows_may_come_in_any_order(rng):
    participants, factors, scores = long_form(random_cube(rng, 6, 3, 2))
    order = rng.permutation(len(scores))
    mixed = anova(
        [participants[i] for i in order],
        {name: [column[i] for i in order] for name, column in factors.items()},
        scores[order],
    )
    straight = anova(participants, factors, scores)
    for one, other in zip(straight.effects, mixed.effects, strict=True):
        assert one.f == pytest.approx(other.f)
        assert one.epsilon == pytest.approx(other.epsilon)


@pytest.mark.parametrize(
    "names",
    # AnovaRM would lose effects whose name has the participants' column's name in it.
    [
        ("participant", "subject"),
        ("s", "S"),
        ("score", "who"),
        ("a b", "a:b"),
        ("C(x, Sum)", "C"),
        ("Lücke", "⠇"),
    ],
)
def test_factors_may_have_any_name(rng, names):
    cube = random_cube(rng, 6, 3, 2)
    found = anova(*long_form(cube, names)).effects
    plain = anova(*long_form(cube)).effects
    assert [e.name for e in found] == [*names, " × ".join(names)]
    assert [e.f for e in found] == [e.f for e in plain]


def test_the_published_f_has_the_published_p(rng):
    # Six readers, three modes: the effect is scaled until F is the printed one.
    for printed, p in ((10.849, 0.003), (2.841, 0.105)):
        noise = rng.normal(0, 5, (6, 3))
        noise -= noise.mean(axis=0)
        shape = np.array([50, 56, 64.0])
        (raw,) = anova(*long_form(noise + shape)).effects
        scaled = noise + 50 + (shape - 50) * np.sqrt(printed / raw.f)
        (found,) = anova(*long_form(scaled)).effects
        assert found.f == pytest.approx(printed)
        assert (found.df1, found.df2, round(found.p, 3)) == (2, 10, p)


def test_fewer_participants_than_contrasts_have_an_epsilon(rng):
    effect = anova(*long_form(random_cube(rng, 4, 3, 4))).effects[2]
    assert effect.epsilon is not None
    assert 1 / 6 <= effect.epsilon <= 0.5  # of six eigenvalues three are 0


def test_two_by_two_is_one_contrast(rng):
    effect = anova(*long_form(random_cube(rng, 5, 2, 2))).effects[2]
    assert effect.epsilon == 1


def test_conditions_that_follow_from_each_other(rng):
    cube = random_cube(rng, 8, 3)
    cube[:, 2] = cube[:, :2].mean(axis=1) + 3
    (effect,) = anova(*long_form(cube)).effects
    assert effect.epsilon == pytest.approx(0.5)


def test_participants_who_all_respond_alike(rng):
    level, step = rng.normal(50, 9, (6, 1)), np.array([0.1, 0.7, 0.4])
    (effect,) = anova(*long_form(level + step)).effects
    assert effect.note == "all participants differ alike between its levels; F has no value"
    assert (effect.f, effect.p, effect.epsilon, effect.p_corrected) == (None,) * 4
    (same,) = anova(*long_form(np.full((4, 3), 0.1))).effects
    assert same.f is None
    # One factor alike, the other not.
    first, second, _ = anova(*long_form(rng.normal(size=(6, 3, 1)) + np.array([0.3, 1.7]))).effects
    assert first.f is not None
    assert second.f is None


def test_two_hundred_participants_and_an_alphabet_are_quick(rng):
    table = long_form(random_cube(rng, 200, 26))
    began = time.process_time()
    anova(*table)
    assert time.process_time() - began < 2


@pytest.mark.parametrize("levels", range(2, 9))
def test_contrasts_are_orthonormal_and_see_no_mean(levels):
    c = orthonormal_contrasts(levels)
    np.testing.assert_allclose(c.T @ c, np.eye(levels - 1), atol=1e-12)
    np.testing.assert_allclose(c.sum(axis=0), 0, atol=1e-12)
