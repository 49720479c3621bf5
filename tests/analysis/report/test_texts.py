"""The first layer of a report, JSON and lines: what they have, and that names are text in them."""

import json
import os
import re
import subprocess
import sys
from base64 import b64decode
from itertools import pairwise

import html5lib

from tests.analysis.making import table_of
from tests.analysis.report.made import BARE, CONFUSIONS, NASTY, RESULTS
from vbraille.analysis.report.tohtml import to_html
from vbraille.analysis.report.totext import to_json, to_lines
from vbraille.analysis.results import Column, Kind, to_csv

SVG = b"<svg xmlns='http://www.w3.org/2000/svg'/>"
FIGURES = {"legibility": SVG}
PAGE = to_html(RESULTS, FIGURES, ("results.json", "a file.csv"))
TREE = html5lib.HTMLParser(strict=True, namespaceHTMLElements=False).parse(PAGE)
HEADINGS = [f"h{level}" for level in range(1, 7)]
TEXTS = """
import sys
from tests.analysis.report.test_texts import FIGURES, RESULTS, to_html, to_json
made = to_html(RESULTS, FIGURES) + "".join(to_json(RESULTS))
assert "matplotlib" not in sys.modules
sys.stdout.buffer.write(made.encode("utf-8", "backslashreplace"))
"""


def text(element):
    return "".join(element.itertext())


def one(tag):
    (found,) = TREE.iter(tag)
    return found


def test_headings_skip_no_level():
    levels = [HEADINGS.index(each.tag) + 1 for each in TREE.iter() if each.tag in HEADINGS]
    assert levels[0] == 1
    assert levels.count(1) == 1
    assert all(after - before <= 1 for before, after in pairwise(levels))


def test_the_page_has_its_parts_in_order():
    assert TREE.get("lang") == "en"
    assert text(one("title")) == text(one("h1")) == RESULTS.title
    assert [text(head) for head in TREE.iter("h2")] == [
        "Read this first",
        "Question",
        "Data",
        "Result",
        "Methods",
        "Left out",
        "Tables and figures",
    ]
    skip = next(TREE.iter("a"))
    assert skip.get("href") == f"#{one('main').get('id')}"
    header = [text(item) for item in one("header").iter("li")]
    assert header == list(RESULTS.warnings)
    shown = text(one("main"))
    for said in (*RESULTS.question, *RESULTS.findings, RESULTS.methods):
        assert shown.count(said) == 1
    lines = list(to_lines(RESULTS))
    assert lines[1] == "warning: The device was simulated."
    assert f"found: {RESULTS.findings[0]}" in lines


def test_nothing_is_wider_than_the_screen():
    """The table scrolls within itself, and whatever is in it; all else breaks where it must."""
    (wide,) = TREE.iter("div")
    assert len(list(wide.iter("table"))) == len(list(TREE.iter("table"))) == 1
    assert "wide" in wide.get("class").split()
    assert wide.get("tabindex") == "0"
    assert wide.get("aria-label")
    style = " ".join(text(one("style")).split())
    assert "overflow-wrap: anywhere" in style
    assert re.search(r"\.wide \{[^}]*overflow-x: auto;[^}]*position: relative", style)
    assert re.search(r"img \{[^}]*max-width: 100%", style)
    assert "@page { size: A4;" in style


def test_rare_answers_of_a_matrix_are_gathered():
    letters = "abc"
    columns = (
        Column("presented", "presented", ""),
        *(
            Column(f"answered {name}", name, "", Kind.COUNT)
            for name in (*letters, "d", "e", "f", "?")
        ),
    )
    rows = (("a", 9, 0, 0, 1, 4, 5, 2), ("b", 0, 9, 0, 0, 2, 0, 0), ("c", 0, 0, 9, 0, 0, 0, 0))
    table = table_of(columns, rows, marks=CONFUSIONS.marks)
    found = table.gathered()
    assert [column.heading for column in found.columns] == [
        "presented", *letters, "f", "?", "."
    ]  # fmt: skip
    assert [row[-1] for row in found.rows] == [5, 2, 0]
    assert sum(sum(row[1:]) for row in found.rows) == sum(sum(row[1:]) for row in rows)
    assert "Column . gathers 2 answers that were never presented" in found.schema.about
    assert "more than 4 times: d, e." in found.schema.about
    assert "answered d" in to_csv(table.frame)
    assert CONFUSIONS.gathered() is CONFUSIONS


