"""Designs of labs: whatever is written, the plan obeys it, by a count of the tests' own."""

import re
from collections import Counter
from itertools import groupby, pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.sessions.planning.rulebook import check_rules
from tests.sessions.planning.test_bad_protocols import VBD_HEAD
from tests.tiers import examples
from vbraille.errors import InputError
from vbraille.sessions.planning.making import check_plan, make_plan
from vbraille.sessions.planning.plan import Plan
from vbraille.sessions.planning.protocolfiles import parse_protocol
from vbraille.sessions.planning.sequencing import balanced_orders

ITEMS = "string,kind\nac,word\nca,word\ncc,non\naa,non\n"
TEXTURE = (
    '[[factors]]\nname = "texture"\nlevels = [{ name = "flat", texture = 0.0 }, '
    '{ name = "rough", texture = 1.0 }]\n'
)
WIDTH = (
    '[[factors]]\nname = "width"\nlevels = [{ name = "w1", dot_width_mm = 1.0 }, '
    '{ name = "w2", dot_width_mm = 2.0 }, { name = "w3", dot_width_mm = 1.5 }]\n'
)
GROUPS = (
    '[[factors]]\nname = "gap"\nbetween = true\nlevels = [{ name = "near", cell_gap_mm = 3.0 }, '
    '{ name = "far", cell_gap_mm = 4.0 }]\n'
)
LIST = '[design]\nkind = "list"\nstrings = ["ac", "ca", "cc", "aa"]\n'


def parse(text, **files):
    named = {name.replace("_", "."): content for name, content in files.items()}
    return parse_protocol(VBD_HEAD + text, "mine.toml", beside=lambda name: _beside(named, name))


def _beside(named, name):
    """Text of a file beside the protocol, as a folder would give it."""
    if name not in named:
        raise InputError(f"there is no file {name}; check the name")
    return named[name]


def planned(text, participant="P01", seed=1, **files):
    return make_plan(parse(text, **files), participant, seed)


def longest_run(levels):
    return max(len(list(run)) for _, run in groupby(levels))


class TestFactors:
    def test_conditions_are_named_from_the_levels(self):
        protocol = parse(LIST + TEXTURE + WIDTH)
        assert [c.name for c in protocol.conditions][:4] == [
            "flat-w1",
            "flat-w2",
            "flat-w3",
            "rough-w1",
        ]
        assert protocol.levels("rough-w2") == {"texture": "rough", "width": "w2"}

    def test_levels_are_what_is_shown(self):
        for trial in planned(LIST + TEXTURE + WIDTH).trials:
            texture, width = trial.condition.split("-")
            (stimulus,) = trial.stimuli
            assert stimulus.tuning.texture == {"flat": 0.0, "rough": 1.0}[texture]
            assert stimulus.geometry.dot_width_mm == {"w1": 1.0, "w2": 2.0, "w3": 1.5}[width]

    def test_a_part_of_the_combinations(self):
        cross = 'cross = [["flat", "w2"], ["rough", "w1"]]\n'
        plan = planned(cross + LIST + TEXTURE + WIDTH)
        assert Counter(t.condition for t in plan.trials) == {"flat-w2": 4, "rough-w1": 4}

    def test_mappings_are_conditions(self):
        text = (
            '[design]\nkind = "list"\nstrings = ["ab"]\n[[factors]]\nname = "how"\nlevels = '
            '[{ name = "a", mapping = "alternate" }, { name = "p", mapping = "paired" }]\n'
        )
        head = VBD_HEAD.replace("vbd", "stress2")
        protocol = parse_protocol(head + text, "mine.toml")
        plan = Plan.from_json(make_plan(protocol, "P01", 1).to_json())
        check_plan(protocol, plan)
        shown = {t.condition: protocol.mapping_of(t.stimuli[0]).name for t in plan.trials}
        assert shown == {"a": "alternate", "p": "paired"}

    def test_groups_take_turns_and_each_has_all_orders(self):
        protocol = parse(LIST + TEXTURE + GROUPS)
        plans = [make_plan(protocol, f"P{n:02}", 1) for n in range(1, 9)]
        assert [plan.group for plan in plans] == ["near", "far"] * 4
        assert Counter((plan.group, plan.order) for plan in plans) == {
            (group, order): 2 for group in ("near", "far") for order in (1, 2)
        }
        for plan in plans:
            gaps = {t.stimuli[0].geometry.cell_gap_mm for t in plan.trials}
            assert gaps == {{"near": 3.0, "far": 4.0}[plan.group]}
            assert Plan.from_json(plan.to_json()) == plan

    def test_the_group_that_is_asked_for(self):
        assert make_plan(parse(LIST + GROUPS), "anna", 1, group="far").group == "far"
        with pytest.raises(InputError, match=r"^there is no group 'fra'; the nearest is far"):
            make_plan(parse(LIST + GROUPS), "anna", 1, group="fra")
        with pytest.raises(InputError, match=r"^the group goes by the participant's number"):
            make_plan(parse(LIST + GROUPS), "anna", 1)
        with pytest.raises(InputError, match=r"^mine has no groups; leave ‹group› out$"):
            make_plan(parse(LIST), "P01", 1, group="far")

    def test_a_plan_of_another_group_is_no_plan_of_this_one(self):
        protocol = parse(LIST + GROUPS)
        text = make_plan(protocol, "P01", 1).to_json().replace('"near"', '"far"')
        with pytest.raises(InputError, match="differs in its stimuli"):
            check_plan(protocol, Plan.from_json(text))


