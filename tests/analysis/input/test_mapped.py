"""Trials of other programs, by a mapping file, against the same trials in our own columns."""

import csv
import json
import re
from pathlib import Path

import pytest

from tests.sessions.sittings import COMPARED, MINI, Session
from tests.tiers import heavy
from vbraille.analysis import analyse
from vbraille.analysis.input.mapped import read_mapped
from vbraille.analysis.input.mapping import load_mapping, parse_mapping
from vbraille.analysis.input.parsing import parse
from vbraille.analysis.input.sheets import read_csv
from vbraille.analysis.input.study import load_study
from vbraille.errors import InputError
from vbraille.sessions.record.export import rows

SAMPLES = Path(__file__).parents[3] / "docs" / "mappings"
PROGRAMS = ("psychopy", "opensesame", "jspsych")
BARE = """\
format = 1
[columns]
participant = { from = "who" }
condition = { always = "all" }
presented = { from = "shown" }
answered = { from = "typed" }
"""


def sample(program, experiment="letters"):
    return sorted(SAMPLES.glob(f"{program}-{experiment}-*"))


def mapped(tmp_path, text, table, name="theirs.csv"):
    path = tmp_path / name
    path.write_text(table, "utf-8")
    return read_mapped(path, parse_mapping(text, "mine.toml"))


@pytest.mark.parametrize("program", PROGRAMS)
def test_the_samples_are_the_trials_of_our_own_table(program):
    mapping = load_mapping(SAMPLES / f"{program}.toml")
    own = parse([read_csv(SAMPLES / "trials.csv")]).trials
    sheets = [read_mapped(path, mapping)[0] for path in sample(program)]
    theirs = parse(sheets).trials
    assert len(own) == 15
    assert theirs[list(own)].equals(own)


@pytest.mark.parametrize("program", PROGRAMS)
def test_questions_of_each_kind_are_those_of_our_own_table(program):
    mapping = load_mapping(SAMPLES / f"{program}-questions.toml")
    sheets = [read_mapped(path, mapping)[0] for path in sample(program, "questions")]
    own, theirs = parse([read_csv(SAMPLES / "questions.csv")]), parse(sheets)
    assert len(own.judgements) == 26
    assert len(own.comparisons) == 4
    assert theirs.comparisons.equals(own.comparisons)
    told = theirs.judgements
    # A rating of 6 is 6.0 there.
    numbers = told["question"].isin(("rating", "magnitude"))
    assert (told["answered"] == own.judgements["answered"]).where(~numbers, other=True).all()
    same = [name for name in own.judgements if name != "answered"]
    assert told[same].equals(own.judgements[same])


OWN = "participant,condition,question,presented,answered\n"


@pytest.mark.parametrize(
    ("row", "outcome"),
    [
        ("detect,yes,yes", "hit"),
        ("detect,yes,no", "miss"),
        ("detect,no,yes", "false alarm"),
        ("detect,no,no", "correct rejection"),
        ("same-different,different,different", "hit"),
        ("same-different,different,same", "miss"),
        ("same-different,same,different", "false alarm"),
        ("same-different,same,same", "correct rejection"),
    ],
)
def test_an_outcome_follows_from_what_was_presented_and_answered(tmp_path, row, outcome):
    path = tmp_path / "own.csv"
    path.write_text(f"{OWN}A,all,{row}\n")
    assert [*parse([read_csv(path)]).judgements["outcome"]] == [outcome]


@pytest.mark.parametrize(
    ("row", "said"),
    [
        ("detect,st,yes", "outcome is missing, and presented is 'st', which does not tell it"),
        ("detect,yes,y", "answered is 'y'; to the question 'detect' it must be yes or no"),
        ("same-different,0.5,same", "give outcome, or presented as different or same"),
    ],
)
def test_an_outcome_that_does_not_follow_is_asked_for(tmp_path, row, said):
    path = tmp_path / "own.csv"
    path.write_text(f"{OWN}A,all,detect,yes,yes\nA,all,{row}\n")
    with pytest.raises(InputError, match=re.escape(said)) as caught:
        parse([read_csv(path)])
    assert str(caught.value).startswith("own.csv line 3: ")