def test_the_table_is_headed():
    table = one("table")
    (caption,) = table.iter("caption")
    assert text(caption)
    names = list(one("thead").iter("th"))
    assert {name.get("scope") for name in names} == {"col"}
    assert [text(name) for name in names] == list(RESULTS.shown.headings)
    rows = list(one("tbody").iter("tr"))
    for row, told in zip(rows, RESULTS.shown.rows, strict=True):
        first, *rest = row
        assert (first.tag, first.get("scope")) == ("th", "row")
        assert [text(cell) for cell in rest] == [said or "–" for said in told[1:]]
    assert text(rows[1][0]) == "é"


def test_the_figure_has_a_text():
    figure = one("figure")
    assert figure.get("id") == "figure-legibility"
    (image,) = figure.iter("img")
    assert "Legibility" in image.get("alt")
    assert b64decode(image.get("src").partition("base64,")[2]) == SVG
    (caption,) = figure.iter("figcaption")
    assert "S1 reads best." in text(caption)
    links = [link.get("href") for link in caption.iter("a")]
    assert links == [f"figures/legibility.{kind}" for kind in ("svg", "png", "pdf")]


def test_every_table_and_figure_is_linked():
    links = {link.get("href") for link in TREE.iter("a")}
    assert {f"tables/{table.name}.csv" for table in RESULTS.result_tables()} <= links
    assert {f"figures/{figure.name}.svg" for figure in RESULTS.figures()} <= links
    ids = [element.get("id") for element in TREE.iter() if element.get("id")]
    assert len(ids) == len(set(ids))
    assert {link[1:] for link in links if link[0] == "#"} <= set(ids)


def test_names_are_text_and_nothing_is_fetched():
    assert not re.search(r"<script|https?://(?!evil)|url\(|@import", PAGE)
    for element in TREE.iter():
        assert not [name for name in element.attrib if name.startswith("on")]
        for name in ("href", "src"):
            target = element.get(name, "#")
            assert target.startswith(("#", "tables/", "figures/", "data:image/", "results", "a%20"))
    said = text(one("body"))
    assert NASTY[0] in said
    assert NASTY[1] in said
    assert "S3\\udc80\\x00|`*_[a](http://evil.example)" in said


def test_bare_results_have_a_page_too():
    page = to_html(BARE, {})
    html5lib.HTMLParser(strict=True).parse(page)
    assert "<table" not in page


def test_json_has_all_rows():
    content = json.loads("".join(to_json(RESULTS)))
    assert list(content) == [
        "title", "warnings", "question", "findings", "methods", "excluded", "about", "main_figure",
        "figures", "tables",
    ]  # fmt: skip
    assert content["findings"] == list(RESULTS.findings)
    assert content["main_figure"] == "legibility"
    for each in RESULTS.result_tables():
        found = content["tables"][each.name]
        assert found["rows"] == each.records()
        assert list(found["columns"]) == list(each.frame)
        assert found["notes"] == list(each.notes)
    assert list(content["figures"]) == ["legibility", "confusions", "runs"]
    assert content["figures"]["runs"]["table"] == "trials"
    assert content["tables"]["legibility"]["rows"][1]["legibility"] is None
    assert content["about"] == dict(RESULTS.about)


def test_texts_are_the_same_in_every_process_and_need_no_drawing():
    run = subprocess.run(
        [sys.executable, "-W", "error", "-c", TEXTS],
        env=os.environ | {"PYTHONHASHSEED": "4711"},
        capture_output=True,
        check=True,
    )
    made = to_html(RESULTS, FIGURES) + "".join(to_json(RESULTS))
    assert run.stdout == made.encode("utf-8", "backslashreplace")
