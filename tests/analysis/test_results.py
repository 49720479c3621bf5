"""Tables: what is printed, what is written, what a table may not hold."""

import csv
import io
from fractions import Fraction

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.analysis.making import all_tables, from_rows, made, table_of
from tests.tiers import by_tier
from vbraille.analysis.input.parsing import parse
from vbraille.analysis.input.trials import Places
from vbraille.analysis.results import (
    NOTE_COLUMN,
    Column,
    Kind,
    Schema,
    round_half_up,
    to_csv,
    to_print,
)

WHO = Column("who", "who", "")
SHARE = Column("share", "share (%)", "", Kind.PERCENT)
MATRIX = (
    Column("presented", "presented", ""),
    *(Column(f"answered {name}", name, "", Kind.COUNT) for name in ("a", "b", "?")),
)


@pytest.mark.parametrize(
    ("value", "kind", "text"),
    [
        (0.8625, Kind.PERCENT, "86.3"),
        (0.6625, Kind.PERCENT, "66.3"),
        (0.7125, Kind.PERCENT, "71.3"),
        (0.975, Kind.PERCENT, "97.5"),
        (1.0, Kind.PERCENT, "100.0"),
        (0.84449999, Kind.PERCENT, "84.4"),
        ((4.6 + 10.8 + 10.5 + 9.1) / 4, Kind.TENTHS, "8.8"),
        (24.25, Kind.TENTHS, "24.3"),
        (0.0005, Kind.NUMBER, "0.001"),
        (-1.7455, Kind.NUMBER, "−1.746"),
        (-0.0004, Kind.NUMBER, "0.000"),
        (1e40, Kind.NUMBER, f"1{40 * '0'}.000"),
        (0.0005, Kind.P, "< 0.001"),
        (0.0065, Kind.P, "0.007"),
        (1.0, Kind.P, "1.000"),
        (80, Kind.COUNT, "80"),
        (1.5, Kind.VALUE, "1.5"),
        (2.0, Kind.VALUE, "2"),
        ("S1", Kind.TEXT, "S1"),
        (None, Kind.PERCENT, "not known"),
    ],
)
def test_what_is_printed(value, kind, text):
    assert to_print(value, kind) == text


@given(st.integers(1, 400).flatmap(lambda n: st.tuples(st.integers(0, n), st.just(n))))
def test_every_share_is_rounded_half_up_as_on_paper(share):
    correct, trials = share
    tenths = (Fraction(1000 * correct, trials) + Fraction(1, 2)).__floor__()
    assert round_half_up(100 * (correct / trials), 1) == f"{tenths // 10}.{tenths % 10}"


def test_a_csv_has_full_precision_and_nothing_where_nothing_is_known():
    rows = (("S1, S2", 0.8625, ""), ('"S3"', 1 / 3, ""), ("S4", None, "no trials"))
    text = to_csv(table_of((WHO, SHARE, NOTE_COLUMN), rows).frame)
    assert text.startswith('who,share,note\n"S1, S2",0.8625,\n')
    read = list(csv.reader(io.StringIO(text)))
    assert [row[0] for row in read[1:]] == [row[0] for row in rows]
    assert float(read[2][1]) == 1 / 3
    assert read[3] == ["S4", "", "no trials"]


def test_no_text_of_a_csv_is_a_formula():
    rows = (("=HYPERLINK(1)", 0.5, "+1 dB"), ("S2", -0.5, "-"))
    text = to_csv(table_of((WHO, SHARE, NOTE_COLUMN), rows).frame)
    assert text.splitlines()[1:] == ["'=HYPERLINK(1),0.5,'+1 dB", "S2,-0.5,-"]


@pytest.mark.parametrize(
    ("columns", "rows", "reason"),
    [
        ((WHO, SHARE), (("S1", float("nan")),), "not finite"),
        ((WHO, SHARE), (("S1", float("inf")),), "not finite"),
        ((WHO, SHARE), (("S1", None),), "misses a value without a word"),
        ((WHO, SHARE, NOTE_COLUMN), (("S1", None, ""),), "misses a value without a word"),
        ((WHO, SHARE), (), "no rows, and no note"),
    ],
)
def test_what_is_no_table(columns, rows, reason):
    with pytest.raises(ValueError, match=reason):
        table_of(columns, rows)


