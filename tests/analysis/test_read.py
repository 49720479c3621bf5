"""Tables as people have them: who is who, what is missing, what is there twice."""

import csv

import pytest

from tests.analysis.making import CASES, analysed, to_csv, trials_of
from vbraille.analysis import analyse
from vbraille.errors import InputError

ROWS = trials_of({"A": [20, 22, 25], "B": [17, 21, 22]})


def values(analysis):
    return analysis.result.pairs[["value", "t", "p"]].to_numpy().tolist()


def renamed(rows, **names):
    """Rows in which the first person has another name in condition B."""
    return [
        row | {name: value for name, value in names.items() if row["condition"] == "B"
               and row["participant"] == "P01"} for row in rows
    ]  # fmt: skip


@pytest.mark.parametrize("name", ["p01", "P1", "P-01", "P 1", "P01.0", "Ｐ01"])
def test_two_spellings_of_a_person_are_refused(name, tmp_path):
    with pytest.raises(InputError, match="P01"):
        analysed(renamed(ROWS, participant=name), tmp_path)


@pytest.mark.parametrize("name", ["P01\u200b", "P\ufe0f01"])
def test_marks_that_are_not_seen_make_no_other_person(name, tmp_path):
    analysis = analysed(renamed(ROWS, participant=name), tmp_path)
    assert values(analysis) == values(analysed(ROWS, tmp_path))
    assert any("P01" in note for note in analysis.notes)


def test_composed_and_decomposed_names_are_one_person():
    assert analyse([CASES / "F33-nfc-nfd.csv"]).result.pairs["participants"].to_list() == [6]


@pytest.mark.parametrize("file", ["F34-case.csv"])
def test_case_is_refused(file):
    with pytest.raises(InputError, match="p001"):
        analyse([CASES / file])


def test_people_of_two_tables_are_compared():
    with pytest.raises(InputError, match="'001' and '1'"):
        analyse([CASES / "F32-zeros-a.csv", CASES / "F32-zeros-b.csv"])


@pytest.mark.parametrize("name", ["b", "B\u200b ", "B "])
def test_conditions_are_spelled_alike(name, tmp_path):
    rows = [row | ({"condition": name} if n % 7 == 3 and row["condition"] == "B" else {})
            for n, row in enumerate(ROWS)]  # fmt: skip
    if name == "b":
        with pytest.raises(InputError, match="condition"):
            analysed(rows, tmp_path)
    else:
        assert values(analysed(rows, tmp_path)) == values(analysed(ROWS, tmp_path))


def test_decimals_of_conditions_are_not_joined(tmp_path):
    rows = [row | {"condition": {"A": "0.5", "B": "0.05"}[row["condition"]]} for row in ROWS]
    assert analysed(rows, tmp_path).result.means["cell"].to_list() == ["0.05", "0.5"]
    with pytest.raises(InputError, match="condition"):
        analysed([*renamed(rows), ROWS[0] | {"condition": "0,5"}], tmp_path)


def test_names_that_are_answered_differ_from_presented_by_more_than_case(tmp_path):
    rows = [
        {"participant": "P1", "question": "name", "presented": shown, "answered": answered}
        for shown, answered in (("circle", "Circle"), ("square", "circle"), ("Straße", "STRASSE"))
    ]
    assert analysed(rows, tmp_path).tables["names"]["right"].to_list() == [2]


@pytest.mark.parametrize("missing", ["NA", "NaN", "None", "n/a", "N/A", "NULL", "<NA>", ""])
def test_what_stands_for_nothing_is_no_answer(missing, tmp_path):
    rows = [*ROWS, *({**row, "answered": missing, "duration_s": missing} for row in ROWS[:30])]
    rows = [row | {"duration_s": row.get("duration_s", missing)} for row in rows]
    analysis = analysed(rows, tmp_path)
    assert values(analysis) == values(analysed(ROWS, tmp_path))
    assert sum("without an answer" in note for note in analysis.notes) == 2


@pytest.mark.parametrize("word", ["na", "nan", "none"])
def test_letters_that_look_like_nothing_are_answers(word, tmp_path):
    rows = [{"participant": "P1", "presented": word, "answered": word}]
    assert analysed(rows, tmp_path).tables["legibility"]["correct"].to_list() == [1]


@pytest.mark.parametrize("column", ["participant", "condition", "presented"])
def test_a_missing_name_is_refused(column, tmp_path):
    with pytest.raises(InputError, match=column):
        analysed([*ROWS, ROWS[0] | {column: "None"}], tmp_path)


def test_an_unquoted_na_of_r_is_no_answer():
    means = analyse([CASES / "F30-R-NA.csv"]).tables["legibility"]
    assert means["trials"].sum() == 129


def test_decimal_commas_are_read_in_every_column():
    comma = analyse([CASES / "F28-response-comma.csv"])
    point = analyse([CASES / "F28-response-point.csv"])
    assert comma.tables["names"].equals(point.tables["names"])
    assert comma.tables["names"]["taken_s"].notna().all()


@pytest.mark.parametrize(
    ("rows", "separator", "head"),
    [(ROWS, ";", ""), (ROWS, "\t", ""), (ROWS, ";", "sep=;\n"), (ROWS, ",", "\ufeff")],
)
def test_separators_and_marks(rows, separator, head, tmp_path):
    assert values(analysed(head + to_csv(rows, separator), tmp_path)) == values(
        analysed(rows, tmp_path)
    )


def test_a_first_line_that_names_the_separator():
    assert analyse([CASES / "F42-sep-line.csv"]).result.pairs["participants"].to_list() == [6]


def test_our_own_bids_table_is_read():
    assert analyse([CASES / "F41-own-bids_beh.tsv"]).tables["legibility"]["trials"].to_list() == [8]


