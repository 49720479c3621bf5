import pytest

from vbraille.csvfiles import parse_csv, read_csv
from vbraille.errors import InputError


@pytest.mark.parametrize(
    "data",
    [
        "name,n\nÄpfel,1\nzwei,2\n".encode(),
        "\ufeffname;n\r\nÄpfel;1\r\nzwei;2\r\n".encode(),
        "sep=;\nname;n\nÄpfel;1\n\nzwei;2".encode(),
        '"sep=|"\nname|n\nÄpfel|1\nzwei|2\n'.encode(),
        "name\tn\nÄpfel\t1\nzwei\t2\n".encode("utf-16"),
        "name;n\nÄpfel;1\nzwei;2\n".encode("cp1252"),
        '"","name","n"\n"1","Äpfel","1"\n"2","zwei","2"\n'.encode(),
        "name,n,\nA\u0308pfel,1,\n zwei , 2,,\n".encode(),
    ],
)
def test_tables_of_any_program_are_read_alike(data):
    sheet = parse_csv(data, "x.csv")
    assert sheet.columns == ("name", "n")
    rows = [[name.replace("A\u0308", "Ä"), n] for name, n in sheet.rows]
    assert rows == [["Äpfel", "1"], ["zwei", "2"]]


def test_cells_keep_separators_and_lose_line_breaks():
    sheet = parse_csv(b'name,n\n"a, b",1\n"haus\ntier",2\nx,3\n', "x.csv")
    assert sheet.records() == [
        {"name": "a, b", "n": "1"},
        {"name": "haus tier", "n": "2"},
        {"name": "x", "n": "3"},
    ]
    assert sheet.lines == [2, 3, 5]


@pytest.mark.parametrize(
    ("data", "named"),
    [
        (b"", "empty"),
        (b"\n\n", "empty"),
        (b"a,b\n1,2\n1,2,3\n", "line 3"),
        (b'a,b\n1,2\n"1,2\n3,4\n', "line 3"),
        (b"a,b,a\n", "'a'"),
    ],
)
def test_what_is_no_table_is_refused(data, named):
    with pytest.raises(InputError, match=named) as refusal:
        parse_csv(data, "x.csv")
    assert "x.csv" in str(refusal.value)


def test_a_file_that_is_not_there_is_named(tmp_path):
    with pytest.raises(InputError, match=r"none\.csv"):
        read_csv(tmp_path / "none.csv")
