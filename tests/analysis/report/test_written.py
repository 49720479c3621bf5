import json
import os
from dataclasses import replace
from pathlib import Path
from urllib.parse import unquote

import html5lib
import pandas as pd
import pytest
from PIL import Image

from tests.analysis.making import table_of
from tests.analysis.report.made import BARE, RESULTS
from vbraille.analysis.report.written import write_report
from vbraille.analysis.results import Column, to_csv
from vbraille.errors import InputError, VbrailleError

WITH_TRIALS = replace(RESULTS, trials=pd.DataFrame({"a": [1], "b": [2]}))
EXTRA = {"trials.csv": b"a,b\n1,2\n"}


def with_table(name):
    """Results with a table of this name, which is that of its file too."""
    (chapter,) = BARE.chapters
    table = table_of((Column("a", "a", ""),), (("1",),), told=(name, "", ""))
    return replace(BARE, chapters=(replace(chapter, tables=(table,)),))


def contents(folder):
    return {
        str(path.relative_to(folder)): path.read_bytes()
        for path in sorted(folder.rglob("*"))
        if path.is_file()
    }


@pytest.fixture(scope="module")
def report(tmp_path_factory):
    folder = tmp_path_factory.mktemp("report") / "new" / "out"
    return folder, write_report(WITH_TRIALS, folder)


def test_all_files_are_there(report):
    folder, files = report
    tables = [f"tables/{table.name}.csv" for table in RESULTS.result_tables()]
    figures = [
        f"figures/{figure.name}.{kind}"
        for figure in RESULTS.figures()
        for kind in (("svg", "png", "pdf") if figure.name == RESULTS.main else ("svg",))
    ]
    names = ["report.html", "results.json", *EXTRA, "codebook.csv", *tables, *figures]
    assert [str(path.relative_to(folder)) for path in files] == names
    assert sorted(contents(folder)) == sorted(names)
    assert [path.name for path in folder.parent.iterdir()] == ["out"]


def test_what_is_written_can_be_read(report):
    folder, _ = report
    json.loads((folder / "results.json").read_text("utf-8"))
    assert (folder / "trials.csv").read_bytes() == EXTRA["trials.csv"]
    for table in RESULTS.result_tables():
        text = (folder / "tables" / f"{table.name}.csv").read_text("utf-8")
        assert text == to_csv(table.frame).replace("\udc80", "\\udc80")
    for figure in RESULTS.figures():
        assert (folder / f"figures/{figure.name}.svg").read_bytes().startswith(b"<?xml")
    assert (folder / f"figures/{RESULTS.main}.pdf").read_bytes().startswith(b"%PDF")
    with Image.open(folder / f"figures/{RESULTS.main}.png") as image:
        assert image.info["dpi"] == pytest.approx((300, 300), abs=0.1)


def test_every_link_of_the_page_has_its_file(report):
    folder, files = report
    page = (folder / "report.html").read_bytes()
    tree = html5lib.HTMLParser(strict=True, namespaceHTMLElements=False).parse(page)
    links = {link.get("href") for link in tree.iter("a")}
    linked = {folder / unquote(link) for link in links if not link.startswith("#")}
    assert linked == set(files) - {folder / "report.html"}


@pytest.mark.no_cover
def test_the_same_results_give_the_same_files(report, tmp_path):
    write_report(WITH_TRIALS, tmp_path / "again")
    assert contents(tmp_path / "again") == contents(report[0])


def test_an_empty_directory_is_taken(tmp_path):
    write_report(BARE, tmp_path)
    assert (tmp_path / "report.html").exists()


def test_what_a_killed_one_left_is_no_hindrance(tmp_path):
    (tmp_path / ".out.partial" / "tables").mkdir(parents=True)
    write_report(BARE, tmp_path / "out")
    assert [path.name for path in tmp_path.iterdir()] == ["out"]


def test_a_directory_that_has_something_is_left_alone(tmp_path):
    (tmp_path / "mine").touch()
    with pytest.raises(InputError, match="is there already; give a new directory with ‹out›"):
        write_report(BARE, tmp_path)
    assert [path.name for path in tmp_path.iterdir()] == ["mine"]


def test_a_place_that_takes_no_directory_is_told_in_a_sentence(tmp_path):
    (tmp_path / "file").touch()
    with pytest.raises(InputError, match=r"file/out cannot be written"):
        write_report(BARE, tmp_path / "file" / "out")
    assert [path.name for path in tmp_path.iterdir()] == ["file"]


def test_nothing_is_left_when_a_file_cannot_be_written(tmp_path):
    # A name that no disk takes stands for a disk that is full.
    with pytest.raises(VbrailleError, match="cannot be written: File name too long") as caught:
        write_report(with_table("x" * 300), tmp_path / "new" / "out")
    assert not isinstance(caught.value, InputError)
    assert not list(tmp_path.iterdir())


def test_nothing_is_left_when_something_else_goes_wrong(tmp_path):
    with pytest.raises(ValueError, match="null byte"):
        write_report(with_table("\0"), tmp_path / "new" / "out")
    assert not list(tmp_path.iterdir())


def test_a_relative_path_is_taken(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    files = write_report(BARE, Path("out"))
    assert all(path.is_absolute() and path.exists() for path in files)
    assert os.listdir(tmp_path) == ["out"]  # noqa: PTH208
