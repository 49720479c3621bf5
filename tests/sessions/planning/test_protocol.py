"""Protocols: the source's come with the program, and a lab's are read from files."""

import re
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from msgspec import structs

from tests.conftest import TEXTS
from vbraille.braille.geometry import VBD
from vbraille.braille.spelling import spell
from vbraille.errors import InputError
from vbraille.render import MAPPINGS, Tuning
from vbraille.sessions import planning
from vbraille.sessions.planning.design import Practice
from vbraille.sessions.planning.making import make_plan
from vbraille.sessions.planning.pace import ParticipantField, Tone
from vbraille.sessions.planning.plan import Plan
from vbraille.sessions.planning.protocolfiles import (
    builtin_names,
    builtin_text,
    load_protocol,
    parse_protocol,
)

HEAD = 'format = 1\nname = "mine"\ntitle = "Mine"\nsource = "Here"\n'
VBD_HEAD = f'{HEAD}model = "vbd"\n'
STRESS2_HEAD = f'{HEAD}model = "stress2"\n'
PAIRS = '[design]\nkind = "combinations"\ncharacters = ["a", "c"]\nlength = 2\n'
WIDTHS = '[design]\nkind = "choice"\nparameter = "dot_width_mm"\nvalues = [1, 2]\nstring = "a"\n'
GAPS = WIDTHS.replace("width", "gap").replace('"a"', '"c"')


def parse(text):
    return parse_protocol(text, "mine.toml")


class TestBuiltIns:
    def test_names(self):
        assert builtin_names() == [
            "control",
            "control-display",
            "detection",
            "factors",
            "icons",
            "legibility",
            "letters",
            "orientation-coarse",
            "orientation-fine",
            "rating",
            "same-different",
            "shapes",
            "spatial-frequency",
            "tuning-spacing",
            "tuning-spacing-adaptive",
            "tuning-spacing-reference",
            "tuning-width",
            "tuning-width-adaptive",
            "tuning-width-reference",
            "words",
        ]

    @pytest.mark.parametrize("name", builtin_names())
    def test_each_is_what_its_file_says(self, name):
        protocol = load_protocol(name)
        assert protocol.name == name
        assert protocol.text == builtin_text(name)
        assert protocol.source == "ours" or protocol.source.startswith("Lévesque 2009, ")
        asked = [field.name for field in protocol.fields]
        assert asked[:3] == ["finger", "hand", "masking_noise"]
        assert asked[3:] == ["sight"] * protocol.pictures

    @pytest.mark.parametrize("name", builtin_names())
    def test_each_explains_its_tables_and_keys(self, name):
        before = table = ""
        for line in builtin_text(name).splitlines():
            table = line if line.startswith("[") else table
            # Tables that come again are explained where they come first, delimiters together.
            if re.match(r"[a-z_]+ = ", line) and table != "[keys]" and table[:2] != "[[":
                assert before.startswith("#") or line.startswith("after = ")
            before = line
        assert "\n# What is asked about the participant" in builtin_text(name)

    def test_a_copy_is_the_same_protocol(self, tmp_path):
        copy = tmp_path / "copy.toml"
        copy.write_bytes(builtin_text("legibility").encode())
        assert load_protocol(str(copy)) == load_protocol("legibility")

    def test_they_are_beside_the_code(self):
        folder = Path(planning.__file__).parent / "protocols"
        assert sorted(path.stem for path in folder.glob("*.toml")) == builtin_names()
        named = {name for each in builtin_names() for name in load_protocol(each).files}
        assert named == {path.name for path in folder.iterdir() if path.suffix != ".toml"}

    def test_tuning_of_the_width(self):
        protocol = load_protocol("tuning-width")
        assert (protocol.task, protocol.parameter) == ("choice", "dot_width_mm")
        assert protocol.design.values == (0.5, 1.0, 1.5, 2.0, 2.5, 3.0)
        assert (protocol.design.string, protocol.trials) == ((1,), 90)
        assert [protocol.style_of(c).tuning.texture for c in protocol.conditions] == [1.0]

    def test_tuning_of_the_spacing(self):
        protocol = load_protocol("tuning-spacing")
        assert (protocol.task, protocol.parameter) == ("choice", "dot_gap_mm")
        assert protocol.design.values == (1.0, 1.3, 1.6, 1.9, 2.2, 2.5)
        assert (protocol.design.string, protocol.trials) == ((0b1001,), 90)
        assert protocol.geometry.dot_width_mm == 2.0

    def test_legibility(self):
        protocol = load_protocol("legibility")
        assert (protocol.task, protocol.parameter, protocol.medium) == ("strings", None, "device")
        assert protocol.model.name == "vbd"
        assert protocol.mapping.shown_dots() == 0b1001
        assert protocol.keys == {"l": 1, "r": 8, "n": 0}
        assert protocol.design.characters == (1, 9, 8, 0)
        assert (protocol.design.before, protocol.design.after) == ((9,), (9,))
        assert [(c.name, protocol.style_of(c).tuning) for c in protocol.conditions] == [
            ("nominal", Tuning(texture=0.0)),
            ("textured", Tuning(texture=1.0)),
        ]
        assert (protocol.trials, protocol.practice.trials) == (160, 8)
        assert (protocol.design.blocks, protocol.design.order) == ("conditions", "balanced")

    def test_control_is_legibility_on_paper(self):
        protocol, device = load_protocol("control"), load_protocol("legibility")
        assert protocol.medium == "paper"
        same = structs.replace(protocol.design, order=device.design.order)  # which nothing has
        assert (same, protocol.keys) == (device.design, device.keys)
        assert (len(protocol.conditions), protocol.trials) == (1, 80)

    def test_letters(self):
        protocol = load_protocol("letters")
        assert (protocol.model.name, protocol.mapping) == ("stress2", MAPPINGS["alternate"])
        assert [protocol.style_of(c).tuning.texture for c in protocol.conditions] == [
            0.0,
            0.25,
            1.0,
        ]
        assert {protocol.style_of(c).tuning.cycles for c in protocol.conditions} == {7}
        assert (len(protocol.design.strings), protocol.trials) == (26, 78)
        assert all(len(set(string)) == 5 for string in protocol.design.strings)
        assert (protocol.design.blocks, protocol.design.reorder) == (2, True)
        assert (protocol.practice.trials, len(protocol.practice.items(protocol.design))) == (6, 6)
        assert (protocol.rules.each_letter, protocol.trial.warning_s) == (5, 30.0)
        assert '"epkgn"' in protocol.text

    def test_words_are_those_of_the_texts(self):
        protocol = load_protocol("words")
        words = (TEXTS / "mots.txt").read_text(encoding="utf-8").split()
        assert protocol.design.strings == tuple(spell(word, {}) for word in words)
        assert protocol.trials == 40
        assert protocol.rules.each_letter_at_least == 4
        assert protocol.session.limit_s == 3600.0
        assert protocol.style_of(protocol.conditions[0]).tuning == Tuning(texture=1.0)