def test_a_copy_is_refused():
    with pytest.raises(InputError, match="F37-table-copy"):
        analyse([CASES / "F37-table.csv", CASES / "F37-table-copy.csv"])


def _write(path, rows, separator=","):
    path.write_text(to_csv(rows, separator))
    return path


def test_copies_in_another_order_or_in_a_larger_table_are_refused(tmp_path):
    whole = _write(tmp_path / "all.csv", ROWS)
    for name, rows, separator in (
        ("turned.csv", ROWS[::-1], ","),
        ("p01.csv", [row for row in ROWS if row["participant"] == "P01"], ","),
        ("semicolons.csv", ROWS, ";"),
        ("wider.csv", [row | {"note": "x"} for row in ROWS], ","),
    ):
        with pytest.raises(InputError, match=name):
            analyse([whole, _write(tmp_path / name, rows, separator)])


def test_a_session_stands_in_one_table(tmp_path):
    rows = [row | {"session": f"{row['participant']}-1", "trial": n} for n, row in enumerate(ROWS)]
    others = [row | {"answered": "zz"} for row in rows]
    paths = [_write(tmp_path / "one.csv", rows), _write(tmp_path / "two.csv", others)]
    with pytest.raises(InputError, match="P01-1"):
        analyse(paths)


def test_a_numbered_trial_stands_once(tmp_path):
    rows = [row | {"trial": n} for n, row in enumerate(ROWS)]
    with pytest.raises(InputError, match="line 10"):
        analysed([*rows[:8], rows[3], *rows[8:]], tmp_path)


def test_tables_of_one_name_in_two_folders_are_two(tmp_path):
    for folder, person in (("x", "P1"), ("y", "P2")):
        (tmp_path / folder).mkdir()
        row = {"participant": person, "presented": "ab", "answered": "ab"}
        _write(tmp_path / folder / "trials.csv", [row] * 3)
    analysis = analyse([tmp_path / "x/trials.csv", tmp_path / "y/trials.csv"])
    assert analysis.tables["trials"]["session"].nunique() == 2
    with pytest.raises(InputError, match="twice"):
        analyse([tmp_path / "x/trials.csv", tmp_path / "x/../x/trials.csv"])


@pytest.mark.parametrize(
    ("changed", "named"),
    [
        ({"duration_s": "abc"}, "line 2"),
        ({"duration_s": "-1"}, "line 2"),
        ({"duration_s": "1e999"}, "line 2"),
        ({"question": "what"}, "'what'"),
        ({"question": "detect"}, "'ac'"),
        ({"question": "detect", "answered": "yes", "presented": "x"}, "'x'"),
        ({"question": "which", "outcome": "good"}, "'good'"),
        ({"question": "rating", "answered": "good"}, "'good'"),
        ({"question": "magnitude", "answered": "0"}, "above 0"),
        ({"condition": "nan"}, "condition"),
    ],
)
def test_cells_that_cannot_be_read_are_named(changed, named, tmp_path):
    rows = [ROWS[0] | {"answered": "ac"} | changed, *ROWS[1:3]]
    rows = [dict.fromkeys(rows[0], "") | row for row in rows]
    with pytest.raises(InputError, match=named):
        analysed(rows, tmp_path)


@pytest.mark.parametrize("column", ["participant", "presented", "answered"])
def test_a_missing_column_is_named(column, tmp_path):
    rows = [{name: row[name] for name in row if name != column} for row in ROWS]
    with pytest.raises(InputError, match=column):
        analysed(rows, tmp_path)


def test_people_are_left_out_with_a_reason_and_named(tmp_path):
    analysis = analysed(ROWS, tmp_path, exclude={"P02": "fell asleep"})
    assert analysis.left_out == ["P02: fell asleep"]
    assert analysis.result.means["participants"].to_list() == [2, 2]
    with pytest.raises(InputError, match="P9"):
        analysed(ROWS, tmp_path, exclude={"P9": "who"})


def test_practice_and_catch_trials_are_left_out(tmp_path):
    rows = [row | {"catch": "", "practice": "0"} for row in ROWS]
    extra = [row | {"catch": "repeat", "answered": "zz"} for row in rows[:5]]
    extra += [row | {"practice": "1", "answered": "zz"} for row in rows[:5]]
    analysis = analysed(rows + extra, tmp_path)
    assert values(analysis) == values(analysed(ROWS, tmp_path))
    assert len(analysis.notes) == 2


def test_a_simulated_reader_is_told_first(tmp_path):
    rows = [row | {"answers_from": "simulated:0.4"} for row in ROWS]
    assert "no data about people" in analysed(rows, tmp_path).warnings[0]


def test_choices_without_an_outcome_are_not_taken_for_wrong(tmp_path):
    rows = [{"participant": "P1", "question": "odd", "presented": "1 1 2", "answered": "2"}]
    with pytest.raises(InputError, match="outcome"):
        analysed(rows, tmp_path)


def test_known_columns_may_have_capitals(tmp_path):
    rows = [{name.capitalize(): value for name, value in row.items()} for row in ROWS]
    assert values(analysed(rows, tmp_path)) == values(analysed(ROWS, tmp_path))


def test_capitals_are_no_other_letters(tmp_path):
    rows = [{"participant": "P1", "presented": "ab", "answered": answered}
            for answered in ("AB", "Ab", "⠁⠃")]  # fmt: skip
    assert analysed(rows, tmp_path).tables["legibility"]["correct"].to_list() == [3]


def test_trials_of_the_report_are_those_of_the_file(tmp_path):
    analysed(ROWS, tmp_path).write(tmp_path / "report")
    with (tmp_path / "report/tables/trials.csv").open(encoding="utf-8") as file:
        assert len(list(csv.DictReader(file))) == len(ROWS)
