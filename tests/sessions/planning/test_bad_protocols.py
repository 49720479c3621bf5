"""What a file cannot have is said in one sentence: where it is, what is wrong, what to do."""

import re

import pytest

from vbraille.errors import InputError
from vbraille.sessions.planning.protocolfiles import parse_protocol

HEAD = 'format = 1\nname = "mine"\ntitle = "Mine"\nsource = "Here"\n'
VBD_HEAD = f'{HEAD}model = "vbd"\n'
STRESS2_HEAD = f'{HEAD}model = "stress2"\n'
PAIRS = '[design]\nkind = "combinations"\ncharacters = ["a", "c"]\nlength = 2\n'
STRINGS = '[design]\nkind = "list"\nstrings = ["ab", "cd"]\n'
WIDTHS = '[design]\nkind = "choice"\nparameter = "dot_width_mm"\nvalues = [1, 2]\nstring = "a"\n'
GAPS = WIDTHS.replace("width", "gap").replace('"a"', '"c"')


def parse(text):
    return parse_protocol(text, "mine.toml")


def refuse(text, line, says):
    """The line, 0 for none, and the whole sentence, or its beginning and end around a …."""
    pattern = (f" line {line}" if line else "") + ".*".join(map(re.escape, says.split("…")))
    with pytest.raises(InputError, match=rf"^mine\.toml{pattern}$"):
        parse(text)


