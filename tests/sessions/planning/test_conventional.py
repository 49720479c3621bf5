"""What a protocol shows on a conventional display."""

from itertools import pairwise

import pytest

from vbraille.errors import InputError
from vbraille.sessions.planning.making import make_plan
from vbraille.sessions.planning.plan import Plan
from vbraille.sessions.planning.protocolfiles import load_protocol, parse_protocol
from vbraille.sessions.session import cells_needed

HEAD = """
format = 1
name = "both"
title = "Both"
source = "ours"
model = "vbd"
"""
STRINGS = '[design]\nkind = "list"\nstrings = ["ca", "cac"]\nblocks = 1\n'
BOTH = """
[[conditions]]
name = "virtual"
[[conditions]]
name = "conventional"
on = "brlapi"
"""
WIDTHS = """
[design]
kind = "choice"
parameter = "dot_width_mm"
values = [1.0, 2.0]
string = "a"
"""


def test_a_condition_says_where_its_strings_stand_and_the_plan_keeps_it():
    protocol = parse_protocol(HEAD + STRINGS + BOTH + "[conventional]\ncell = 5\n", "test")
    plan = make_plan(protocol, "P1", 1)
    for trial in plan.trials:
        assert trial.stimuli[0].conventional == (trial.condition == "conventional")
    assert Plan.from_json(plan.to_json()) == plan
    assert '"on": "brlapi"' in plan.to_json()
    assert protocol.needs_conventional
    assert cells_needed(protocol, plan) == 4 + 3
    assert not load_protocol("legibility").needs_conventional


def test_texts_stand_there_in_the_table_of_the_condition():
    texts = '[design]\nkind = "list"\nstrings = ["the"]\n[display]\nlead_cells = 1\n'
    both = BOTH.replace('name = "virtual"', 'name = "virtual"\ntable = "en-ueb-g1.ctb"')
    protocol = parse_protocol(
        HEAD.replace("vbd", "stress2") + texts + both + 'table = "en-ueb-g2.ctb"\n', "test"
    )
    shown = {t.condition: t.stimuli[0] for t in make_plan(protocol, "P1", 1).trials}
    assert (shown["conventional"].on, shown["conventional"].table) == ("brlapi", "en-ueb-g2.ctb")
    assert len(shown["conventional"].masks) == 1 < len(shown["virtual"].masks)


def test_its_cells_are_not_bound_to_the_rows_or_the_travel_of_the_device():
    letters = '[design]\nkind = "list"\nstrings = ["strings", "quickly"]\n'
    on = '[display]\non = "brlapi"\ntravel_mm = 30\n'
    protocol = parse_protocol(HEAD + letters + on, "test")
    plan = make_plan(protocol, "P1", 1)
    assert all(trial.stimuli[0].conventional for trial in plan.trials)
    spelling = protocol.cell_spelling(plan.trials[0].stimuli[0])
    assert spelling.shown_dots == 0xFF
    with pytest.raises(InputError, match="the VBD's row 1 shows dots 1 and 4 only"):
        parse_protocol(HEAD + letters, "test")


def test_the_displays_of_the_control_alternate_trial_by_trial():
    plan = make_plan(load_protocol("control-display"), "P07", 42)
    names = [trial.condition for trial in plan.trials]
    assert len(names) == 160
    assert all(a != b for a, b in pairwise(names))


@pytest.mark.parametrize(("name", "string"), [("width", (1,)), ("spacing", (0b1001,))])
def test_the_reference_is_what_the_source_had(name, string):
    protocol = load_protocol(f"tuning-{name}-reference")
    assert protocol.conventional.reference == string
    assert protocol.design == load_protocol(f"tuning-{name}").design
    assert cells_needed(protocol, make_plan(protocol, "P1", 1)) == 1


@pytest.mark.parametrize(
    ("toml", "why"),
    [
        (STRINGS + BOTH.replace("brlapi", "brltty"), "[[conditions]] number 2 on is 'brltty'"),
        (STRINGS + BOTH + "texture = 1.0\n", "on a conventional display, which has no texture"),
        (STRINGS + BOTH + "[conventional]\ncell = 0\n", "[conventional] cell is 0"),
        (STRINGS + BOTH + '[conventional]\nreference = "a"\n', "leave one of the two out"),
        (WIDTHS + BOTH, "[design] compares what a conventional display cannot change"),
        (
            'medium = "paper"\n' + STRINGS + '[conventional]\nreference = "a"\n',
            "[conventional] reference stands beside a device",
        ),
    ],
)
def test_what_cannot_be_is_one_sentence(toml, why):
    with pytest.raises(InputError) as raised:
        parse_protocol(HEAD + toml, "test")
    assert why in str(raised.value)
