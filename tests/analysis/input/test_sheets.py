"""CSV files as people have them, to columns of text."""

import pandas as pd
import pytest

from vbraille.analysis.input.sheets import Sheet, read_csv
from vbraille.errors import InputError
from vbraille.sessions.record.export import frame_of

COLUMNS = {"participant": ["P1", "P2"], "condition": ["é", "T0"], "answered": ["a", "b"]}


def written(folder, text, encoding="utf-8"):
    path = folder / "t.csv"
    path.write_bytes(text if isinstance(text, bytes) else text.encode(encoding))
    return path


def table(delimiter=",", end="\n"):
    rows = [("participant", "condition", "answered"), ("P1", "é", "a"), ("P2", "T0", "b")]
    return "".join(delimiter.join(row) + end for row in rows)


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "utf-16-be", "cp1252"])
@pytest.mark.parametrize("delimiter", [",", ";", "\t"])
def test_a_file_is_read_in_every_encoding_with_every_delimiter(tmp_path, encoding, delimiter):
    mark = "\ufeff" if encoding == "utf-16-be" else ""
    sheet = read_csv(written(tmp_path, mark + table(delimiter), encoding))
    assert sheet.frame.to_dict("list") == COLUMNS
    assert sheet.decimal_comma == (delimiter == ";")
    assert (sheet.name, len(sheet), sheet.frame.index.tolist()) == ("t.csv", 2, [2, 3])


@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
def test_lines_end_in_every_way(tmp_path, end):
    assert read_csv(written(tmp_path, table(end=end))).frame.to_dict("list") == COLUMNS


def test_blank_lines_are_none_and_lines_keep_their_numbers(tmp_path):
    head, first, second = table(";").splitlines()
    text = "\n".join(["", " ", head, "", first, ";;", "  ", second, "", ""])
    sheet = read_csv(written(tmp_path, text))
    assert sheet.frame.to_dict("list") == COLUMNS
    assert sheet.frame.index.tolist() == [5, 8]
    assert sheet.place(8) == "t.csv line 8"


def test_values_may_have_the_delimiter_in_quotes_and_names_spaces_around(tmp_path):
    sheet = read_csv(written(tmp_path, 'participant , note\nP1,"a, ""b"""\n'))
    assert sheet.frame.to_dict("list") == {"participant": ["P1"], "note": ['a, "b"']}


def test_a_table_of_names_alone_has_no_rows(tmp_path):
    sheet = read_csv(written(tmp_path, "participant,condition\n"))
    assert (len(sheet), list(sheet.frame)) == (0, ["participant", "condition"])


def test_the_comma_is_a_decimal_point_beside_semicolons_only():
    assert Sheet("t", pd.DataFrame(), decimal_comma=True).number("4,5") == 4.5
    assert Sheet("t", pd.DataFrame(), decimal_comma=True).number("4.5") == 4.5
    with pytest.raises(ValueError, match="4,5"):
        Sheet("t", pd.DataFrame()).number("4,5")


def test_rows_of_a_session_have_types_and_nothing_of_them_is_read_again():
    rows = [{"participant": "P1", "block": 1, "trial": n, "duration_s": d, "paused_s": 0.0}
            for n, d in ((1, 2.5), (2, ""))]  # fmt: skip
    frame = frame_of(rows)
    assert [str(kind) for kind in frame.dtypes[1:4]] == ["int64", "int64", "float64"]
    assert frame["duration_s"].isna().tolist() == [False, True]
    sheet = Sheet("P01", frame, typed=True)
    assert [sheet.place(row) for row in sheet.frame.index] == ["P01 row 1", "P01 row 2"]
    assert len(frame_of([])) == 0


def test_missing_columns_are_named_with_the_nearest():
    sheet = Sheet("t.csv", pd.DataFrame(columns=["particpant", "Answer", "x"]))
    says = (
        r"^t\.csv needs columns participant, answered, x: there is no participant, the nearest is "
        r"particpant; there is no answered, the nearest is Answer; rename or add what is missing$"
    )
    with pytest.raises(InputError, match=says):
        sheet.need(("participant", "answered", "x"))
    sheet.need(("x", "Answer"))
    with pytest.raises(InputError, match=r"^t needs columns a: there is no a; rename or add"):
        Sheet("t", pd.DataFrame()).need(("a",))


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("", r"^t\.csv is empty; its first line must have the names of the columns$"),
        ("\n ,,\n\n", r"^t\.csv is empty; "),
        ("a,b,a\n1,2,3\n", r"^t\.csv has column a twice; rename one$"),
        ("a,,\n1,2,3\n", r"^t\.csv has column without a name twice; rename one$"),
        (
            "a,b\n1,2\n\n1,2,3\n",
            r"^t\.csv line 4 has 3 values, and the first line has 2 columns; mend that line$",
        ),
        ("a,b\n1\n", r"^t\.csv line 2 has 1 values, "),
        ("a,b\n1," + 140_000 * "x", r"t\.csv line 2 is no CSV: field larger"),
        (b"\x89PNG\r\n", r"t\.csv is a PNG image; give a CSV file or the directory of a session$"),
    ],
)
def test_what_is_no_table_is_told_in_a_sentence(tmp_path, text, says):
    with pytest.raises(InputError, match=says):
        read_csv(written(tmp_path, text))


def test_what_cannot_be_read_is_told_in_a_sentence(tmp_path):
    with pytest.raises(InputError, match=r"none\.csv cannot be read: No such file"):
        read_csv(tmp_path / "none.csv")
    with pytest.raises(InputError, match=r"cannot be read: Is a directory"):
        read_csv(tmp_path)
