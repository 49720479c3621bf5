"""A plan that was damaged on the disk is refused in one sentence."""

import json

import pytest

from vbraille.errors import InputError
from vbraille.sessions.planning.making import make_plan
from vbraille.sessions.planning.plan import Plan, stimulus_from_json, stimulus_to_json
from vbraille.sessions.planning.protocolfiles import load_protocol


class TestDamage:
    @pytest.mark.parametrize(
        ("old", "new"),
        [
            ("{", ""),
            ('"format": 2', '"format": true'),
            ('"format": 2', '"format": "2"'),
            ('"seed": 42', '"seed": 42.0'),
            ('"seed": 42', '"seed": -1'),
            ('"seed": 42', '"seed": true'),
            ('"order": 0', '"ordre": 0'),
            ('"P07"', '"../P07"'),
            ('"practice": [', '"practice": [3,'),
            ('"number": 1', '"number": 0'),
            ('"number": 1', '"number": "1"'),
            ('"block": 1', '"block": -1'),
            ('"asked": [0, 5]', '"asked": [0, 6]'),
            ('"asked": [0, 5]', '"asked": [0]'),
            ('"asked": [0, 5]', '"asked": [0.0, 5]'),
            ('"texture": 1.0', '"texture": 1.5'),
            ('"texture": 1.0', '"texture": NaN'),
            ('"contrast": 1.0', '"contrast": null'),
            ('"cells": "', '"cells": "!'),
            ('"dot_width_mm": 2.6', '"dot_width_mm": 99.0'),
            ('"travel_mm"', '"travel"'),
            ('"value_mm": null', '"value_mm": "1"'),
        ],
    )
    def test_one_place(self, old, new):
        text = make_plan(load_protocol("words"), "P07", 42).to_json()
        assert old in text
        with pytest.raises(InputError, match=r"^the plan is damaged: .*"):
            Plan.from_json(text.replace(old, new, 1))

    @pytest.mark.parametrize("version", [1, 3])
    def test_a_plan_of_another_version(self, version):
        text = make_plan(load_protocol("words"), "P07", 42).to_json()
        says = f"^the plan is of version {version}, and this vbraille knows version 2; use "
        with pytest.raises(InputError, match=says):
            Plan.from_json(text.replace('"format": 2', f'"format": {version}'))

    @pytest.mark.parametrize("text", ["", "[]", "3", "[" * 100_000, '{"format": 2}'])
    def test_what_is_no_plan(self, text):
        with pytest.raises(InputError, match=r"^the plan is damaged: "):
            Plan.from_json(text)

    def test_a_plan_cut_short(self):
        text = make_plan(load_protocol("words"), "P07", 42).to_json()
        for end in range(0, len(text) - 2, 97):
            with pytest.raises(InputError, match=r"^the plan is damaged: "):
                Plan.from_json(text[:end])


class TestStimuli:
    @pytest.mark.parametrize("name", ["legibility", "tuning-width"])
    def test_one_comes_back_as_it_went(self, name):
        for trial in make_plan(load_protocol(name), "P07", 42).trials:
            for stimulus in trial.stimuli:
                written = json.dumps(stimulus_to_json(stimulus))
                assert stimulus_from_json(json.loads(written)) == stimulus

    @pytest.mark.parametrize(
        "change", [{"cells": ""}, {"cells": 3}, {"texture": 2.0}, {"cycles": 7.0}, {"hue": 1}]
    )
    def test_one_that_is_damaged(self, change):
        (stimulus,) = make_plan(load_protocol("words"), "P07", 42).trials[0].stimuli
        with pytest.raises(ValueError, match=r"."):
            stimulus_from_json(stimulus_to_json(stimulus) | change)