@heavy  # a whole analysis each
@pytest.mark.parametrize("program", PROGRAMS)
def test_the_tables_of_the_samples_are_those_of_our_own(program):
    theirs = analyse(sample(program), mapping=SAMPLES / f"{program}.toml").tables
    own = analyse(SAMPLES / "trials.csv").tables
    assert list(theirs) == list(own)
    assert all(theirs[name].equals(own[name]) for name in own)


def test_a_study_tells_the_mapping_and_what_it_left_out():
    study = load_study(sample("psychopy"), mapping=SAMPLES / "psychopy.toml")
    about = dict(study.about)
    assert about["Mapping psychopy.toml"].startswith("PsychoPy, wide CSV of Builder; SHA-256 ")
    told = [(left.what, left.reason) for left in study.left_out]
    assert ("4 rows of psychopy-letters-P01.csv", "practice, or no trial") in told


def test_a_mapping_needs_files_of_another_program(tmp_path):
    Session(tmp_path / "s").sit()
    with pytest.raises(InputError, match=r"psychopy.toml is for files of another program; give"):
        load_study([tmp_path / "s"], mapping=SAMPLES / "psychopy.toml")


@pytest.mark.parametrize("toml", [MINI, COMPARED], ids=["strings", "comparisons"])
def test_a_sessions_own_export_under_other_names_is_read_as_it_is(tmp_path, toml):
    table = rows(Session(tmp_path / "s", toml).sit().record)
    pair = toml == COMPARED
    theirs = [
        {
            "subject": row["participant"], "ms": round(row["response_s"] * 1000),
            "n": row["trial"] - 1, "cond": row["condition"],
            "first": row["presented"].split()[0], "second": row["presented"].split()[-1],
            "key": "left arrow" if row["answered"] == row["presented"].split()[0] else "right",
            "typed": row["answered"], "shown": row["presented"], "of": row["parameter"],
        }
        for row in table
    ]  # fmt: skip
    text = """\
format = 1
[columns]
participant = { from = "subject" }
session = { always = "s" }
trial = { from = "n", plus = 1 }
block = { always = 1 }
condition = { from = "cond" }
response_s = { from = "ms", times = 0.001 }
""" + (
        """\
parameter = { from = "of" }
presented = { from = ["first", "second"] }
answered = { from = "key", pick = { "left arrow" = "first", right = "second" } }
"""
        if pair
        else 'presented = { from = "shown" }\nanswered = { from = "typed" }\n'
    )
    path = tmp_path / "theirs.json"
    path.write_text(json.dumps(theirs))
    sheet, left_out = read_mapped(path, parse_mapping(text, "mine.toml"))
    assert not left_out
    assert [float(value) for value in sheet.frame["response_s"]] == [
        round(row["response_s"], 3) for row in table
    ]
    own = tmp_path / "own.csv"
    with own.open("w", newline="") as file:
        writer = csv.DictWriter(file, list(table[0]))
        writer.writeheader()
        writer.writerows(table)
    names = ["participant", "session", "condition", "block", "trial"]
    names += ["first", "second", "chosen", "parameter"] if pair else ["presented", "answered"]
    which = "comparisons" if pair else "trials"
    ours, read = (getattr(parse([table]), which) for table in (read_csv(own), sheet))
    assert len(ours) == len(table)
    assert read[names].equals(ours[names])


