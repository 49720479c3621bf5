"""A finished plan is not taken on trust: whatever rule it breaks is named."""

from dataclasses import replace
from itertools import groupby

import pytest
from msgspec import structs

from tests.sessions.planning.rulebook import check_rules
from vbraille.errors import InputError
from vbraille.sessions.planning.making import check_plan, make_plan
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


def changed(plan, which, /, **values):
    """The plan with one trial of another kind."""
    trials = list(plan.trials)
    trials[which - 1] = structs.replace(trials[which - 1], **values)
    return structs.replace(plan, trials=tuple(trials))


class TestChecking:
    def refuse(self, protocol, plan, says):
        """Check by the rules, and by making the plan again, which tells every alteration."""
        with pytest.raises(ValueError, match=says):
            check_rules(protocol, plan)
        made = rf"^the plan of P07 for [\w-]+ is not what seed {plan.seed} makes: .*; put it back"
        with pytest.raises(InputError, match=made):
            check_plan(protocol, plan)

    def test_a_plan_of_another_protocol(self):
        plan = make_plan(LEGIBILITY, "P07", 42)
        self.refuse(LETTERS_PROTOCOL, plan, "it is of the protocol legibility")

    def test_a_number_that_is_wrong(self):
        plan = changed(make_plan(LEGIBILITY, "P07", 42), 3, number=4)
        self.refuse(LEGIBILITY, plan, "trial 3 of all has the number 4")

    def test_a_trial_too_few(self):
        plan = make_plan(LEGIBILITY, "P07", 42)
        says = "condition textured shows .. 4 times, and must 5 times"
        self.refuse(LEGIBILITY, structs.replace(plan, trials=plan.trials[:-1]), says)

    def test_a_trial_for_another(self):
        plan = make_plan(LEGIBILITY, "P07", 42)
        one = plan.trials[0]
        other = next(t for t in plan.trials[:80] if t.presented != one.presented)
        wrong = changed(plan, other.number, stimuli=one.stimuli)
        self.refuse(LEGIBILITY, wrong, "condition nominal shows")

    def test_practice_that_is_missing(self):
        plan = structs.replace(make_plan(LEGIBILITY, "P07", 42), practice=())
        self.refuse(LEGIBILITY, plan, "0 trials are practice, and 8 must be")

    def test_cells_that_are_not_of_the_design(self):
        plan = make_plan(LEGIBILITY, "P07", 42)
        stimulus = plan.trials[0].stimuli[0]
        odd = (replace(stimulus, masks=(9, 2, 0, 9)),)
        self.refuse(LEGIBILITY, changed(plan, 1, stimuli=odd), "shows what is not in the design")
        bare = (replace(stimulus, masks=(1, 1, 0, 9)),)
        self.refuse(LEGIBILITY, changed(plan, 1, stimuli=bare), "between the delimiters")
        self.refuse(LEGIBILITY, changed(plan, 1, asked=(0, 3)), "between the delimiters")

    def test_distances_and_textures_that_are_not_the_protocol_s(self):
        plan = make_plan(LEGIBILITY, "P07", 42)
        stimulus = plan.trials[0].stimuli[0]
        wide = (replace(stimulus, geometry=replace(stimulus.geometry, dot_width_mm=3.0)),)
        self.refuse(LEGIBILITY, changed(plan, 1, stimuli=wide), "has other distances than")
        rough = (replace(stimulus, tuning=replace(stimulus.tuning, texture=0.5)),)
        self.refuse(LEGIBILITY, changed(plan, 1, stimuli=rough), "has not one texture and")

    def test_a_texture_that_is_the_wrong_one_throughout(self):
        rough = parse(f"{PAIRS}[[conditions]]\nname = 'all'\ntexture = 0.5")
        plain = parse(f"{PAIRS}[[conditions]]\nname = 'all'\ntexture = 0.0")
        self.refuse(plain, make_plan(rough, "P07", 1), "condition all has another texture")

    def test_identical_stimuli(self):
        protocol = load_protocol("tuning-width")
        plan = make_plan(protocol, "P07", 42)
        twice = (plan.trials[0].stimuli[0],) * 2
        self.refuse(protocol, changed(plan, 1, stimuli=twice), "compares two identical stimuli")
        alone = plan.trials[0].stimuli[:1]
        self.refuse(protocol, changed(plan, 1, stimuli=alone), "has 1 stimuli")

    def test_another_string_or_condition(self):
        protocol = load_protocol("tuning-width")
        plan = make_plan(protocol, "P07", 42)
        other = tuple(replace(stimulus, masks=(8,)) for stimulus in plan.trials[0].stimuli)
        self.refuse(protocol, changed(plan, 1, stimuli=other), "shows another string than")
        practised = make_plan(LEGIBILITY, "P07", 42)
        odd = structs.replace(practised.practice[0], condition="odd")
        plan = structs.replace(practised, practice=(odd, *practised.practice[1:]))
        self.refuse(LEGIBILITY, plan, "trial 1 is of a condition 'odd'")
        inside = structs.replace(practised.practice[0], block=1)
        plan = structs.replace(practised, practice=(inside, *practised.practice[1:]))
        self.refuse(LEGIBILITY, plan, "a practice trial is in a block")

    def test_pairs_too_often(self):
        protocol = load_protocol("tuning-width")
        plan = make_plan(protocol, "P07", 42)
        values = [tuple(s.value for s in t.stimuli) for t in plan.trials]
        other = next(n for n, pair in enumerate(values, 1) if pair != values[0])
        wrong = changed(plan, other, stimuli=plan.trials[0].stimuli)
        says = "condition all shows .* mm and .* mm [24] times, and must 3 times"
        self.refuse(protocol, wrong, says)

    def test_a_letter_that_became_another(self):
        plan = make_plan(LETTERS_PROTOCOL, "P07", 42)
        stimulus = plan.trials[0].stimuli[0]
        odd = (replace(stimulus, masks=(*stimulus.masks[:4], 63)),)
        self.refuse(LETTERS_PROTOCOL, changed(plan, 1, stimuli=odd), "is not in the design")

    def test_practice_of_what_the_test_shows(self):
        plan = make_plan(LEGIBILITY, "P07", 42)
        test = structs.replace(plan.trials[0], number=1, block=0)
        given = structs.replace(plan, practice=(test, *plan.practice[1:]))
        self.refuse(LEGIBILITY, given, "trial 1 of practice shows what is not in the design")

    def test_the_same_string_twice_running(self):
        plan = make_plan(LEGIBILITY, "P07", 42)
        first, second = plan.trials[:2]
        other = next(t for t in plan.trials[2:80] if t.presented == first.presented)
        swapped = changed(plan, 2, stimuli=other.stimuli)
        swapped = changed(swapped, other.number, stimuli=second.stimuli)
        self.refuse(LEGIBILITY, swapped, "trials 1 and 2 show the same")
        practised = structs.replace(plan.practice[0], number=2)
        twice = structs.replace(plan, practice=(plan.practice[0], practised, *plan.practice[2:]))
        self.refuse(LEGIBILITY, twice, "practice trials 1 and 2 show the same")

    def test_another_order_of_conditions(self):
        plan = make_plan(LEGIBILITY, "P07", 42)
        says = "its conditions are not in the balanced order 2"
        self.refuse(LEGIBILITY, structs.replace(plan, order=2), says)
        self.refuse(LEGIBILITY, structs.replace(plan, order=3), "it has the balanced order 3 of 2")
        plan = make_plan(LETTERS_PROTOCOL, "P07", 42)
        self.refuse(LETTERS_PROTOCOL, structs.replace(plan, order=1), "order 1, and there is none")

    def test_blocks_that_are_mixed(self):
        plan = make_plan(LEGIBILITY, "P07", 42)
        self.refuse(LEGIBILITY, changed(plan, 80, block=2), "blocks are not of one condition each")
        self.refuse(LEGIBILITY, changed(plan, 1, block=3), "its blocks are not 1 to 2")

    def test_blocks_that_are_uneven(self):
        plan = make_plan(LETTERS_PROTOCOL, "P07", 42)
        moved = changed(changed(plan, 40, block=1), 41, block=1)
        self.refuse(LETTERS_PROTOCOL, moved, "is not spread evenly over the blocks")

    def test_conditions_that_are_not_as_listed(self):
        free = parse(f'{PAIRS}order = "shuffled"\n{ABC}')
        listed = parse(f'{PAIRS}order = "listed"\n{ABC}')
        plans = [make_plan(free, "P07", seed) for seed in range(9)]
        other = next(p for p in plans if conditions_of(p.trials) != ["A", "B", "C"])
        self.refuse(listed, other, "its conditions are not in the order listed")

    def test_letters_are_counted(self):
        strings = '[design]\nkind = "list"\nstrings = ["abcdefghijklm", "nopqrstuvwxyz"]\n'
        protocol = parse(f"{strings}[rules]\neach_letter = 1\neach_letter_at_least = 1")
        plan = make_plan(protocol, "P07", 1)
        check_rules(protocol, plan)
        says = "a is shown once; each_letter is 2"
        with pytest.raises(ValueError, match=says):
            Rules(each_letter=2).check_letters(t.stimuli[0].masks for t in plan.trials)
        wrong = changed(plan, 1, stimuli=plan.trials[1].stimuli)
        self.refuse(protocol, wrong, "condition all shows ⠁⠃⠉.* times, and must 1 times|⠝⠕⠏")

    def test_two_trials_of_one_condition_that_changed_places(self):
        """They keep every rule, and are no plan of this seed all the same."""
        plan = make_plan(LETTERS_PROTOCOL, "P07", 42)
        first = plan.trials[0]
        other = next(
            t
            for t in plan.trials[1:]
            if t.block == first.block and t.condition == first.condition and t.item != first.item
        )
        swapped = changed(plan, 1, stimuli=other.stimuli)
        swapped = changed(swapped, other.number, stimuli=first.stimuli)
        with pytest.raises(InputError, match="makes: trial 1 differs in its stimuli"):
            check_plan(LETTERS_PROTOCOL, swapped)


@pytest.mark.parametrize("name", builtin_names())
def test_a_plan_is_what_its_seed_makes(name):
    protocol = load_protocol(name)
    for participant, seed in (("P07", 42), ("P12", 0)):
        plan = make_plan(protocol, participant, seed)
        check_plan(protocol, Plan.from_json(plan.to_json()))
        check_plan(protocol.assigned(plan.group), plan)
        with pytest.raises(InputError, match=f"not what seed {seed + 1} makes"):
            check_plan(protocol, structs.replace(plan, seed=seed + 1))


@pytest.mark.parametrize("given", [{"texture": 0.25}, {"contrast": 0.5}])
def test_a_texture_that_was_given_for_the_session_is_of_its_plan(given):
    plan = make_plan(load_protocol("words"), "P07", 42, **given)
    check_plan(load_protocol("words"), plan)
