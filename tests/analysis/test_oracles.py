"""The same data in pingouin and statsmodels."""

import numpy as np
import pandas as pd
import pytest
from statsmodels.stats.anova import AnovaRM
from statsmodels.stats.multitest import multipletests

from tests.analysis.making import row_of, scored
from vbraille.analysis import stats

pingouin = pytest.importorskip("pingouin")
# pingouin 0.7 asks pandas 3.1 in a way it is going to drop.
pytestmark = pytest.mark.filterwarnings("ignore:The inplace keyword:DeprecationWarning")


def close(value):
    return pytest.approx(value, rel=1e-9)


def long_form(cube, names):
    """Rows of scores of a cube float64[people, levels, ...]."""
    rows = []
    for place, score in np.ndenumerate(cube):
        levels = {name: f"{name}{n}" for name, n in zip(names, place[1:], strict=True)}
        rows.append({"participant": f"S{place[0]:02}"} | levels | {"score": float(score)})
    return rows


def cube_of(rng, *shape):
    """Scores with effects, and with unequal variances."""
    people = rng.normal(50, 8, (shape[0], *[1] * (len(shape) - 1)))
    return people + rng.normal(rng.normal(0, 3, shape[1:]), rng.uniform(1, 6, shape[1:]), shape)


@pytest.mark.parametrize("shape", [(6, 3), (12, 4), (3, 7)])
def test_one_factor(shape, rng, tmp_path):
    rows = long_form(cube_of(rng, *shape), "A")
    result = scored(rows, tmp_path).result
    (ours,) = result.effects.to_dict("records")
    named = {"data": pd.DataFrame(rows), "dv": "score", "within": "A", "subject": "participant"}
    theirs = pingouin.rm_anova(**named, correction=True, effsize="np2").iloc[0]
    assert (ours["F"], ours["epsilon"]) == (close(theirs["F"]), close(theirs["eps"]))
    assert ours["p_uncorrected"] == close(theirs["p_unc"])
    assert ours["p"] == close(theirs["p_GG_corr"])
    assert ours["partial_eta2"] == close(theirs["np2"])
    pairs = pingouin.pairwise_tests(**named, padjust="holm", effsize="hedges")
    for theirs in pairs.to_dict("records"):
        ours = row_of(result.pairs, first=theirs["A"], second=theirs["B"])
        assert (ours["t"], ours["p"]) == (close(theirs["T"]), close(theirs["p_unc"]))
        assert ours["p_holm"] == close(theirs["p_corr"])


@pytest.mark.parametrize("shape", [(6, 3, 2), (10, 3, 3)])
def test_two_factors(shape, rng, tmp_path):
    rows = long_form(cube_of(rng, *shape), "AB")
    effects = scored(rows, tmp_path).result.effects
    named = {"data": pd.DataFrame(rows), "dv": "score", "subject": "participant"}
    theirs = pingouin.rm_anova(**named, within=["A", "B"])
    for ours, row in zip(effects.to_dict("records"), theirs.to_dict("records"), strict=True):
        assert (ours["F"], ours["p_uncorrected"]) == (close(row["F"]), close(row["p_unc"]))
        assert (ours["epsilon"], ours["p"]) == (close(row["eps"]), close(row["p_GG_corr"]))
    corrected = multipletests(effects["p"], method="holm")[1]
    assert effects["p_holm"].to_list() == close(corrected.tolist())


def test_three_factors(rng, tmp_path):
    rows = long_form(cube_of(rng, 9, 3, 2, 6), "ABD")
    effects = scored(rows, tmp_path).result.effects.set_index("effect")
    theirs = AnovaRM(pd.DataFrame(rows), "score", "participant", ["A", "B", "D"]).fit().anova_table
    assert len(effects) == len(theirs) == 7
    for name, row in theirs.iterrows():
        ours = effects.loc[name.replace(":", " × ")]
        assert (ours["F"], ours["p_uncorrected"]) == (close(row["F Value"]), close(row["Pr > F"]))


def test_groups(rng, tmp_path):
    rows = [
        {
            "participant": f"S{n}",
            "group": "xyz"[n % 3],
            "score": float(rng.normal(n % 3, 1 + n % 3)),
        }
        for n in range(17)
    ]
    data = pd.DataFrame(rows)
    result = scored(rows, tmp_path).result
    (ours,) = result.effects.to_dict("records")
    theirs = pingouin.welch_anova(data, dv="score", between="group").iloc[0]
    assert (ours["F"], ours["df2"]) == (close(theirs["F"]), close(theirs["ddof2"]))
    assert ours["p"] == close(theirs["p_unc"])
    parts = dict(list(data.groupby("group")["score"]))
    for ours in result.pairs.to_dict("records"):
        pair = parts[ours["first"]], parts[ours["second"]]
        theirs = pingouin.ttest(*pair, correction=True).iloc[0]
        assert (ours["t"], ours["df"]) == (close(theirs["T"]), close(theirs["dof"]))
        assert ours["hedges_g"] == close(pingouin.compute_effsize(*pair, eftype="hedges"))


@pytest.mark.parametrize("levels", [2, 3])
def test_within_by_between(levels, rng, tmp_path):
    cube = cube_of(rng, 10, levels)
    rows = long_form(cube, "A")
    rows = [row | {"group": "xy"[int(row["participant"][1:]) % 2]} for row in rows]
    rows = [{name: row[name] for name in ("participant", "group", "A", "score")} for row in rows]
    effects = scored(rows, tmp_path).result.effects.set_index("effect")
    named = {"data": pd.DataFrame(rows), "dv": "score", "subject": "participant"}
    theirs = pingouin.mixed_anova(**named, within="A", between="group").set_index("Source")
    assert effects.loc["A", "F"] == close(theirs.loc["A", "F"])
    interaction = effects.loc["group × A"]
    if levels > 2:
        assert interaction["F"] == close(theirs.loc["Interaction", "F"])
        assert interaction["p_uncorrected"] == close(theirs.loc["Interaction", "p_unc"])
        return
    gaps = cube[:, 0] - cube[:, 1]
    test = pingouin.ttest(gaps[::2], gaps[1::2], correction=True).iloc[0]
    assert interaction["F"] == close(test["T"] ** 2)
    assert (interaction["df2"], interaction["p"]) == (close(test["dof"]), close(test["p_val"]))


def test_d_prime():
    for hits, falses in ((0.9, 0.2), (0.55, 0.5), (0.99, 0.01)):
        ours = float(stats.d_prime(hits, falses))
        assert ours == close(float(np.diff(stats.special.ndtri([falses, hits]))[0]))
    # Macmillan and Creelman (2005), table A5.4: H = .8, F = .2 is d′ 2.92 or so.
    assert float(stats.d_prime_differencing(0.2, 0.2)) == 0
    d = stats.d_prime_differencing(np.array([0.5, 0.9]), np.array([0.2, 0.1]))
    k = -np.sqrt(2) * stats.special.ndtri(np.array([0.1, 0.05]))
    cdf = stats.special.ndtr
    hits = cdf((d - k) / np.sqrt(2)) + cdf((-d - k) / np.sqrt(2))
    assert hits == pytest.approx([0.5, 0.9], abs=1e-9)
