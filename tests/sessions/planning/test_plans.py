"""Plans: what they have in which order, for every seed and participant."""

from collections import Counter
from itertools import pairwise

import pytest

from tests.sessions.planning.test_protocols import load
from tests.sessions.sittings import HEAD, MINI, WIDTHS
from tests.tiers import by_tier
from vbraille.errors import InputError
from vbraille.sessions.planning.loading import load_protocol
from vbraille.sessions.planning.order import balanced_orders
from vbraille.sessions.planning.plan import make_plan, to_brf

TWO = (
    MINI
    + """repeats = 4
{more}
[[conditions]]
name = "flat"
texture = 0.0
[[conditions]]
name = "rough"
texture = 1.0
[rules]
never_twice_running = true
"""
)


def in_blocks(plan):
    return [trial for trial in plan.trials if not trial.practice]


@pytest.mark.parametrize("name", ["letters", "legibility", "factors", "shapes", "tuning-width"])
def test_orders_keep_their_rules(name):
    protocol = load_protocol(name)
    limits = {name: most + 1 for name, most in protocol.rules.at_most_running.items()}
    for seed in range(by_tier(40, 1000, 1000)):
        plan = make_plan(protocol, f"P{seed % 3 + 1}", seed)
        trials = [trial for trial in in_blocks(plan) if not trial.catch]
        shown = Counter((trial.item, trial.condition) for trial in trials)
        assert set(shown.values()) == {protocol.design.repeats}
        reorder = getattr(protocol.design, "reorder", False)
        items = [sorted(trial.item) if reorder else trial.item for trial in trials]
        assert all(one != other for one, other in pairwise(items))
        for factor, most in limits.items():
            levels = [protocol.levels(t.condition, plan.group)[factor] for t in trials]
            runs = zip(*(levels[n:] for n in range(most)), strict=False)
            assert not any(len(set(run)) == 1 for run in runs)


def test_each_quarter_has_an_even_share(tmp_path):
    rules = "balanced_quarters = true\nat_most_running = { condition = 2 }\n"
    protocol = load(tmp_path, TWO.format(more="blocks = 1") + rules)
    for seed in range(30):
        trials = in_blocks(make_plan(protocol, "P01", seed))
        for quarter in range(4):
            part = trials[quarter * 6 : quarter * 6 + 6]
            assert Counter(trial.condition for trial in part) == {"flat": 3, "rough": 3}


def test_a_rule_that_no_order_keeps_is_refused(tmp_path):
    text = MINI.replace('["ac", "ca", "aa"]', '["ac"]') + "repeats = 3\n"
    with pytest.raises(InputError, match="no order"):
        make_plan(load(tmp_path, text + "[rules]\nnever_twice_running = true\n"), "P01", 1)


@pytest.mark.parametrize("count", [2, 3, 4, 5])
def test_each_condition_follows_each_other_one_equally_often(count):
    followed = Counter(pair for order in balanced_orders(count) for pair in pairwise(order))
    assert len(followed) == count * (count - 1)
    assert len(set(followed.values())) == 1


def test_blocks_are_balanced_over_participants_and_differ_in_a_second_session(tmp_path):
    protocol = load(tmp_path, TWO.format(more='order = "balanced"'))

    def first(who, **how):
        return in_blocks(make_plan(protocol, who, 1, **how))[0].condition

    assert [first(who) for who in ("P01", "P02", "P03")] == ["flat", "rough", "flat"]
    assert first("P01", session=2) == first("P01", order=2) == "rough"
    with pytest.raises(InputError, match="order"):
        first("Anna")
    with pytest.raises(InputError, match="pseudonym"):
        first("../P 1")


def test_groups_and_a_table_of_orders(tmp_path):
    text = TWO.format(more='orders = "orders.csv"')
    orders = "participant;first;second\nP01;rough;flat\nP02;flat;rough\n"
    protocol = load(tmp_path, text, orders_csv=orders)
    assert in_blocks(make_plan(protocol, "P01", 1))[0].condition == "rough"
    with pytest.raises(InputError, match="P03"):
        make_plan(protocol, "P03", 1)
    with pytest.raises(InputError, match=r"orders\.csv line 2"):
        load(tmp_path, text, orders_csv="participant,first,second\nP01,rough,rough\n")
    factors = load_protocol("factors")
    groups = [make_plan(factors, f"P0{n}", 1).group for n in range(1, 5)]
    assert groups == ["alternate", "paired"] * 2
    assert make_plan(factors, "P01", 1, group="paired").group == "paired"
    with pytest.raises(InputError, match="nobody"):
        make_plan(factors, "P01", 1, group="nobody")


def test_counterbalanced_items_go_round_the_conditions(tmp_path):
    text = TWO.format(more="counterbalanced = true\nblocks = 1").replace('"aa"]', '"aa", "cc"]')
    protocol = load(tmp_path, text)
    seen = Counter()
    for who in ("P01", "P02"):
        shown = {(t.item, t.condition) for t in in_blocks(make_plan(protocol, who, 1))}
        assert len({item for item, _ in shown}) == len(shown) == 4
        seen.update(shown)
    assert set(seen.values()) == {1}
    assert len(seen) == 8


