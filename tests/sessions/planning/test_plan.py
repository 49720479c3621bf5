"""A plan is the same on every machine, and keeps the rules of its design."""

import json
import re
from collections import Counter
from hashlib import sha256
from itertools import groupby, pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st
from msgspec import structs

from tests.sessions.planning.rulebook import broken_rules, check_rules
from vbraille.braille.spelling import LETTERS
from vbraille.errors import InputError
from vbraille.sessions.planning.making import make_plan
from vbraille.sessions.planning.plan import Plan
from vbraille.sessions.planning.protocolfiles import builtin_names, load_protocol, parse_protocol
from vbraille.sessions.planning.sequencing import Rules

HEAD = 'format = 1\nname = "mine"\ntitle = "Mine"\nsource = "Here"\nmodel = "stress2"\n'
ABC = "".join(f'[[conditions]]\nname = "{name}"\n' for name in "ABC")
PAIRS = '[design]\nkind = "combinations"\ncharacters = ["a", "c"]\nlength = 2\n'
LEGIBILITY, LETTERS_PROTOCOL = load_protocol("legibility"), load_protocol("letters")


def parse(text):
    return parse_protocol(HEAD + text, "mine.toml")


def conditions_of(trials):
    return [name for name, _ in groupby(trial.condition for trial in trials)]


class TestOrders:
    def test_participants_go_through_the_orders(self):
        protocol = parse(PAIRS + ABC)
        plans = [make_plan(protocol, f"P{n:02}", 1) for n in range(1, 8)]
        assert [plan.order for plan in plans] == [1, 2, 3, 4, 5, 6, 1]
        orders = [tuple(conditions_of(plan.trials)) for plan in plans]
        assert len(set(orders[:6])) == 6
        assert orders[6] == orders[0]
        for place in range(3):
            assert Counter(order[place] for order in orders[:6]) == {"A": 2, "B": 2, "C": 2}

    def test_two_conditions_alternate(self):
        first = [make_plan(LEGIBILITY, p, 1).trials[0].condition for p in ("P1", "P2", "x2-3")]
        assert first == ["nominal", "textured", "nominal"]

    def test_an_order_that_is_given(self):
        assert make_plan(LEGIBILITY, "anna", 1, 2).trials[0].condition == "textured"
        assert make_plan(LEGIBILITY, "P07", 1, 4).order == 2

    def test_a_participant_without_a_number(self):
        says = r"^the order .* and anna has none; give ‹order› N, or a participant such as P07$"
        with pytest.raises(InputError, match=says):
            make_plan(LEGIBILITY, "anna", 1)
        assert make_plan(LETTERS_PROTOCOL, "anna", 1).order == 0

    def test_orders_that_cannot_be(self):
        with pytest.raises(InputError, match=r"^order is 0; it must be 1 or more$"):
            make_plan(LEGIBILITY, "P07", 1, 0)
        with pytest.raises(InputError, match=r"^letters has no balanced orders; leave ‹order›"):
            make_plan(LETTERS_PROTOCOL, "P07", 1, 1)

    def test_listed_and_shuffled_blocks(self):
        listed = parse(f'{PAIRS}order = "listed"\n{ABC}')
        shuffled = parse(f'{PAIRS}order = "shuffled"\n{ABC}')
        orders = {"".join(conditions_of(make_plan(shuffled, "x", n).trials)) for n in range(40)}
        assert orders == {"ABC", "ACB", "BAC", "BCA", "CAB", "CBA"}
        assert {"".join(conditions_of(make_plan(listed, "x", n).trials)) for n in range(9)} == {
            "ABC"
        }