class TestParsing:
    def test_what_is_left_out(self):
        protocol = parse(VBD_HEAD + PAIRS)
        assert protocol.geometry == VBD
        assert (protocol.medium, protocol.faults.repeat) == ("device", True)
        assert protocol.practice == Practice()
        assert not protocol.rules.never_twice_running
        assert (protocol.design.blocks, protocol.design.repeats) == ("conditions", 1)
        assert (protocol.design.order, protocol.balanced) == (None, False)
        assert [(c.name, protocol.style_of(c).tuning, c.changes) for c in protocol.conditions] == [
            ("all", Tuning(), {})
        ]
        assert (protocol.trial.gap_s, protocol.trial.warning_s) == (0.5, None)
        assert (protocol.session.limit_s, protocol.session.break_every) == (None, None)
        assert protocol.session.blind
        assert (protocol.sound.cue, protocol.sound.warning) == (Tone(880, 150), Tone(440, 400))
        assert (protocol.keys, protocol.fields) == ({}, ())

    def test_what_is_given(self):
        protocol = parse(
            f"""{STRESS2_HEAD}medium = "paper"
            [display]
            texture = 0.5
            contrast = 0.75
            texture_cycles = 5
            mapping = "paired"
            dot_width_mm = 3
            travel_mm = 200
            [keys]
            x = "1-2"
            [design]
            kind = "list"
            strings = ["x⠁⠈"]
            repeats = 2
            blocks = "conditions"
            order = "listed"
            [[conditions]]
            name = "weak"
            contrast = 0.25
            [[conditions]]
            name = "fine"
            texture_cycles = 9
            texture = 1
            [practice]
            trials = 3
            strings = ["xx"]
            [trial]
            gap_s = 1
            warning_s = 20
            [session]
            limit_s = 60
            break_every = 5
            [faults]
            repeat = false
            [sound]
            cue = [1000, 100]
            [[fields]]
            name = "finger"
            ask = "Which?"
            """
        )
        assert (protocol.geometry.dot_width_mm, protocol.geometry.travel_mm) == (3.0, 200.0)
        assert (protocol.mapping.name, protocol.medium) == ("paired", "paper")
        assert protocol.design.strings == ((3, 1, 8),)
        assert [(c.name, protocol.style_of(c).tuning, c.changes) for c in protocol.conditions] == [
            ("weak", Tuning(0.5, 0.25, 5), {"contrast": 0.25}),
            ("fine", Tuning(1.0, 0.75, 9), {"texture": 1.0, "cycles": 9}),
        ]
        assert (protocol.design.order, protocol.trials) == ("listed", 4)
        assert protocol.practice == Practice(3, ((3, 3),))
        assert (protocol.trial.gap_s, protocol.trial.warning_s) == (1.0, 20.0)
        assert (protocol.session.limit_s, protocol.session.break_every) == (60.0, 5)
        assert not protocol.faults.repeat
        assert protocol.sound.cue == Tone(1000, 100)
        assert protocol.fields == (ParticipantField("finger", "Which?"),)

    @pytest.mark.parametrize(
        ("value", "width_mm", "spacing_mm"), [(None, 2.0, 4.0), (1.5, 2.0, 3.5), (0.0, 2.0, 2.0)]
    )
    def test_a_gap_is_from_edge_to_edge(self, value, width_mm, spacing_mm):
        geometry = _geometry(parse(VBD_HEAD + GAPS), value)
        assert (geometry.dot_width_mm, geometry.dot_spacing_mm) == (width_mm, spacing_mm)

    def test_a_width_leaves_the_centres_where_they_are(self):
        geometry = _geometry(parse(VBD_HEAD + WIDTHS), 1.0)
        assert (geometry.dot_width_mm, geometry.dot_spacing_mm) == (1.0, 4.0)

    @given(st.text(max_size=200) | st.text("[]={}\"'.#\n a1", max_size=60))
    def test_whatever_a_file_has_a_sentence_is_said(self, text):
        with pytest.raises(InputError, match=r"^mine\.toml"):
            parse(text)