def test_a_table_is_filled_by_names():
    schema = Schema("t", "Title", "About", (WHO, SHARE, NOTE_COLUMN), "more")
    more = Column("days", "days", "", Kind.COUNT)
    table = schema.fill(
        [{"days": 3, "who": "S1", "share": 0.5}, {"who": "S2", "days": 4, "note": "none"}],
        ["of two"],
        [more],
    )
    assert (table.name, table.title, table.schema.about) == ("t", "Title", "About")
    assert list(table.frame) == ["who", "share", "note", "days"]
    assert [str(kind) for kind in table.frame.dtypes] == ["str", "float64", "str", "Int64"]
    assert table.rows == (("S1", 0.5, "", 3), ("S2", None, "none", 4))
    assert table.notes == ("of two",)
    assert table.records()[0] == {"who": "S1", "share": 0.5, "note": "", "days": 3}
    with pytest.raises(ValueError, match=r"no columns \{'wha'\}"):
        schema.fill([{"wha": "S1", "share": 0.5}])


def test_right_answers_of_a_matrix_are_known():
    table = table_of(MATRIX, (("a", 30, 4, 5), ("b", 10, 9, 0)), marks=(4, 9))
    first, second = table.rows
    assert [table.is_right(first, at) for at in range(4)] == [False, True, False, False]
    assert [table.is_right(second, at) for at in range(4)] == [False, False, True, False]


STRINGS = st.text("ac⠀⠈", min_size=1, max_size=3)
TRIALS = st.lists(
    st.fixed_dictionaries(
        {
            "participant": st.sampled_from(["P1", "P2", "P10"]),
            "condition": st.sampled_from(["T0", "T25"]),
            "presented": STRINGS | st.just("ac"),
            "answered": STRINGS | st.sampled_from(["ac", "??", "a?", "abc"]),
            "duration_s": st.sampled_from(["", "n/a", "0", "1.5", "1e-9", "1e9"])
            | st.floats(0, 60).map(str),
        }
    ),
    min_size=1,
    max_size=12,
)


@settings(max_examples=by_tier(4, 15, 750))  # each makes all tables
@given(TRIALS)
def test_of_any_trials_all_tables_are_made_and_what_is_missing_has_a_reason(rows):
    # Tables refuse what is not finite, and what is missing without a note.
    trials = parse([from_rows("s", rows)]).trials
    tables = all_tables(trials, Places.of(trials))
    assert all(len(to_csv(table.frame).splitlines()) == len(table.rows) + 1 for table in tables)


@pytest.mark.parametrize(
    "lines",
    [
        ["P1 T0 a a 1"],
        ["P1 T0 ac ?? -"],
        ["P1 T0 ac a 2", "P2 T0 ac acc 2"],
        ["P1 T0 ac ac 2", "P2 T0 ac ac 2", "P1 T25 ac ac 2", "P2 T25 ac ac 2"],
        ["P1 T0 ac cc 2", "P2 T0 ac cc 2", "P1 T25 ac cc 2", "P2 T25 ac cc 2"],
        ["P1 T0 ac ac 2", "P2 T0 ac cc 3", "P1 T25 ac ac 2"],
        ["P1 T0 ac ac 2", "P1 T25 ac cc 3"],
        ["P1 T0 ac ac 1e99", "P1 T25 ac cc 1e99", "P2 T0 ac ac 3e99", "P2 T25 ac cc 2e99"],
    ],
    ids=[
        "one trial", "nothing read", "other lengths", "all right", "all wrong",
        "without a condition", "one participant", "a slow hand",
    ],
)  # fmt: skip
def test_thin_trials_have_all_tables(lines):
    trials, places = made(*lines)
    for table in all_tables(trials, places):
        assert table.rows or table.notes
        for row in table.rows:
            assert all(to_print(v, c.kind) for v, c in zip(row, table.columns, strict=True) if v)