def test_values_are_joined_matched_keyed_and_replaced(tmp_path):
    text = BARE.replace('{ from = "shown" }', '{ from = "html", pattern = "<p>(.*)</p>" }')
    text = text.replace('{ from = "typed" }', '{ from = "told", key = "Q0", missing = ["none"] }')
    text += 'note = { from = ["who", "n"] }\n'
    text += 'hand = { from = "hand", replace = { l = "left", "2" = 7 } }\n'
    table = (
        'who,html,told,n,hand\nA,<p>ab</p>,"{""Q0"": ""ab""}",1,l\n'
        'B,plain,"{""Q0"": ""none""}",2,2\nC,<p></p>,"{""Q0"": 3}",3,r\n'
    )
    frame = mapped(tmp_path, text, table)[0].frame
    assert frame["presented"].tolist() == ["ab", "", ""]
    assert frame["answered"].tolist() == ["ab", "", "3"]
    assert frame["note"].tolist() == ["A 1", "B 2", "C 3"]
    assert frame["hand"].tolist() == ["left", "7", "r"]
    assert list(frame.index) == [2, 3, 4]


def test_numbers_are_changed_in_decimals(tmp_path):
    text = BARE + 'duration_s = { from = "ms", times = 0.001 }\nt = { from = "ms", plus = -1 }\n'
    frame = mapped(tmp_path, text, "who,shown,typed,ms\nA,a,a,1001\nA,a,a,\nA,a,a,7.0\n")[0].frame
    assert frame["duration_s"].tolist() == ["1.001", "", "0.007"]
    assert frame["t"].tolist() == ["1000", "", "6"]


def test_a_number_of_the_mapping_keeps_all_its_digits(tmp_path):
    text = BARE + "contrast = { always = 0.12345678 }\ntime = { always = 1234567.5 }\n"
    text += 'block = { from = "shown", replace = { a = 1.0 } }\n'
    frame = mapped(tmp_path, text, "who,shown,typed\nA,a,a\n")[0].frame
    told = frame[["contrast", "time", "block"]].values.tolist()
    assert told == [["0.12345678", "1234567.5", "1"]]


def test_blanks_around_a_name_in_json_lose_no_value(tmp_path):
    table = json.dumps([{"who": "A", " shown": "a", "typed ": "b"}])
    frame = mapped(tmp_path, BARE, table, "theirs.json")[0].frame
    assert frame[["presented", "answered"]].values.tolist() == [["a", "b"]]


def test_a_number_too_large_to_be_changed_is_refused(tmp_path):
    text = BARE + 'duration_s = { from = "ms", times = 1000 }\n'
    with pytest.raises(InputError, match="no number that times or plus could change"):
        mapped(tmp_path, text, "who,shown,typed,ms\nA,a,a,1e999999\n")


def test_rows_stay_that_alone_are_wanted(tmp_path):
    text = BARE + '[[leave_out]]\ncolumn = "loop"\nis_not = ["main", 2]\nreason = "practice"\n'
    table = "who,shown,typed,loop\nA,a,a,main\nA,b,b,warm\nA,c,c,2\n"
    sheet, left_out = mapped(tmp_path, text, table)
    assert sheet.frame["presented"].tolist() == ["a", "c"]
    assert [(left.what, left.reason) for left in left_out] == [("1 row of theirs.csv", "practice")]


def test_a_form_that_the_file_does_not_tell_is_given(tmp_path):
    text = BARE + '[file]\nencoding = "cp1252"\ndelimiter = "semicolon"\nescape = "\\\\"\n'
    path = tmp_path / "theirs.csv"
    path.write_bytes('who;shown;typed;note\nZoë;a;a;"a \\"b\\"; c"\n'.encode("cp1252"))
    mapping = parse_mapping(text + '[columns.said]\nfrom = "note"\n', "mine.toml")
    frame = read_mapped(path, mapping)[0].frame
    assert frame[["participant", "said"]].values.tolist() == [["Zoë", 'a "b"; c']]


def test_an_older_psychopys_comma_at_each_lines_end_is_no_column(tmp_path):
    frame = mapped(tmp_path, BARE, "who,shown,typed,\nA,a,a,\n")[0].frame
    assert list(frame) == ["participant", "condition", "presented", "answered"]


