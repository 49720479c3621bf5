import json
import os
import re
import subprocess
import sys
from base64 import b64decode
from dataclasses import replace
from itertools import pairwise

import html5lib
import pytest

from tests.analysis.making import table_of
from tests.analysis.report.made import (
    BARE,
    CONFUSIONS,
    LEGIBILITY,
    NASTY,
    NOTHING,
    ONE_MARK,
    RESULTS,
    TRIALS,
)
from vbraille.analysis.report import tohtml
from vbraille.analysis.report.tohtml import to_html
from vbraille.analysis.report.tomarkdown import escape, to_markdown
from vbraille.analysis.report.totext import to_json, to_lines
from vbraille.analysis.results import Chapter, Column, Kind, Results, to_csv

SVG = b"<svg xmlns='http://www.w3.org/2000/svg'/>"
FIGURES = dict.fromkeys(("legibility", "confusions", "runs"), SVG)
PAGE = to_html(RESULTS, FIGURES, ("report.md", "a file.csv"))
TREE = html5lib.HTMLParser(strict=True, namespaceHTMLElements=False).parse(PAGE)
HEADINGS = [f"h{level}" for level in range(1, 7)]
TEXTS = """
import sys
from tests.analysis.report.test_texts import FIGURES, RESULTS, to_html, to_json, to_markdown
made = to_html(RESULTS, FIGURES) + "".join(to_json(RESULTS)) + to_markdown(RESULTS)
assert "matplotlib" not in sys.modules
sys.stdout.buffer.write(made.encode("utf-8", "backslashreplace"))
"""


def text(element):
    return "".join(element.itertext())


def one(tag):
    (found,) = TREE.iter(tag)
    return found


def table(name):
    """Table of the page under its heading."""
    places = [element for element in TREE.iter() if element.tag in ("h3", "table")]
    at = next(n for n, element in enumerate(places) if element.get("id") == f"table-{name}")
    return places[at + 1]


def test_headings_skip_no_level():
    levels = [HEADINGS.index(each.tag) + 1 for each in TREE.iter() if each.tag in HEADINGS]
    assert levels[0] == 1
    assert levels.count(1) == 1
    assert all(after - before <= 1 for before, after in pairwise(levels))


def test_the_page_has_its_parts():
    assert TREE.get("lang") == "en"
    assert text(one("title")) == RESULTS.title
    assert text(one("h1")) == RESULTS.title
    heads = [text(head) for head in TREE.iter("h2")]
    assert heads[:5] == [
        "Read this first",
        "What was found",
        "Data, versions and what was left out",
        "Contents",
        "Legibility",
    ]
    assert [text(word) for word in one("dl").iter("dt")] == ["data", "versions", "left out"]
    assert one("nav").get("aria-label") == "Contents"
    skip = next(TREE.iter("a"))
    assert skip.get("href") == f"#{one('main').get('id')}"
    header = [text(item) for item in one("header").iter("li")]
    assert header == list(RESULTS.warnings)


def test_what_was_found_stands_first_with_its_figure():
    places = list(TREE.iter())
    found, about = (
        next(n for n, each in enumerate(places) if each.get("id") == name)
        for name in ("findings", "about")
    )
    first = "".join(text(each) for each in places[found:about] if each.tag == "li")
    assert all(finding in first for finding in RESULTS.findings)
    (figure,) = [each for each in places[found:about] if each.tag == "figure"]
    assert figure.get("id") == "figure-legibility"
    pointer = next(each for each in TREE.iter("p") if "at the head of the report" in text(each))
    assert next(pointer.iter("a")).get("href") == "#figure-legibility"
    made = to_markdown(RESULTS)
    order = ["Read this first", "What was found", "](figures/legibility.svg)", "Data, versions"]
    assert [made.index(each) for each in order] == sorted(made.index(each) for each in order)
    assert made.count("](figures/legibility.svg)") == 2  # shown, and linked to
    lines = list(to_lines(RESULTS))
    assert lines[1] == "warning: The device was simulated."
    assert lines[3] == f"found: {RESULTS.findings[0]}"


def test_nothing_is_wider_than_the_screen():
    """Tables scroll within themselves, and whatever is in them; all else breaks where it must."""
    held = {id(each) for wide in TREE.iter("div") for each in wide.iter("table")}
    assert {id(each) for each in TREE.iter("table")} == held
    for wide in TREE.iter("div"):
        assert "wide" in wide.get("class").split()
        assert wide.get("tabindex") == "0"
    style = " ".join(text(one("style")).split())
    assert "overflow-wrap: anywhere" in style
    # Words for speech alone are placed outside the flow: within the table they widen nothing.
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
    results = Results("Confusions", (), (), (Chapter("All", "", (table,)),))
    assert "| presented | a | b | c | f | ? | . |" in to_markdown(results)
    assert "answered d" in to_csv(table.frame)
    assert CONFUSIONS.gathered() is CONFUSIONS