class TestPlans:
    def test_they_are_the_same_on_every_machine(self):
        """If these change, make the version of plans another: these cannot be planned again."""
        sums = {
            name: sha256(make_plan(load_protocol(name), "P07", 42).to_json().encode()).hexdigest()
            for name in builtin_names()
        }
        assert sums == {
            "icons": "1536d8708fc1862d7522b151a4769c5dd01221ec3363c71915ed9424f4277d43",
            "orientation-coarse": "475f991de0e925c87bf42a0c4db3c182"
            "eb47117a00cc3d5d697be7d14bb17ae0",
            "orientation-fine": "4f4eabf2cc1183ab40c0e3c23e6c4474022f0963751fba908f3e0c4a74f9ab9e",
            "shapes": "2b1ef4cdf2b9c9d3b863482282a032d89d247f697d9f57c17ca3c3df18556928",
            "spatial-frequency": "d089fe2d9ae98de927e4e0d08e99ad392c61e7ec7d78163d4967a25182e1becd",
            "detection": "ac57006bbb13fa19a26c9ba8b0eaacd64c50662c7067552421ba5321defc42a4",
            "rating": "d0665fcca862bd4c09e7fcc3db28ce9a736ed934de2e32ff26a8fe1018e365d9",
            "same-different": "8efb4231c15aea56a3cb5f78ecd7cbba69e16b6c3b50d0d14ae761aeb6df9b58",
            "control": "3a90a266ad2771b5de36d2f6ca510a380dcada194c3fa9a57b8aacf85de83ac4",
            "control-display": "078005997e544a65ed48e518acbe8e7b53df6e418c6c5b0cbb905cdbf7dd6859",
            "tuning-spacing-reference": "e2b35a63a4ab63aa5e382497008b52a7"
            "98c80cd4e9ea3590107509c6bff54823",
            "tuning-width-reference": "6dc0a1aff6774baacee27e772ed15847"
            "6c0f1de1d7b01eaef057e0fe3f748cf9",
            "factors": "65e622ea510c31ac0e836f94d9ed48d7696b62b301b43813b70095b18de40258",
            "legibility": "818a1e26278d19fd94195c493f87996d0f2369407d8d9b32c05b0f156213846a",
            "letters": "2bc469fe082ca8e589eb1287d6b2694ca78c78dfcbed9d4df921a889c70da1e9",
            "tuning-spacing": "0e6355cb9f8a81dc60fdc9dedd49c10707075cf907b782cd9e2730bc09b6a303",
            "tuning-spacing-adaptive": "60b62ad1cbf99bcf91a2e432ed0cf1e7"
            "c229f2dd4aac70dd6911b1c24164b767",
            "tuning-width": "341474636ec9ff4a6bc9742ba075b4c83dfef18e056b4e4a44f18a908b9718ea",
            "tuning-width-adaptive": "fa65d6413547aae0c4236be0459452f4"
            "e5cb27daf09e92130175e74a4a8a354c",
            "words": "73bd4b764d538bddaeb08b762bd42ef5176127f74709f203cc4738e587442bcf",
        }

    def test_protocols_of_one_design_have_orders_of_their_own(self):
        """Else what was read on paper comes on the device in the order that was learnt."""
        strings = [
            [trial.presented for trial in make_plan(load_protocol(name), "P07", 42).trials[:80]]
            for name in ("control", "legibility")
        ]
        assert sorted(strings[0]) == sorted(strings[1])
        assert strings[0] != strings[1]
        ranks = []
        for name in ("tuning-width", "tuning-spacing"):
            protocol = load_protocol(name)
            trials = make_plan(protocol, "P07", 42).trials
            ranks.append(
                [[protocol.design.values.index(s.value) for s in t.stimuli] for t in trials]
            )
        assert sorted(ranks[0]) == sorted(ranks[1])
        assert ranks[0] != ranks[1]

    @pytest.mark.parametrize("name", builtin_names())
    def test_rules_of_all_protocols_for_a_few_seeds(self, name):
        protocol = load_protocol(name)
        assert protocol.rules.never_twice_running or protocol.adaptive
        for seed in range(20):
            assert broken_rules(protocol, f"P{seed:02}", seed) == []

    def test_without_the_rule_the_same_string_comes_twice_running(self):
        free = structs.replace(LEGIBILITY, rules=Rules())
        found = [broken_rules(free, "P07", seed) for seed in range(5)]
        assert all(problems == ["twice running"] for problems in found)

    def test_what_cannot_be_kept_apart_is_refused(self):
        protocol = parse(
            '[design]\nkind = "list"\nstrings = ["ab", "ab", "ab", "c"]\n'
            "[rules]\nnever_twice_running = true"
        )
        says = r"^mine cannot keep never_twice_running: one thing is shown too often in a block"
        with pytest.raises(InputError, match=says):
            make_plan(protocol, "P07", 1)

    def test_two_strings_take_turns(self):
        protocol = parse(
            '[design]\nkind = "list"\nstrings = ["ab", "c"]\nrepeats = 40\n'
            "[rules]\nnever_twice_running = true"
        )
        shown = [trial.presented for trial in make_plan(protocol, "P07", 1).trials]
        assert {"".join(shown[:2]), "".join(shown[78:])} in ({"⠁⠃⠉"}, {"⠉⠁⠃"})
        assert all(one != other for one, other in pairwise(shown))

    def test_values_are_practised_that_are_not_compared(self):
        text = (
            '[design]\nkind = "choice"\nparameter = "dot_width_mm"\nvalues = [1, 2]\n'
            'string = "a"\n[practice]\ntrials = 4\nvalues = [1.25, 1.5]\n'
        )
        plan = make_plan(parse(text), "P07", 1)
        assert len(plan.practice) == 4
        assert {s.value for trial in plan.practice for s in trial.stimuli} == {1.25, 1.5}
        with pytest.raises(InputError, match=r"\[practice\] values have 2 mm, which the test"):
            parse(text.replace("1.25", "2"))

    def test_seed_and_participant_make_the_order(self):
        plans = {make_plan(LEGIBILITY, p, s).trials for p in ("P01", "P03") for s in (0, 1)}
        assert len(plans) == 4
        assert make_plan(LEGIBILITY, "P01", 2**63 - 1).seed == 2**63 - 1

    @pytest.mark.parametrize("name", builtin_names())
    def test_json_and_back(self, name):
        protocol = load_protocol(name)
        plan = make_plan(protocol, "P07", 42)
        text = plan.to_json()
        assert Plan.from_json(text) == plan
        assert Plan.from_json(text).to_json() == text
        check_rules(protocol, Plan.from_json(text))
        assert text.count('{"number"') == len(re.findall(r"(?m)^\{\"number\".*\},?$", text))
        assert len(json.loads(text)["trials"]) == protocol.trials

    def test_legibility(self):
        plan = make_plan(LEGIBILITY, "P07", 42)
        assert [trial.number for trial in plan.trials] == list(range(1, 161))
        assert [trial.block for trial in plan.trials] == [1] * 80 + [2] * 80
        for block in (1, 2):
            shown = Counter(trial.presented for trial in plan.trials if trial.block == block)
            assert len(shown) == 16
            assert set(shown.values()) == {5}
            assert set("".join(shown)) == set("⠁⠉⠈⠀")
        assert {trial.presented for trial in plan.practice} == set("⠁⠉⠈⠀")
        for trial in (*plan.practice, *plan.trials):
            (stimulus,) = trial.stimuli
            asked = 1 if trial.practice else 2
            assert (len(stimulus.masks), trial.asked) == (asked + 2, (1, asked + 1))
            assert stimulus.masks[0] == stimulus.masks[-1] == LETTERS["c"]
            assert stimulus.tuning.texture == (trial.condition == "textured")
            assert (stimulus.geometry, stimulus.value) == (LEGIBILITY.geometry, None)

    @pytest.mark.parametrize(
        ("name", "length"), [("tuning-width", "dot_width_mm"), ("tuning-spacing", "gap_mm")]
    )
    def test_choices(self, name, length):
        protocol = load_protocol(name)
        plan = make_plan(protocol, "P07", 42)
        pairs = Counter(tuple(s.value for s in trial.stimuli) for trial in plan.trials)
        assert len(pairs) == 30
        assert set(pairs.values()) == {3}
        for first, second in (trial.stimuli for trial in plan.trials):
            assert first.value != second.value
            assert (first.masks, first.tuning) == (second.masks, second.tuning)
            for g, value in ((first.geometry, first.value), (second.geometry, second.value)):
                gap_mm = g.dot_spacing_mm - g.dot_width_mm
                shown = g.dot_width_mm if length == "dot_width_mm" else gap_mm
                assert shown == pytest.approx(value)

    def test_letters(self):
        plan = make_plan(LETTERS_PROTOCOL, "P07", 42)
        assert Counter((trial.block, trial.condition) for trial in plan.trials) == {
            (block, name): 13 for block in (1, 2) for name in ("T0", "T25", "T100")
        }
        for name in ("T0", "T25", "T100"):
            shown = [t.stimuli[0].masks for t in plan.trials if t.condition == name]
            letters = Counter(mask for masks in shown for mask in masks)
            assert letters == dict.fromkeys(LETTERS.values(), 5)
            listed = sorted(tuple(sorted(masks)) for masks in LETTERS_PROTOCOL.design.strings)
            assert sorted(tuple(sorted(masks)) for masks in shown) == listed

    def test_no_order_of_letters_comes_again(self):
        for seed in range(20):
            plan = make_plan(LETTERS_PROTOCOL, "P07", seed)
            assert len({trial.presented for trial in plan.trials}) == 78

    def test_few_orders_come_again_as_seldom_as_they_can(self):
        protocol = parse('[design]\nkind = "list"\nstrings = ["aab"]\nreorder = true\nrepeats = 6')
        shown = Counter(trial.presented for trial in make_plan(protocol, "x", 1).trials)
        assert shown == {"⠁⠁⠃": 2, "⠁⠃⠁": 2, "⠃⠁⠁": 2}

    def test_words_stay_words(self):
        protocol = load_protocol("words")
        plan = make_plan(protocol, "P07", 42, texture=0.25)
        shown = [trial.stimuli[0].masks for trial in plan.trials]
        assert sorted(shown) == sorted(protocol.design.strings)
        assert shown != list(protocol.design.strings)
        assert {trial.stimuli[0].tuning.texture for trial in plan.trials} == {0.25}

    def test_blocks_that_do_not_come_out_even(self):
        protocol = parse(f"{PAIRS}blocks = 5\n{ABC}")
        plan = make_plan(protocol, "x", 1)
        sizes = Counter(trial.block for trial in plan.trials)
        assert sorted(sizes.values()) == [2, 2, 2, 3, 3]
        assert max(Counter((t.block, t.condition) for t in plan.trials).values()) == 1

    def test_practice(self):
        plan = make_plan(LEGIBILITY, "P07", 42)
        assert [trial.number for trial in plan.practice] == list(range(1, 9))
        assert {(trial.block, trial.practice) for trial in plan.practice} == {(0, True)}
        assert Counter(trial.condition for trial in plan.practice) == {"nominal": 4, "textured": 4}
        assert len({trial.presented for trial in plan.practice}) > 1

    @pytest.mark.parametrize("trials", [0, 1, 7, 500])
    def test_more_practice_does_not_change_the_rest(self, trials):
        other = structs.replace(
            LEGIBILITY, practice=structs.replace(LEGIBILITY.practice, trials=trials)
        )
        plan = make_plan(other, "P07", 42)
        assert len(plan.practice) == trials
        assert plan.trials == make_plan(LEGIBILITY, "P07", 42).trials

    @given(st.integers(0, 2**63 - 1), st.from_regex(r"[A-Za-z0-9][\w-]{0,9}1", fullmatch=True))
    def test_any_seed_gives_a_plan_that_keeps_the_rules(self, seed, participant):
        if participant.isascii():
            check_rules(LETTERS_PROTOCOL, make_plan(LETTERS_PROTOCOL, participant, seed))


