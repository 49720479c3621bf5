"""Protocols: those that come with the program, and what is refused in one sentence."""

import copy
import subprocess
import sys

import pytest
import tomlkit

from tests.sessions.sittings import HEAD, MINI, WIDTHS
from vbraille.errors import InputError
from vbraille.sessions.planning.loading import FOLDER, load_protocol, shipped
from vbraille.sessions.planning.plan import length_s, make_plan, plan_lines
from vbraille.sessions.planning.questions import AnyQuestion

QUESTIONNAIRE = """
[[questionnaire]]
kind = "choice"
name = "sure"
when = "trial"
ask = "Sure?"
choices = ["yes", "no"]
right = "yes"
"""


def load(folder, text, **beside):
    path = folder / "mine.toml"
    path.write_text(text, "utf-8")
    for name, content in beside.items():
        data = content if isinstance(content, bytes) else content.encode()
        (folder / name.replace("_", ".")).write_bytes(data)
    return load_protocol(str(path))


@pytest.mark.parametrize("name", shipped())
def test_a_protocol_that_comes_with_the_program_is_planned_for_everybody(name):
    protocol = load_protocol(name)
    first, again = (make_plan(protocol, "P01", 1) for _ in range(2))
    assert first == again
    assert first != make_plan(protocol, "P01", 2)
    assert {"age", "sex", "onset"} <= {field.name for field in protocol.fields}
    assert length_s(protocol, first) > 0


def test_what_the_source_has_is_planned():
    assert load_protocol("letters").analysis.measure == "characters"
    lengths = [len(text) for text in load_protocol("letters").practice.strings]
    assert lengths == sorted(lengths)
    assert load_protocol("shapes").analysis.too_fast_s == 0.5


def test_a_length_counts_what_is_felt():
    protocol = load_protocol("shapes")
    assert length_s(protocol, make_plan(protocol, "P01", 1)) > 144 * 20
    assert any("up to 20 s" in line for line in plan_lines(protocol, make_plan(protocol, "P01", 1)))


def test_comments_name_all_kinds_of_question():
    kinds = {each.__struct_config__.tag for each in AnyQuestion.__args__}
    for name in ("detection", "rating", "same-different"):
        text = (FOLDER / f"{name}.toml").read_text()
        assert all(f'"{kind}"' in text for kind in kinds)


REFUSED = {
    "unknown key": (MINI.replace("strings", "stringz"), 6, "strings"),
    "unknown model": (MINI.replace('"vbd"', '"vdb"'), 3, "vbd"),
    "not of the display": (MINI + "[display]\nmapping = 'alternate'\n", 8, "dot_row"),
    "spelling": (MINI.replace('"ca"', '"c1"'), 6, "c1"),
    "too long": (MINI.replace('"ca"', f'"{"ca" * 90}"'), 4, "room"),
    "hidden dots": (MINI.replace('"ca"', '"cq"'), 4, "dots"),
    "twice": (MINI + "[[conditions]]\nname = 'x'\n" * 2, 10, "x"),
    "order": (MINI + "blocks = 2\norder = 'balanced'\n", 8, "blocks"),
    "rule": (MINI + "[rules]\nat_most_running = { colour = 2 }\n", 8, "colour"),
    "letters": (MINI + "[rules]\neach_letter = 1\n", 8, "a is shown"),
    "nothing to practise": (MINI + "[practice]\ntrials = 1\n", 7, "practice"),
    "question": (MINI + "[question]\nkind = 'which'\n", 8, "which"),
    "two right": (WIDTHS + "reference = 1.0\n", 9, "reference"),
    "measure": (MINI + "[analysis]\nmeasure = 'preferred'\n", 8, "identify"),
    "factors": (MINI + "[analysis]\nfactors = ['size']\n", 8, "size"),
    "codes": (MINI + "[markers]\ncodes = { other = 60 }\n", 8, "other"),
    "columns": (
        MINI + QUESTIONNAIRE + QUESTIONNAIRE.replace("sure", "sure_correct").replace("right", "#"),
        18, "sure_correct",
    ),
    "gap": (MINI + "[trial]\ngap_s = [0.5]\n", 8, "gap_s"),
    "criterion": (
        MINI + "[practice]\nstrings = ['c']\nuntil = { right = 3, of = 2, most = 9 }\n", 9, "of",
    ),
    "unknown procedure": (MINI + "[procedure]\nkind = 'x'\n", 8, "known: quest, staircase"),
    "procedure": (MINI + "[procedure]\nkind = 'quest'\nspread = [1.0]\n", 7, "parameter"),
}  # fmt: skip