BAD_HEADS = [
    (0, PAIRS, ": lacks format; add it"),
    (1, VBD_HEAD.replace("1", "2"), ": format is 2, and this vbraille knows format 1; use…it"),
    (1, f"format = {'1' * 30}", f": format is {'1' * 30}; it must be a smaller number"),
    (1, "format = true", ": format is True; it must be a whole number"),
    (1, f"format = 0x{'f' * 5000}", ": format is too large a number; it must be a smaller number"),
    (0, "format 1", " is not TOML: …; mend it there"),
    (0, "a = " + "[" * 5000, " is not TOML: its brackets nest too deep; mend it"),
    (6, VBD_HEAD + "desing = 1", ": has no key 'desing'; the nearest is design, and there is…"),
    (
        5,
        VBD_HEAD.replace("vbd", "vdb") + PAIRS,
        ": model is 'vdb'; the nearest is vbd, and there is…",
    ),
    (
        2,
        VBD_HEAD.replace("mine", "My own") + PAIRS,
        ": name is 'My own'; it must be 1 to 40…hyphens",
    ),
    (3, VBD_HEAD.replace("Mine", "") + PAIRS, ": title has 0 characters; it must have 1 to 200"),
    (3, VBD_HEAD.replace("Mine", r"a\nb") + PAIRS, r": title is 'a\nb'; it must be one line…"),
    (6, f'{VBD_HEAD}medium = "air"\n' + PAIRS, ": medium is 'air'; the nearest is…"),
    (6, f"{VBD_HEAD}design = 3", ": design is 3; it must be a table"),
    (
        10,
        VBD_HEAD + PAIRS + "[rules]\neach_letter = 5",
        ": [rules] count the letters of kind…",
    ),
]
BAD_DISPLAYS = [
    (VBD_HEAD, "texture = 2", "texture is 2; it must be 0 to 1"),
    (VBD_HEAD, "texture = nan", "texture is nan; it must be 0 to 1"),
    (VBD_HEAD, 'texture = "1"', "texture is '1'; it must be a number"),
    (VBD_HEAD, "texture_cycles = 7", "texture_cycles is of the STReSS²; the texture of the VBD…"),
    (VBD_HEAD, "dot_row = 4", "dot row is 4; it must be 1, 2 or 3"),
    (VBD_HEAD, 'mapping = "paired"', "mapping is of the STReSS²; for the VBD give dot_row"),
    (VBD_HEAD, "dot_width = 2", "has no key 'dot_width'; the nearest is dot_width_mm, and…"),
    (VBD_HEAD, "dot_width_mm = 30", "dot width is 30 mm; it must be 0.1 to 20 mm"),
    (VBD_HEAD, f"travel_mm = 1{'0' * 400}", "travel_mm is 1000…; it must be a smaller number"),
    (
        STRESS2_HEAD,
        "dot_row = 1",
        "dot_row is of the VBD; the STReSS² shows all, …",
    ),
    (STRESS2_HEAD, 'mapping = "pair"', "mapping is 'pair'; the nearest is paired, and there is…"),
    (STRESS2_HEAD, "texture_cycles = 6", "texture cycles are 6; they must be an odd number…"),
]
BAD_KEYS = [
    ('ab = "1"', "'ab' is no key; a key must be one character, and no digit…"),
    ('1 = "1"', "'1' is no key; a key must be…"),
    ('"?" = "1"', "'?' is no key; a key must be…"),
    ('" " = "1"', "' ' is no key; a key must be…"),
    ("x = 1", "x is 1; it must be a string, in quotation marks"),
    ('x = "1 4"', "x is 2 cells; it must be the dot numbers of one, such as 4"),
    ('x = "9"', "x: '9' is not the dots of a cell, such as 1-2-4, or 0 for none"),
    ('x = "2"', "x is dot 2, and the VBD's row 1 shows dots 1 and 4 only; leave the key out"),
]
BAD_DESIGNS = [
    (6, "[design]", "lacks kind; add it"),
    (7, '[design]\nkind = "lists"', "kind is 'lists'; the nearest is list, and there is…"),
    (
        10,
        PAIRS + "reorder = true",
        "reorder is of kind = 'list' or 'items'; leave it out…",
    ),
    (10, PAIRS + "repeats = 0", "repeats is 0; it must be 1 to 10000"),
    (10, PAIRS + "repeats = 1.5", "repeats is 1.5; it must be a whole number"),
    (6, PAIRS + "repeats = 2501", "makes a session of more than 10000 trials; make it smaller"),
    (9, PAIRS.replace("2", "0"), "length is 0; it must be 1 to 100"),
    (6, PAIRS.replace("2", "100"), "makes a session of more than 10000 trials; make it smaller"),
    (8, PAIRS.replace('"a", ', '"14", '), "characters have dots 1 and 4 twice; leave one out"),
    (8, PAIRS.replace('"a", "c"', ""), "characters are none; give one or more"),
    (8, PAIRS.replace('"a"', '"aa"'), "characters, number 1: 'aa' is 2 cells; give one"),
    (
        8,
        PAIRS.replace('"a"', '"0"'),
        "characters have a blank, and nothing can be felt of a…before and after",
    ),
    (
        6,
        PAIRS.replace('"a"', '"full"'.replace("full", "123456")),
        "has the cell ⠿ (dots 1, 2, 3, 4, 5 and 6), and the VBD's row 1 shows dots 1 and 4 only; "
        "leave the cell out",
    ),
    (6, PAIRS + 'before = "b"', "has the cell ⠃ (dots 1 and 2), and the VBD's row 1 shows…"),
    (
        6,
        PAIRS + f'before = "{"c" * 27}"',
        "has a line of 30 cells, lead_cells among them, and the VBD has room for 28; "
        "make it shorter, or travel_mm longer",
    ),
    (10, PAIRS + "blocks = 5", "blocks is 5; it must be 1 to 4, since there are 4 trials"),
    (10, PAIRS + "blocks = 0", "blocks is 0; it must be 1 to 4, since there are 4 trials"),
    (10, PAIRS + 'blocks = "condition"', "blocks is 'condition'; the nearest is conditions, and…"),
    (
        11,
        PAIRS + 'blocks = 2\norder = "listed"',
        "order is of a block each condition; leave it out…",
    ),
    (10, PAIRS + 'order = "random"', "order is 'random'; there is…"),
    (8, STRINGS.replace('"ab", "cd"', ""), "strings are none; give one or more"),
    (
        8,
        STRINGS.replace("ab", ""),
        "strings, number 1, has no dots, and nothing can be felt of it; …",
    ),
    (8, STRINGS.replace("cd", "c!"), "strings, number 2: '!' is no cell; …"),
    (8, STRINGS.replace('["ab", "cd"]', '"ab"'), "strings is 'ab'; it must be a list, in brackets"),
    (
        8,
        STRINGS.replace('"cd"', "3"),
        "strings, number 2, is 3; it must be a string, in quotation…",
    ),
    (9, STRINGS + "reorder = 1", "reorder is 1; it must be true or false"),
    (8, WIDTHS.replace("width_mm", "weight"), "parameter is 'dot_weight'; the nearest is…"),
    (9, WIDTHS.replace("[1, 2]", "[1]"), "values are 1; give two or more to compare"),
    (9, WIDTHS.replace("[1, 2]", "[1, 1.0]"), "values have 1 twice; leave one out"),
    (
        6,
        WIDTHS.replace("2]", "30]"),
        "at a value of 30 mm: dot width is 30 mm; it must…",
    ),
    (9, WIDTHS.replace("2]", "-1]"), "values: one is -1 mm; it must be 0 to 50 mm"),
    (9, WIDTHS.replace("2]", "nan]"), "values: one is nan mm; it must be 0 to 50 mm"),
    (10, WIDTHS.replace('"a"', '"⠀"'), "string has no dots; give one with some"),
    (
        10,
        WIDTHS.replace('"a"', '"1"'),
        "string: '1' has '1', which may be meant as dots or as…",
    ),
    (
        8,
        STRINGS.replace("ab", "le chat"),
        "strings, number 1: 'le chat' has a blank, which may be…",
    ),
    (8, STRINGS.replace("ab", " ab"), "strings, number 1: ' ab' has a blank, which may be meant…"),
    (8, STRINGS.replace("ab", "12 3"), "strings, number 1: '12 3' has '1', which may be meant as…"),
    (
        8,
        STRINGS.replace("ab", "1-4"),
        "strings, number 1: '1-4' has '1', which may be meant as dots…",
    ),
    (
        8,
        STRINGS.replace("ab", "a-b"),
        "strings, number 1: 'a-b' has '-', which may be meant as dots…",
    ),
    (
        10,
        PAIRS + 'before = "c c"',
        "before: 'c c' has a blank, which may be meant as a cell or as…",
    ),
    (
        10,
        PAIRS + 'after = "14"',
        "after: '14' has '1', which may be meant as dots or as what it is; …",
    ),
    (
        7,
        '[design]\nkind = "pairs"\nwords = 3\nstrings = ["ab"]',
        "kind is 'pairs'; there is choice, combinations, items, list",
    ),
    (7, "[design]\nkind = 3\nwords = 3", "kind is 3; it must be a string, in quotation marks"),
    (10, GAPS.replace('"c"', '"a"'), "string has no cell with a gap; give one with a left and…"),
]
BAD_REST = [
    (
        12,
        '[[conditions]]\nname = "a"\n' * 2,
        "[[conditions]] number 2 name is 'a' again; give each its own",
    ),
    (9, "[[conditions]]\ntexture = 1", "[[conditions]] number 1 lacks name; add it"),
    (9, "[conditions]", "[conditions] must be tables; write each under [[conditions]]"),
    (10, '[[conditions]]\nname = "a b"', "[[conditions]] number 1 name is 'a b'; it must be…"),
    (11, '[[conditions]]\nname = "a"\nhue = 1', "[[conditions]] number 1 has no key 'hue'; the…"),
    (10, "[rules]\neach_letter = 0", "[rules] each_letter is 0; it must be 1 to 10000"),
    (10, "[practice]\ntrials = -1", "[practice] trials is -1; it must be 0 to 10000"),
    (
        9,
        "[practice]\ntrials = 5\n",
        "[practice] has no items of its own, and those of the test would be given away; give "
        "strings that the test does not have, or trials = 0",
    ),
    (
        11,
        '[practice]\ntrials = 5\nstrings = ["ccc", "ca"]',
        "[practice] strings have ⠉⠁, which the test shows; give another",
    ),
    (
        11,
        '[practice]\ntrials = 5\nstrings = ["⠀"]',
        "[practice] strings have one without dots, and nothing can be felt of it",
    ),
    (9, '[practice]\nstrings = ["b"]', "[practice] has the cell ⠃ (dots 1 and 2), and the VBD's…"),
    (
        9,
        f'[practice]\nstrings = ["{"c" * 28}"]',
        "[practice] has a line of 29 cells, lead_cells among them, and the VBD has room…",
    ),
    (
        10,
        '[practice]\nstrings = ["c c"]',
        "[practice] strings, number 1: 'c c' has a blank, which may be…",
    ),
    (
        10,
        "[practice]\nvalues = [1]",
        "[practice] values are not of this kind of design; give strings instead",
    ),
    (
        10,
        "[rules]\nnever_twice_running = 1",
        "[rules] never_twice_running is 1; it must be true or…",
    ),
    (
        6,
        '[practice]\ntrials = 9999\nstrings = ["ccc"]',
        "[design] makes a session of more than 10000 trials; make it…",
    ),
    (10, "[trial]\ngap_s = -1", "[trial] gap_s is -1 s; it must be 0 to 60 s"),
    (10, "[trial]\nwarning_s = 0", "[trial] warning_s is 0 s; it must be 1 to 3600 s"),
    (10, "[session]\nlimit_s = 0", "[session] limit_s is 0 s; it must be 1 to 86400 s"),
    (10, "[session]\nblind = 0", "[session] blind is 0; it must be true or false"),
    (10, '[session]\nblind = "no"', "[session] blind is 'no'; it must be true or false"),
    (10, "[session]\nblnd = true", "[session] has no key 'blnd'; the nearest is blind, and…"),
    (10, "[session]\nbreak_every = 0", "[session] break_every is 0; it must be 1 to 10000"),
    (10, "[faults]\nrepeat = 1", "[faults] repeat is 1; it must be true or false"),
    (10, "[sound]\ncue = [880]", "[sound] cue has 1 items; give 2: frequency_hz, duration_ms"),
    (10, "[sound]\ncue = [5, 100]", "[sound] cue: frequency is 5 Hz; it must be 20 to 20000 Hz"),
    (9, '[[fields]]\nname = "f"', "[[fields]] number 1 lacks ask; add it"),
    (
        12,
        '[[fields]]\nname = "f"\nask = "F"\nchoices = ["x", "x"]',
        "[[fields]] number 1 choices have 'x' twice; leave one out",
    ),
    (
        13,
        '[[fields]]\nname = "f"\nask = "F"\n' * 2,
        "[[fields]] number 2 name is 'f' again; give each…",
    ),
]