def test_catch_trials_show_nothing_or_the_trial_before(tmp_path):
    for show in ("blank", "repeat"):
        catch = f'catch = {{ every = 4, show = "{show}" }}\nblocks = 1'
        trials = in_blocks(make_plan(load(tmp_path, TWO.format(more=catch)), "P01", 1))
        caught = [n for n, trial in enumerate(trials) if trial.catch]
        assert len(caught) == 8
        assert all(n > 0 for n in caught)
        for n in caught:
            alike = trials[n].stimuli == trials[n - 1].stimuli
            assert alike if show == "repeat" else trials[n].stimuli[0].is_blank


def test_practice_has_chance_of_its_own_and_may_grow(tmp_path):
    practice = '[practice]\ntrials = {}\nstrings = ["c", "cc", "cac"]\norder = "listed"\n'
    few, many = (
        make_plan(load(tmp_path, TWO.format(more="") + practice.format(n)), "P01", 1)
        for n in (3, 6)
    )
    assert in_blocks(few) == in_blocks(many)
    assert [len(t.item) for t in many.trials if t.practice] == [1, 2, 3, 1, 2, 3]
    criterion = practice.format(0).replace("trials = 0", "until = { right = 2, of = 3, most = 9 }")
    plan = make_plan(load(tmp_path, MINI + criterion), "P01", 1)
    assert sum(trial.practice for trial in plan.trials) == 9


FORMS = {
    "pairs": {(1.5, 1.0), (1.0, 1.5), (1.5, 2.0), (2.0, 1.5)},
    "standard": {(1.5, 1.0), (1.5, 2.0)},
    "one": {(1.0, 1.5), (1.5, 1.0), (2.0, 1.5), (1.5, 2.0)},
}


@pytest.mark.parametrize("form", FORMS)
def test_the_forms_of_a_comparison(form, tmp_path):
    more = f'reference = 1.5\nform = "{form}"\n[question]\nkind = "which"\nright = "more"\n'
    plan = make_plan(load(tmp_path, WIDTHS + more), "P01", 1)
    assert {tuple(trial.values) for trial in plan.trials} == FORMS[form]
    assert len(plan.trials) == len(FORMS[form])


def test_abx_and_the_odd_one_have_three_stimuli(tmp_path):
    for form, kind in (("abx", "match"), ("triangle", "odd")):
        more = f'reference = 1.5\nform = "{form}"\n[question]\nkind = "{kind}"\n'
        protocol = load(tmp_path, WIDTHS + more)
        trials = make_plan(protocol, "P01", 1).trials
        right = Counter(protocol.asks.right_answer(trial) for trial in trials)
        assert len(set(right.values())) == 1
        assert len(right) == (2 if form == "abx" else 3)


def test_a_gap_between_dots_is_from_edge_to_edge(tmp_path):
    text = WIDTHS.replace("dot_width_mm", "dot_gap_mm").replace('"a"', '"c"')
    protocol = load(tmp_path, text + "[display]\ndot_width_mm = 2.0\n")
    for trial in make_plan(protocol, "P01", 1).trials:
        for stimulus in trial.stimuli:
            spacing_mm = protocol.style(stimulus.look).geometry.dot_spacing_mm
            assert spacing_mm == pytest.approx(2.0 + stimulus.value)


def test_conditions_may_have_braille_tables_of_their_own(tmp_path):
    text = (
        HEAD.replace("vbd", "stress2")
        + """[[factors]]
name = "grade"
levels = [{ name = "g1", table = "en-ueb-g1.ctb" }, { name = "g2", table = "en-ueb-g2.ctb" }]
[design]
kind = "list"
strings = ["the child"]
"""
    )
    plan = make_plan(load(tmp_path, text), "P01", 1)
    lengths = {trial.condition: len(trial.cells) for trial in plan.trials}
    assert lengths["g2"] < lengths["g1"] == 9


def test_the_strings_of_a_plan_can_be_embossed(tmp_path):
    protocol = load(tmp_path, MINI)
    plan = make_plan(protocol, "P01", 1)
    lines = to_brf(protocol, plan).splitlines()
    ascii_of = {"⠁": "A", "⠉": "C"}
    assert lines == ["".join(map(ascii_of.get, trial.item)) for trial in in_blocks(plan)]
    assert sorted(lines) == ["AA", "AC", "CA"]


@pytest.mark.parametrize("name", ["shapes", "tuning-width"])
def test_what_is_no_string_cannot_be_embossed(name):
    protocol = load_protocol(name)
    with pytest.raises(InputError, match=r"pictures|compares"):
        to_brf(protocol, make_plan(protocol, "P01", 1))