class TestRefusals:
    @pytest.mark.parametrize("name", ["", "a/b", "../P07", "-P07", "P 07", "é", "P" * 33, "P07\n"])
    def test_pseudonyms(self, name):
        with pytest.raises(InputError, match=r"^participant is .*a pseudonym such as P07: 1 to 32"):
            make_plan(LEGIBILITY, name, 1)

    @pytest.mark.parametrize("seed", [-1, 2**63, 2**64])
    def test_seeds(self, seed):
        with pytest.raises(InputError, match=r"^seed is out of range; it must be 0 to 2⁶³ - 1$"):
            make_plan(LEGIBILITY, "P07", seed)

    def test_a_texture_that_all_conditions_have(self):
        says = r"^every condition of legibility has its own texture; leave ‹texture› out$"
        with pytest.raises(InputError, match=says):
            make_plan(LEGIBILITY, "P07", 1, texture=0.5)

    def test_a_contrast_out_of_range(self):
        with pytest.raises(InputError, match=r"^contrast is 2; it must be 0 to 1$"):
            make_plan(LEGIBILITY, "P07", 1, contrast=2)

    def test_a_contrast_for_those_that_have_none(self):
        protocol = parse(f"{PAIRS}{ABC}contrast = 0.5\n")
        plan = make_plan(protocol, "P1", 1, contrast=0.25)
        seen = {(t.condition, t.stimuli[0].tuning.contrast) for t in plan.trials}
        assert seen == {("A", 0.25), ("B", 0.25), ("C", 0.5)}