def test_all_tables_are_headed():
    tables = list(TREE.iter("table"))
    assert len(tables) == 3  # and one without rows
    for each in tables:
        (caption,) = each.iter("caption")
        assert text(caption)
        (head,) = each.iter("thead")
        names = list(head.iter("th"))
        assert {name.get("scope") for name in names} == {"col"}
        (body,) = each.iter("tbody")
        for row in body.iter("tr"):
            cells = list(row)
            assert len(cells) == len(names)
            assert cells[0].tag == "th"
            assert {cell.get("scope") for cell in cells if cell.tag == "th"} == {"row"}
            assert not any(cell.get("colspan") for cell in cells)


def test_as_many_columns_head_a_row_as_tell_it_from_others():
    assert tohtml._heads(LEGIBILITY) == 2
    assert tohtml._heads(CONFUSIONS) == 1
    assert tohtml._heads(TRIALS) == 1
    rows = list(table("legibility").iter("tr"))
    assert [text(cell) for cell in rows[1].iter("th")][1] == "nominal"


def test_values_are_printed_and_what_is_missing_is_told_in_words():
    first, second = (list(row) for row in list(table("legibility").iter("tr"))[1:3])
    assert [text(cell) for cell in first][2:] == ["80", "86.3", "4.8", "< 0.001", ""]
    assert [text(cell) for cell in second][2:6] == ["0", *["not known"] * 3]
    assert [cell.get("class") for cell in first] == [None, None, *["number"] * 4, None]


def test_marks_are_told_and_right_answers_are_none():
    cells = [[text(cell) for cell in row] for row in table("confusions").iter("tr")]
    assert cells[1:] == [["a", "30", "5 above 4", "0"], ["b", "10 above 9", "28", "4"]]
    assert "wrong answers above 4 and above 9" in PAGE
    looks = {text(cell): cell.get("class") for cell in table("confusions").iter("td")}
    assert looks["30"] == "number right"
    assert looks["5 above 4"] == "number marked"
    assert looks["10 above 9"] == "number marked most"


def test_a_table_without_marks_has_none():
    assert LEGIBILITY.mark(LEGIBILITY.rows[0], 2) is None
    assert "Marked are" not in to_markdown(
        replace(RESULTS, chapters=(Chapter("L", "", (LEGIBILITY,)),), main="")
    )
    assert ONE_MARK.mark(ONE_MARK.rows[1], 1) == 4


def test_long_tables_say_how_many_rows_there_are():
    body = next(table("trials").iter("tbody"))
    assert len(list(body)) == tohtml.ROWS
    (caption,) = table("trials").iter("caption")
    assert text(caption) == "All trials: the first 60 of 150 rows"
    assert "Shown are the first 60 of 150 rows" in PAGE
    assert "Shown are the first 60 of 150 rows" in to_markdown(RESULTS)


def test_figures_have_texts_and_their_numbers():
    figures = {figure.get("id"): figure for figure in TREE.iter("figure")}
    assert list(figures) == ["figure-legibility", "figure-confusions", "figure-runs"]
    for figure in RESULTS.figures():
        element = figures[f"figure-{figure.name}"]
        (image,) = element.iter("img")
        assert figure.title in image.get("alt")
        assert b64decode(image.get("src").partition("base64,")[2]) == SVG
        (caption,) = element.iter("figcaption")
        assert figure.text in text(caption)
        links = [link.get("href") for link in caption.iter("a")]
        stem = f"figures/{figure.name}"
        files = [f"{stem}.{kind}" for kind in ("svg", "png", "pdf")]
        assert links == [f"#table-{figure.table}", *files]


def test_links_within_the_page_have_a_target():
    ids = [element.get("id") for element in TREE.iter() if element.get("id")]
    assert len(ids) == len(set(ids))
    assert not any(re.search(r"\s", each) for each in ids)
    inner = [link.get("href")[1:] for link in TREE.iter("a") if link.get("href")[0] == "#"]
    assert set(inner) <= set(ids)
    assert {f"table-{each.name}" for each in RESULTS.result_tables()} <= set(inner)
    labelled = {each.get("aria-labelledby") for each in TREE.iter()} - {None}
    assert labelled == {"table-legibility", "table-confusions", "table-trials"}
    assert labelled <= set(ids)