class TestOrders:
    @pytest.mark.parametrize("number", range(2, 9))
    def test_williams_squares_balance_what_goes_before(self, number):
        orders = balanced_orders(number)
        after = Counter(pair for order in orders for pair in pairwise(order))
        assert set(after.values()) == {len(orders) // number}
        assert len(after) == number * (number - 1)

    def test_a_table_of_orders(self):
        text = '[order]\nkind = "table"\nfile = "o.csv"\n' + LIST + TEXTURE + GROUPS
        table = "participant,group,1,2\nP01,far,rough,flat\nP02,near,flat,rough\n"
        plan = planned(text, o_csv=table)
        assert (plan.group, plan.order) == ("far", 1)
        assert list(dict.fromkeys(t.condition for t in plan.trials)) == ["rough", "flat"]
        assert planned(text, "P02", o_csv=table).trials[0].condition == "flat"
        with pytest.raises(InputError, match=r"has no participant 'P03'; the nearest is P0"):
            planned(text, "P03", o_csv=table)

    @examples(30)
    @given(
        st.integers(2, 6),
        st.sampled_from([TEXTURE, WIDTH, TEXTURE + WIDTH]),
        st.integers(1, 2),
        st.integers(1, 3),
        st.integers(2, 4),
        st.booleans(),
        st.booleans(),
        st.integers(0, 10**6),
    )
    def test_any_design_obeys_its_rules(
        self, number, factors, repeats, blocks, most, quarters, apart, seed
    ):
        strings = ["aa", "ac", "ca", "cc", "aac", "cca"][:number]
        name = re.findall('name = "(texture|width)"', factors)[0]
        text = (
            f'[design]\nkind = "list"\nstrings = {strings}\nrepeats = {repeats}\n'
            f"blocks = {blocks}\n{factors}[rules]\nnever_twice_running = {str(apart).lower()}\n"
            f"balanced_quarters = {str(quarters).lower()}\nat_most_running = {{ {name} = {most} }}"
        ).replace("'", '"')
        try:
            plan = planned(text, seed=seed)
        except InputError as refused:
            # Two strings of which none comes twice running have two orders, and so on.
            assert number < 4 or most < 3
            assert "no order of its trials was found" in str(refused)  # noqa: PT017
            return
        assert plan == planned(text, seed=seed)
        levels = [t.condition.split("-")[0] for t in plan.trials]
        assert longest_run(levels) <= most
        if apart:
            assert longest_run([t.presented for t in plan.trials]) == 1
        counts = Counter((t.condition, t.presented) for t in plan.trials)
        assert set(counts.values()) == {repeats}
        whole = Counter(t.condition for t in plan.trials)
        for part in range(4) if quarters else ():
            n = len(plan.trials)
            own = Counter(t.condition for t in plan.trials[part * n // 4 : (part + 1) * n // 4])
            for condition, times in whole.items():
                assert abs(own[condition] - times * sum(own.values()) / n) < 1

    def test_columns_of_items_may_be_limited(self):
        text = (
            '[design]\nkind = "items"\nrepeats = 5\n[items]\nfile = "i.csv"\n'
            "[rules]\nat_most_running = { kind = 1 }\n"
        )
        protocol = parse(text, i_csv=ITEMS)
        plan = make_plan(protocol, "P01", 1)
        kinds = [protocol.columns_of(t.stimuli[0].masks)["kind"] for t in plan.trials]
        assert longest_run(kinds) == 1

    def test_a_changed_order_is_found(self):
        text = LIST + "blocks = 1\nrepeats = 4\n" + TEXTURE + "[rules]\n"
        ruled = parse(text + "at_most_running = { texture = 1 }\n")
        free = make_plan(parse(text), "P01", 1)
        with pytest.raises(ValueError, match=r"texture is \w+ in \d trials running from trial"):
            check_rules(ruled, free)
        quarters = parse(text + "balanced_quarters = true\n")
        with pytest.raises(ValueError, match=r"quarter \d has \w+ \d times, and its share is 4"):
            check_rules(quarters, free)


class TestItems:
    def test_random_strings_keep_their_rule_and_are_the_same_for_all(self):
        rule = (
            '[design]\nkind = "items"\n[items]\nrule = "strings"\nlength = 4\ncount = 9\n'
            'characters = ["a", "c", "4"]\ndiffer_by = 2\nseed = 3\n'
        )
        strings = parse(rule).design.strings
        assert len(set(strings)) == 9
        assert strings == parse(rule).design.strings
        assert strings != parse(rule.replace("seed = 3", "seed = 4")).design.strings
        for one in strings:
            for other in strings:
                assert one == other or sum(a != b for a, b in zip(one, other, strict=True)) >= 2

    def test_words_of_a_length(self):
        rule = '[design]\nkind = "items"\n[items]\nrule = "words"\nfile = "w.txt"\nlength = 2\n'
        design = parse(rule, w_txt="# a comment\nac\ncaa\n\ncc\nac\n").design
        assert set(design.strings) == {(1, 9), (9, 9)}

    def test_practice_from_a_file(self):
        text = LIST + '[practice]\ntrials = 2\nfile = "p.csv"\n'
        plan = planned(text, p_csv="string\nca\nacc\n".replace("ca\n", "cca\n"))
        assert {t.presented for t in plan.practice} == {"⠉⠉⠁", "⠁⠉⠉"}


class TestCatch:
    @examples(20)
    @given(
        st.sampled_from(["every = 4", "every = 2", "share = 0.2", "share = 0.5"]),
        st.sampled_from(["blank", "repeat"]),
        st.integers(0, 10**6),
    )
    def test_they_stand_among_the_others(self, how, show, seed):
        text = LIST + f'repeats = 3\ncatch = {{ {how}, show = "{show}" }}\n' + TEXTURE
        protocol = parse(text)
        plan = make_plan(protocol, "P01", seed)
        assert len(plan.trials) == protocol.trials
        caught = [n for n, trial in enumerate(plan.trials) if trial.catch]
        wanted = {"every = 4": 8, "every = 2": 24, "share = 0.2": 6, "share = 0.5": 24}[how]
        assert len(caught) == wanted
        for place in caught:
            trial, before = plan.trials[place], plan.trials[place - 1]
            assert not before.catch
            assert trial.condition == before.condition
            assert trial.presented == ("⠀⠀" if show == "blank" else before.presented)
        plain = make_plan(parse(LIST + "repeats = 3\n" + TEXTURE), "P01", seed)
        others = [t.presented for t in plan.trials if not t.catch]
        assert others == [t.presented for t in plain.trials]
        assert Plan.from_json(plan.to_json()) == plan


class TestChoices:
    @pytest.mark.parametrize("name", ["texture", "contrast", "cell_gap_mm", "dot_spacing_mm"])
    def test_anything_is_compared(self, name):
        values = [0.5, 1.0] if name in ("texture", "contrast") else [3.0, 4.0]
        text = (
            f'[design]\nkind = "choice"\nparameter = "{name}"\nvalues = {values}\nstring = "cc"\n'
        )
        for trial in planned(text).trials:
            shown = [
                getattr(s.tuning, name, None) or getattr(s.geometry, name, None)
                for s in trial.stimuli
            ]
            assert shown == [s.value for s in trial.stimuli]
            assert sorted(shown) == values

    def test_each_with_the_reference(self):
        text = (
            '[design]\nkind = "choice"\nparameter = "contrast"\nvalues = [0.2, 0.4, 1.0]\n'
            'string = "a"\nreference = 0.6\n'
        )
        pairs = Counter(tuple(s.value for s in t.stimuli) for t in planned(text).trials)
        assert pairs == {p: 1 for v in (0.2, 0.4, 1.0) for p in ((v, 0.6), (0.6, v))}

    def test_procedures_vary_any_of_them(self):
        text = LIST + (
            '[procedure]\nkind = "quest"\nparameter = "dot_width_mm"\nleast = 0.5\nmost = 2.0\n'
            "step = 0.5\nspread = [0.2]\n"
        )
        from vbraille.sessions.planning.nexttrial import procedure_of

        protocol = parse(text)
        procedure = procedure_of(protocol, make_plan(protocol, "P01", 1))
        trial = procedure.next([])
        assert trial.stimuli[0].geometry.dot_width_mm in (0.5, 1.0, 1.5, 2.0)


FLAT_TWICE = TEXTURE.replace("1.0", "0.0")
ORDER = '[order]\nkind = "table"\nfile = "o.csv"\n' + LIST + TEXTURE
FROM_FILE = '[design]\nkind = "items"\n[items]\nfile = "i.csv"\n'
REFUSED = [
    (LIST + FLAT_TWICE, {}, "line 11: [[factors]] number 1 levels, number 2, shows what flat"),
    (LIST + TEXTURE.replace('{ name = "rough", texture = 1.0 }', ""), {}, "varies nothing"),
    (LIST + TEXTURE.replace("texture = 1", "txture = 1"), {}, "has no key 'txture'; the nearest"),
    (LIST + TEXTURE.replace("1.0", "1.5"), {}, "texture is 1.5; it must be 0 to 1"),
    (LIST + WIDTH.replace("2.0", "15.0"), {}, "dot width is 15 mm; it must be at most the cell"),
    (LIST + TEXTURE + TEXTURE.replace('"texture"', '"t"'), {}, "texture, which texture gives"),
    ('cross = [["flat"]]\n' + LIST + TEXTURE + WIDTH, {}, "line 6: cross, number 1, has 1 levels"),
    ('cross = [["flt", "w1"]]\n' + LIST + TEXTURE + WIDTH, {}, "has not; the nearest is flat"),
    (LIST + TEXTURE + '[[conditions]]\nname = "x"\n', {}, "stands beside [[factors]]"),
    (LIST + "repeats = 5000\n" + TEXTURE, {}, "line 6: [design] makes a session of more than"),
    (FROM_FILE, {"i_csv": "word\nac\n"}, "i.csv line 1: there is no column string"),
    (FROM_FILE, {"i_csv": "string,k\nac,\n\nca,\n"}, "i.csv line 3 is empty; leave it out"),
    (FROM_FILE, {"i_csv": "string,k\nac\n"}, "i.csv line 2 has 1 values, and the head has 2"),
    (FROM_FILE, {"i_csv": "string\nac\nà\n"}, "i.csv line 3: string: "),
    (FROM_FILE, {"i_csv": "string\nac\nac\n"}, "i.csv line 3: string is there before"),
    (FROM_FILE, {"i_csv": ""}, "i.csv is empty; begin it"),
    (FROM_FILE.replace("i.csv", "../i.csv"), {}, "file is '../i.csv'; it must be the name"),
    (FROM_FILE, {}, "file is 'i.csv', which cannot be read"),
    ('[design]\nkind = "items"\n', {}, "there is no table [items]; add it"),
    (ORDER, {"o_csv": "participant,1,2\nP01,flat,flat\n"}, "give each of flat, rough once"),
    (ORDER, {"o_csv": "participant,1,2\nP01,flat,ruff\n"}, "condition is 'ruff'; there is flat"),
    (
        LIST + "blocks = 1\n" + TEXTURE + "[rules]\nat_most_running = { txture = 2 }",
        {},
        "at_most_running has 'txture'; the nearest is texture",
    ),
    (
        LIST + TEXTURE + "[rules]\nbalanced_quarters = true",
        {},
        "balanced_quarters cannot be kept: each condition has a block of its own",
    ),
    (
        LIST + TEXTURE + "[rules]\nat_most_running = { texture = 3 }",
        {},
        "at_most_running texture = 3 cannot be kept: flat is in 4 of 4 trials of the block of flat",
    ),
    (LIST + "catch = { every = 3, share = 0.1 }", {}, "every and share say the same"),
    (LIST + "catch = { every = 30 }", {}, "catch would be 0 of 4 trials"),
]


@pytest.mark.parametrize(("text", "files", "says"), REFUSED, ids=range(len(REFUSED)))
def test_what_cannot_be_is_refused_in_a_sentence(text, files, says):
    with pytest.raises(InputError) as refused:
        planned(text, **files)
    sentence = str(refused.value)
    assert says in sentence
    assert "\n" not in sentence


def test_what_no_search_finds_is_refused_before_anything_is_written():
    text = '[design]\nkind = "list"\nstrings = ["a", "c"]\nblocks = 1\nrepeats = 2\n' + TEXTURE
    rules = "[rules]\nnever_twice_running = true\nat_most_running = { texture = 1 }\n"
    protocol = parse(text + rules + "balanced_quarters = true\n")
    try:
        plan = make_plan(protocol, "P01", 1)
    except InputError as error:
        assert "no order of its trials was found" in str(error)  # noqa: PT017
    else:
        check_rules(protocol, plan)