class TestLoading:
    def test_a_name_that_is_not_there(self):
        says = (
            r"^there is no protocol 'leters'; the nearest is letters, and there is control, "
            r".*, words; that of a file ends in \.toml, or has a / in it$"
        )
        with pytest.raises(InputError, match=says):
            load_protocol("leters")

    @pytest.mark.parametrize("name", ["", "..", "__init__", "letters\0"])
    def test_names_that_are_no_names(self, name):
        with pytest.raises(InputError, match=r"^there is no protocol "):
            load_protocol(name)

    def test_a_file_that_is_not_there(self):
        with pytest.raises(InputError, match=r"^there is no file none\.toml; check the name$"):
            load_protocol("none.toml")

    def test_a_directory(self, tmp_path):
        with pytest.raises(InputError, match=r" is a directory; give a protocol in it$"):
            load_protocol(str(tmp_path))

    @pytest.mark.parametrize("name", ["a\0.toml", f"{'a' * 300}.toml"])
    def test_names_that_no_file_can_have(self, name):
        with pytest.raises(InputError, match=r" cannot be read: "):
            load_protocol(name)

    def test_a_file_that_is_not_utf_8(self, tmp_path):
        path = tmp_path / "mine.toml"
        path.write_bytes(b"format = 1\n# L\xe9vesque\n")
        with pytest.raises(InputError, match=r" is not UTF-8 in line 2; save it as UTF-8$"):
            load_protocol(str(path))

    def test_a_file_that_is_far_too_large(self):
        with pytest.raises(InputError, match=r"^/dev/zero is too large for a protocol"):
            load_protocol("/dev/zero")

    def test_a_byte_order_mark_and_windows_line_ends(self, tmp_path):
        path = tmp_path / "mine.toml"
        text = (VBD_HEAD + PAIRS).replace("\n", "\r\n")
        path.write_bytes(b"\xef\xbb\xbf" + text.encode())
        assert load_protocol(str(path)).text == text


def _geometry(protocol, value):
    """Distances at a value of what is compared."""
    return protocol.shown(protocol.conditions[0], (1,), value).geometry


class TestPlannedAnalysis:
    """The plan of a session fixes the question of its study."""

    @pytest.mark.parametrize("name", builtin_names())
    def test_each_shipped_protocol_plans_one(self, name):
        protocol = load_protocol(name)
        assert protocol.analysis is not None
        planned = make_plan(protocol, "P01", 1).analysis
        assert planned == protocol.planned_analysis
        assert planned.measure == protocol.analysis.measure
        assert planned.participants is not None
        assert planned.stop

    def test_it_changes_the_plan_and_comes_back(self):
        protocol = load_protocol("letters")
        other = structs.replace(
            protocol, analysis=structs.replace(protocol.analysis, participants=7)
        )
        plans = [make_plan(each, "P01", 1) for each in (protocol, other)]
        assert plans[0].trials == plans[1].trials
        assert plans[0].to_json() != plans[1].to_json()
        assert Plan.from_json(plans[1].to_json()) == plans[1]

    def test_without_the_table_the_usual_one_is_planned(self):
        for name in builtin_names():
            protocol = load_protocol(name)
            usual = structs.replace(protocol, analysis=None).planned_analysis
            assert usual.measure == protocol.planned_analysis.measure
            planned = protocol.planned_analysis.factors
            assert usual.factors == tuple(f for f in planned if not f.startswith("item_"))
            assert usual.model in ("trials", "means")

    @pytest.mark.parametrize(
        ("table", "named"),
        [
            ('measure = "speed"', "speed"),
            ('measure = "rating"', "rating"),
            ('measure = "threshold"', "procedure"),
            ('factors = ["hue"]', "hue"),
            ('factors = ["condition", "condition"]', "twice"),
            ('measure = "duration"\nmodel = "trials"', "duration"),
            ("too_fast_s = 3\ntoo_slow_s = 2", "too_fast_s"),
            ("catch_right = 0.5", "catch_right"),
            ("participants = 0", "participants"),
        ],
    )
    def test_one_that_does_not_suit_is_refused(self, table, named):
        text = builtin_text("letters").partition("[analysis]")[0]
        with pytest.raises(InputError, match=named):
            parse_protocol(f"{text}[analysis]\n{table}\n", "mine.toml")