@pytest.mark.parametrize("what", REFUSED)
def test_what_cannot_be_used_is_refused_with_its_line(what, tmp_path):
    text, line, named = REFUSED[what]
    with pytest.raises(InputError, match=named) as refused:
        load(tmp_path, text)
    assert f"mine.toml line {line}: " in str(refused.value)
    assert "\n" not in str(refused.value)


def test_a_missing_protocol_is_named_beside_the_nearest():
    with pytest.raises(InputError, match="letters"):
        load_protocol("leters")


def test_every_key_with_a_value_of_any_type_is_taken_or_refused(tmp_path):
    """In a process of its own: msgspec has died of a number beside a tuple of a fixed length."""
    done = subprocess.run(
        [sys.executable, "-c", f"import {__name__} as t; t.try_all({str(tmp_path)!r})"],
        check=False, capture_output=True, text=True, timeout=120,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr[-2000:]
    assert int(done.stdout) > 500


def try_all(folder):
    """Put values of all types in place of each value of three protocols."""
    wrong = ["text", 7, 2.5, True, [1, 2], ["a"], {"a": 1}, [], -1, 10**12]
    tried = 0
    for name in ("letters", "tuning-width-adaptive", "factors"):
        tree = tomlkit.parse((FOLDER / f"{name}.toml").read_text()).unwrap()
        tree["trial"]["gap_s"] = [0.1, 0.2]
        for table, key in leaves(tree):
            kept = table[key]
            for value in wrong:
                table[key] = copy.deepcopy(value)
                try_one(folder, tomlkit.dumps(tree))
                tried += 1
            table[key] = kept
    print(tried)


def try_one(folder, text):
    path = f"{folder}/tried.toml"
    with open(path, "w", encoding="utf-8") as file:  # noqa: PTH123
        file.write(text)
    try:
        load_protocol(path)
    except InputError as error:
        assert "\n" not in str(error)  # noqa: PT017


def leaves(tree):
    """Go through the places of all values that hold no tables."""
    for key, value in list(tree.items()):
        inner = value if isinstance(value, list) else [value]
        tables = [each for each in inner if isinstance(each, dict)]
        for table in tables:
            yield from leaves(table)
        if not tables:
            yield tree, key


TEXTS = f"""{HEAD.replace("vbd", "stress2")}[display]
table = "en-ueb-g1.ctb"
[design]
kind = "items"
repeats = 2
[items]
file = "items.csv"
"""


@pytest.mark.parametrize(
    "content",
    [
        "string;kind;freq\nStraße;Wort;1,5\nÄpfel;Wort;2,5\n",
        "string;kind;freq\nStraße;Wort;1,5\nÄpfel;Wort;2,5\n".encode("cp1252"),
        "sep=;\nstring;kind;freq\nStraße;Wort;1,5\nA\u0308pfel;Wort;2,5\n",
    ],
)
def test_a_file_of_items_is_read_as_every_table_is(content, tmp_path):
    protocol = load(tmp_path, TEXTS.replace("en-ueb-g1.ctb", "de-g0.utb"), items_csv=content)
    assert protocol.items_shown == ["Straße", "Äpfel"]
    assert protocol.columns["Äpfel"] == {"kind": "Wort", "freq": "2,5"}


def test_a_line_break_in_an_item_is_a_blank_and_an_item_is_there_once(tmp_path):
    protocol = load(tmp_path, TEXTS, items_csv='string,kind\n"tree\nhouse",w\n')
    assert protocol.items_shown == ["tree house"]
    with pytest.raises(InputError, match=r"items\.csv line 3"):
        load(tmp_path, TEXTS, items_csv="string\ntree\ntree\n")
    with pytest.raises(InputError, match="no column 'string'"):
        load(tmp_path, TEXTS, items_csv="strings\ntree\n")


def test_all_lines_of_a_passage_are_planned(tmp_path):
    text = TEXTS.replace('"items"', '"list"').replace('[items]\nfile = "items.csv"\n', "")
    text = text.replace(
        "repeats = 2", 'passage = true\nstrings = ["The ferry leaves the harbour at seven."]'
    )
    protocol = load(tmp_path, text)
    (trial,) = make_plan(protocol, "P01", 1).trials
    assert len(trial.stimuli) > 1
    assert protocol.asks.kind == "read" or trial.cells
    (line,) = [line for line in plan_lines(protocol, make_plan(protocol, "P01", 1)) if "⠓" in line]
    assert all(stimulus.cells in line for stimulus in trial.stimuli)