def test_json_may_have_a_list_a_line(tmp_path):
    row = {"who": "A", "shown": "a", "typed": None}
    table = f"{json.dumps([row])}\n{json.dumps([row, row])}\n"
    sheet, _ = mapped(tmp_path, BARE, table, "theirs.json")
    assert sheet.frame["answered"].tolist() == ["", "", ""]
    assert sheet.place(sheet.frame.index[2]) == "theirs.json item 3"


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (("typed", "type"), "theirs.csv has no column 'type', which mine.toml line 6 names for "
         "answered; the nearest is typed"),
        (('{ from = "typed" }', '{ from = "typed", key = "Q0" }'),
         "theirs.csv line 2: answered is 'a', which is no object of JSON to take 'Q0' from"),
        (('{ from = "typed" }', '{ from = "typed", times = 2 }'),
         "theirs.csv line 2: answered is 'a', and no number that times or plus could change"),
        (('{ from = "typed" }', '{ from = "typed", pick = { a = "tap" } }'),
         "theirs.csv has no column 'tap', which mine.toml line 6 names for answered; the nearest"),
    ],
)  # fmt: skip
def test_a_table_that_does_not_fit_is_refused_in_a_sentence(tmp_path, change, said):
    with pytest.raises(InputError) as refused:
        mapped(tmp_path, BARE.replace(*change), "who,shown,typed\nA,a,a\n")
    assert str(refused.value).startswith(said)


@pytest.mark.parametrize(
    ("table", "said"),
    [("{", "theirs.json is no JSON: "), ("[]", "theirs.json must be a list of objects, one for "
     "each trial; it is empty"), ("[{}, 3]", "its item 2 is none")],
)  # fmt: skip
def test_json_that_is_no_table_is_refused(tmp_path, table, said):
    with pytest.raises(InputError, match=said):
        mapped(tmp_path, BARE, table, "theirs.json")


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (('answered = { from = "typed" }\n', ""),
         r"mine.toml line 2: \[columns\] lacks answered; say where"),
        (('{ from = "typed" }', '"typed"'), r"mine.toml line 6: \[columns\] answered must be a "
         r"table, such as \{ from = "),
        (('from = "typed"', 'form = "typed"'), "mine.toml line 6: .* has no key 'form'; the "
         "nearest is from"),
        (('from = "typed"', "from = []"), "line 6.*from names no column; name one"),
        (('from = "typed"', 'from = "typed", always = 1'), "needs either from, a column, or"),
        (('always = "all"', 'always = "all", times = 2'), "line 4.*times changes a column's"),
        (('from = "typed"', 'from = "typed", pattern = "a"'), "line 6.*has 0 groups; put one"),
        (('from = "typed"', 'from = "typed", pattern = "("'), "line 6.*no regular expression"),
        (('from = "typed"', 'from = ["a", "b"], key = "c"'), "key is of one column; name one"),
        (('from = "typed"', 'from = "t", pick = { a = "x" }, replace = { a = 1 }'),
         "line 6.*replaces 'a' and picks a column for it"),
        (("[columns]", '[file]\nencoding = "utf-9"\n[columns]'), "line 3.*encoding is 'utf-9'"),
        (("[columns]", '[file]\nkind = "json"\ndelimiter = "tab"\n[columns]'),
         "line 4.*delimiter is of CSV files"),
        (("[columns]", '[[leave_out]]\ncolumn = "x"\nreason = "y"\n[columns]'),
         r"line 2: \[\[leave_out\]\] number 1 needs either is, or is_not"),
        (("[columns]", '[[leave_out]]\ncolumn = "x"\nis = [1]\nreason = " "\n[columns]'),
         "line 5.*reason is empty"),
        (("format = 1", "format = 2"), "line 1.*format is 2"),
    ],
)  # fmt: skip
def test_a_mapping_that_is_none_is_refused_with_its_line(change, said):
    assert change[0] in BARE
    with pytest.raises(InputError, match=said):
        parse_mapping(BARE.replace(*change), "mine.toml")
