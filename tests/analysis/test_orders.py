"""Period and carry-over of blocks of one condition each: statsmodels' F, and what is told of it."""

from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest
import statsmodels.formula.api as smf
from statsmodels.stats.anova import anova_lm

from vbraille.analysis.input.study import Study
from vbraille.analysis.input.trials import factor
from vbraille.analysis.orders import order_of
from vbraille.sessions.planning.protocolfiles import parse_protocol
from vbraille.sessions.planning.sequencing import balanced_orders

TEXT = """
format = 1
name = "crossed"
title = "Crossed"
source = "ours"
model = "vbd"

[design]
kind = "combinations"
characters = ["a", "c"]
length = 1
blocks = "conditions"
"""
PER_BLOCK = 40


def protocol(conditions):
    rows = "".join(
        f'[[conditions]]\nname = "C{n}"\ntexture = {n / conditions}\n' for n in range(conditions)
    )
    return parse_protocol(f"{TEXT}\n{rows}", "crossed.toml")


def study(conditions, people, *, period=0.0, carried=0.0, sessions=1):
    """Study of participants in balanced orders, whose right answers depend on the order."""
    planned = protocol(conditions)
    random = np.random.default_rng(conditions + people)
    orders = balanced_orders(conditions)
    rows = []
    for who in range(people):
        base, before = 0.5 + 0.05 * random.normal(), None
        for block, condition in enumerate(orders[who % len(orders)]):
            share = base + period * block + carried * (before == 0)
            right = random.random(PER_BLOCK) < np.clip(share, 0.05, 0.95)
            rows += [
                (f"P{who}", f"S{who}-{n % sessions}", f"C{condition}", block + 1, n + 1, each)
                for n, each in enumerate(right)
            ]
            before = condition
    names = ["participant", "session", "condition", "block", "trial", "correct"]
    trials = pd.DataFrame(rows, columns=names).assign(protocol="crossed")
    for name in ("participant", "session", "condition", "protocol"):
        trials[name] = factor(trials[name])
    sat = SimpleNamespace(protocol=planned)
    return Study(trials, None, (sat,), (), (), (), ()), planned.planned_analysis


def tables(*given, **more):
    made, planned = study(*given, **more)
    chapter = order_of(made, None, planned)
    return {table.name: table for table in chapter.tables}


def row_of(table, effect):
    return table.frame.set_index("effect").loc[effect]


@pytest.mark.parametrize("conditions", [3, 4])
def test_each_effect_has_statsmodels_f(conditions):
    made, planned = study(conditions, 12, period=0.05)
    chapter = order_of(made, None, planned)
    told = chapter.tables[1]
    own = made.trials.groupby(["participant", "block", "condition"], observed=True)["correct"]
    frame = own.mean().reset_index().sort_values(["participant", "block"])
    before = frame["condition"].astype(str).groupby(frame["participant"], observed=True).shift()
    frame = frame.assign(
        y=2 * np.arcsin(np.sqrt(frame["correct"])),
        **{f"after{n}": (before == f"C{n}").astype(float) for n in range(conditions)},
    )
    # What follows nothing is the first period, so that one column of carry-over is another's sum.
    carried = " + ".join(f"after{n}" for n in range(1, conditions))
    parts = {"period": "C(block)", "carry-over": carried, "condition": "C(condition)"}
    whole = smf.ols(f"y ~ C(participant) + {' + '.join(parts.values())}", frame).fit()
    for effect in parts:
        rest = " + ".join(part for name, part in parts.items() if name != effect)
        if effect == "period":  # without periods, carry-over has a column more
            rest += " + after0"
        fitted = anova_lm(smf.ols(f"y ~ C(participant) + {rest}", frame).fit(), whole).iloc[1]
        row = row_of(told, effect)
        assert row["f"] == pytest.approx(fitted["F"], rel=1e-9)
        assert (row["df1"], row["df2"]) == (fitted["df_diff"], whole.df_resid)
        assert row["p"] == pytest.approx(fitted["Pr(>F)"], rel=1e-9)


def test_what_the_order_does_is_found():
    assert row_of(tables(3, 12, period=0.15)["order"], "period")["p"] < 0.001
    assert row_of(tables(3, 24, carried=0.3)["order"], "carry-over")["p"] < 0.001
    means = tables(3, 12, period=0.15)["periods"].frame["value"].tolist()
    assert means == sorted(means)


def test_two_conditions_tell_periods_and_no_carry_over():
    told = tables(2, 8, period=0.2)["order"]
    assert np.isnan(row_of(told, "carry-over")["f"])
    assert "do not tell it" in row_of(told, "carry-over")["note"]
    assert row_of(told, "period")["p"] < 0.01
    assert row_of(told, "condition")["df1"] == 1


def test_the_planned_counterbalancing_is_said():
    (note,) = tables(3, 4)["order"].notes
    assert note.startswith("Planned: 6 orders, in which together each condition is equally often")
    assert note.endswith("Here are 4 orders of 4 participants.")


def test_two_people_have_no_test():
    assert row_of(tables(3, 2)["order"], "period")["note"].endswith("three participants or more")


def test_what_is_no_order_of_blocks_has_no_table():
    made, planned = study(3, 6, sessions=2)
    assert order_of(made, None, planned) is None
    made, planned = study(3, 6)
    mixed = made.trials.assign(block=1)
    assert order_of(Study(mixed, None, made.sessions, (), (), (), ()), None, planned) is None