class TestErrors:
    @pytest.mark.parametrize(("line", "text", "says"), BAD_HEADS)
    def test_heads(self, line, text, says):
        refuse(text, line, says)

    @pytest.mark.parametrize(("head", "line", "says"), BAD_DISPLAYS)
    def test_displays(self, head, line, says):
        refuse(f"{head}[display]\n{line}\n{PAIRS}", 7, f": [display] {says}")

    @pytest.mark.parametrize(("line", "says"), BAD_KEYS)
    def test_keys(self, line, says):
        refuse(f"{VBD_HEAD}[keys]\n{line}\n{PAIRS}", 7, f": [keys] {says}")

    @pytest.mark.parametrize(("line", "design", "says"), BAD_DESIGNS)
    def test_designs(self, line, design, says):
        refuse(VBD_HEAD + design, line, f": [design] {says}")

    @pytest.mark.parametrize(("line", "rest", "says"), BAD_REST)
    def test_the_rest(self, line, rest, says):
        strings = STRINGS.replace("ab", "ac").replace("cd", "ca")
        refuse(f"{VBD_HEAD}{strings}{rest}", line, f": {says}")

    @pytest.mark.parametrize(
        ("rule", "says"),
        [
            ("each_letter = 2", "a is shown once; each_letter is 2"),
            ("each_letter_at_least = 1", "b is shown 0 times; each_letter_at_least is 1"),
        ],
    )
    def test_rules_that_the_strings_cannot_keep(self, rule, says):
        text = f"{VBD_HEAD}{STRINGS.replace('ab', 'ac').replace('cd', 'c')}[rules]\n{rule}"
        refuse(text, 9, f": [rules] {says}; change the strings or the rule")

    def test_a_cell_with_dots_that_six_dot_braille_has_not(self):
        text = STRESS2_HEAD + STRINGS.replace("ab", "⢀")
        says = "⢀ (dot 8), and the STReSS² with the mapping alternate shows dots …"
        refuse(text, 6, f": [design] has the cell {says} only; leave the cell out")