def test_names_are_text_and_nothing_is_fetched():
    assert not re.search(r"<script|https?://(?!evil)|url\(|@import", PAGE)
    for element in TREE.iter():
        assert not [name for name in element.attrib if name.startswith("on")]
        for name in ("href", "src"):
            target = element.get(name, "#")
            assert target.startswith(
                ("#", "tables/", "figures/", "data:image/", "report.md", "a%20")
            )
    names = [text(cell) for cell in table("legibility").iter("th")]
    assert NASTY[0] in names
    assert NASTY[1] in names
    assert "S3\\udc80\\x00|`*_[a](http://evil.example)" in names


def test_bare_results_have_a_page_too():
    page = to_html(BARE, {})
    html5lib.HTMLParser(strict=True).parse(page)
    assert "<table" not in page
    assert "This table has no rows." in page
    assert "No traces were given." in page


def test_a_column_of_notes_is_left_out_where_there_are_none():
    """Every empty cell is one that a reader hears."""
    silent = replace(LEGIBILITY, frame=LEGIBILITY.frame.dropna().assign(note=""))
    results = replace(RESULTS, chapters=(Chapter("Legibility", "", (silent,)),), main="")
    for made in (to_html(results, {}), to_markdown(results)):
        assert "mean duration (s)" in made
        assert "note" not in made
    assert '"note": ""' in "".join(to_json(results))
    assert "note" in to_markdown(RESULTS)


def test_json_has_all_rows():
    content = json.loads("".join(to_json(RESULTS)))
    assert list(content) == [
        "title", "warnings", "findings", "about", "main_figure", "figures", "tables"
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


def cells(line):
    """Cells of a line of a Markdown table, by the bars that are not escaped."""
    assert line.startswith("| ")
    assert line.endswith(" |")
    return re.split(r"(?<!\\)\|", line)[1:-1]


def test_markdown_tables_have_as_many_cells_everywhere():
    blocks = [block.splitlines() for block in to_markdown(RESULTS).split("\n\n")]
    tables = [block for block in blocks if block[0].startswith("|")]
    assert [len(lines) for lines in tables] == [2 + 8, 2 + 2, 2 + tohtml.ROWS]
    for lines, columns in zip(tables, (7, 4, 2), strict=True):
        assert {len(cells(line)) for line in lines} == {columns}
        assert all(re.fullmatch(r" ---:? ", cell) for cell in cells(lines[1]))


def test_markdown_marks_errors_and_points_to_the_numbers():
    made = to_markdown(RESULTS, ("results.json",))
    assert "| a | 30 | **5** (above 4) | 0 |" in made
    assert "| b | **10** (above 9) | 28 | 4 |" in made
    assert (
        "](figures/runs.svg)\n\nIt falls.\n\nIts numbers: [table “All trials”](tables/trials.csv)"
        in made
    )
    assert "- [results.json](results.json)" in made
    assert "This table has no rows." in made
    assert f"- {NOTHING.notes[0]}" in made


@pytest.mark.parametrize(
    ("name", "made"),
    [
        ("a|b", "a\\|b"),
        ("# a\n# b", "\\# a # b"),
        ("1. a 12.5 %", "1\\. a 12.5 %"),
        ("2009) a", "2009\\) a"),
        ("86.3", "86.3"),
        ("3.", "3\\."),
        ("  - a", "\\- a"),
        ("<b>&amp;", "\\<b\\>\\&amp;"),
        ("[a](http://b)", "\\[a\\](http:\\//b)"),
        ("www.b", "www\\.b"),
        ("\\|", "\\\\\\|"),
        ("\udc80", "\\\\udc80"),
    ],
)
def test_names_are_no_markdown(name, made):
    assert escape(name) == made


def test_texts_are_the_same_in_every_process_and_need_no_drawing():
    run = subprocess.run(
        [sys.executable, "-W", "error", "-c", TEXTS],
        env=os.environ | {"PYTHONHASHSEED": "4711"},
        capture_output=True,
        check=True,
    )
    made = to_html(RESULTS, FIGURES) + "".join(to_json(RESULTS)) + to_markdown(RESULTS)
    assert run.stdout == made.encode("utf-8", "backslashreplace")


def test_a_mark_needs_a_count():
    results = Results("Confusions", (), (), (Chapter("All", "", (ONE_MARK,)),))
    assert "**28**" not in to_markdown(results)
    assert "**10** (above 4)" in to_markdown(results)
