"""Results as a tree of elements, and that as one page that needs no script and no network.

A screen reader comes first: headings in their order, tables whose cells are headed, and
beside each figure what is to be seen in it. The standard library escapes the tree's text;
`tomarkdown` writes the same tree as Markdown.
"""

from __future__ import annotations

from base64 import b64encode
from dataclasses import replace
from typing import TYPE_CHECKING
from urllib.parse import quote
from xml.etree import ElementTree

from vbraille.analysis.results import NOTE, Kind, to_print
from vbraille.pictures.words import plain
from vbraille.wording import count

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence

    from vbraille.analysis.results import ReportFigure, Results, ResultTable, Value

Element = ElementTree.Element
ROWS = 60  # rows of a table that a report shows: more is too long to listen to, and the CSV has all
KINDS = ("svg", "png", "pdf")  # kinds of files that a figure is written as
_INLINE = {"a", "span", "strong"}  # every other element begins a new line in the source
# Nothing is fetched, whatever names there are in the data.
_POLICY = "default-src 'none'; img-src data:; style-src 'unsafe-inline'; base-uri 'none'"
_STYLE = """
:root { color-scheme: light dark; --ink: #111; --paper: #fff; --line: #767676; --shade: #e2e2e2;
  --faint: #595959; --link: #00408f; }
@media (prefers-color-scheme: dark) { :root { --ink: #eee; --paper: #161616; --line: #8c8c8c;
  --shade: #3a3a3a; --faint: #a8a8a8; --link: #9ec5ff; } }
body { color: var(--ink); background: var(--paper); font: 1rem/1.5 sans-serif; margin: 0 auto;
  max-width: 80rem; padding: 1rem; overflow-wrap: anywhere; }
p, li, dd, figcaption { max-width: 45rem; }
a { color: var(--link); }
dt { font-weight: bold; }
.skip { position: absolute; left: -100rem; }
.skip:focus { position: static; }
.hidden { position: absolute; width: 1px; height: 1px; overflow: hidden; clip-path: inset(50%);
  white-space: nowrap; }
.wide { overflow-x: auto; max-width: 100%; position: relative; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; }
caption { text-align: left; padding: 0.3rem 0; }
th, td { border: 1px solid var(--line); padding: 0.2rem 0.5rem; text-align: left;
  vertical-align: top; overflow-wrap: normal; max-width: 20rem; }
.matrix th, .matrix td { padding: 0.1rem 0.25rem; }
thead th { vertical-align: bottom; }
.number { text-align: right; }
.zero { color: var(--faint); }
.right { background: var(--shade); }
.marked { outline: 1px solid var(--ink); outline-offset: -3px; }
.most { outline-width: 3px; outline-offset: -4px; }
figure { margin: 1rem 0; }
img { max-width: 100%; height: auto; background: #fff; }
@page { size: A4; margin: 15mm; }
@media print { nav, .skip { display: none; }
  body { max-width: none; padding: 0; font-size: 10pt; }
  h2, h3 { break-after: avoid; } figure, tr { break-inside: avoid; }
  img { max-height: 170mm; } .wide { overflow: visible; }
  table { font-size: 7pt; }
  th, td { padding: 0.2mm 0.8mm; overflow-wrap: anywhere; max-width: none; }
  .matrix table { font-size: 6.5pt; table-layout: fixed; width: 100%; }
  .matrix th, .matrix td { padding: 0.2mm 0.3mm; } }
"""


def to_html(results: Results, drawings: Mapping[str, bytes], beside: Sequence[str] = ()) -> str:
    """Web page of the results.

    Parameters
    ----------
    drawings
        SVG of each figure, by its name.
    beside
        Names of other files in the report's directory, to which the page links.
    """
    style = _e("style")
    style.text = _STYLE
    sources = {
        name: f"data:image/svg+xml;base64,{b64encode(svg).decode()}"
        for name, svg in drawings.items()
    }
    page = _e(
        "html",
        _e(
            "head",
            _e("meta", charset="utf-8"),
            _e("meta", http_equiv="Content-Security-Policy", content=_POLICY),
            _e("meta", name="viewport", content="width=device-width, initial-scale=1"),
            _e("title", results.title),
            style,
        ),
        _e(
            "body",
            _e("a", "Skip to the results", href="#results", class_="skip"),
            *elements(results, beside, sources),
        ),
        lang="en",
    )
    return "<!DOCTYPE html>\n" + ElementTree.tostring(page, encoding="unicode", method="html")


def elements(
    results: Results, beside: Sequence[str], sources: Mapping[str, str] | None = None
) -> tuple[Element, Element]:
    """Header and body of a report.

    Parameters
    ----------
    beside
        Names of other files in the report's directory.
    sources
        Addresses of the figures' images; None for those of their files.
    """
    header = _e("header", _e("h1", results.title))
    if results.warnings:
        header.append(_e("h2", "Read this first", id="warnings"))
        header.append(_list(results.warnings))
    titles = {table.name: table.title for table in results.result_tables()}
    figures = {
        figure.name: _figure(
            figure,
            titles[figure.table],
            figure_name(figure, "svg") if sources is None else sources[figure.name],
        )
        for figure in results.figures()
    }
    main = _e("main", id="results", tabindex="-1")
    if results.findings or results.main:
        main.append(_e("h2", "What was found", id="findings"))
    if results.findings:
        main.append(_list(results.findings))
    if results.main:
        main.append(figures[results.main])
    if results.about:
        main.append(_e("h2", "Data, versions and what was left out", id="about"))
        told = ((_e("dt", word), _e("dd", what)) for word, what in results.about)
        main.append(_e("dl", *(part for pair in told for part in pair)))
    main.append(_contents(results))
    for number, chapter in enumerate(results.chapters, 1):
        title = _e("h2", chapter.title, id=f"section-{number}")
        made = _e("section", title, _e("p", chapter.text))
        for table in chapter.tables:
            made.extend(_table(table))
        for figure in chapter.figures:
            there = _e("a", figure.title, href=f"#figure-{figure.name}")
            at_head = _e("p", "This figure stands at the head of the report: ", there, ".")
            made.append(at_head if figure.name == results.main else figures[figure.name])
        main.append(made)
    if beside:
        main.append(_e("h2", "Files beside this report", id="files"))
        main.append(_list(map(_link, beside)))
    return header, main


def _contents(results: Results) -> Element:
    items = []
    for number, chapter in enumerate(results.chapters, 1):
        inner = [(f"#table-{table.name}", table.title) for table in chapter.tables]
        inner += [(f"#figure-{each.name}", f"Figure: {each.title}") for each in chapter.figures]
        links = _list(_e("a", title, href=to) for to, title in inner)
        items.append(_e("li", _e("a", chapter.title, href=f"#section-{number}"), links))
    return _e("nav", _e("h2", "Contents"), _e("ul", *items), aria_label="Contents")


def _table(table: ResultTable) -> Iterator[Element]:
    table = table.gathered()
    if len(table) and table.columns[-1].name == NOTE and not table.frame[NOTE].any():
        # Empty notes are left out: each empty cell is noise in speech.
        table = replace(
            table,
            schema=replace(table.schema, columns=table.columns[:-1]),
            frame=table.frame.drop(columns=NOTE),
        )
    yield _e("h3", table.title, id=f"table-{table.name}")
    if table.schema.about:
        yield _e("p", table.schema.about)
    if table.marks:
        above = " and ".join(f"above {mark}" for mark in table.marks)
        yield _e("p", f"Marked are counts of wrong answers {above}.")
    long = len(table) > ROWS
    rows = f"the first {ROWS} of {len(table)} rows" if long else count(len(table), "row")
    if len(table):
        heads = _heads(table)
        names = _e("tr")
        for column in table.columns:
            names.append(_e("th", column.heading, scope="col", class_=_side(column.kind)))
        body = _e("tbody")
        for row in replace(table, frame=table.frame.head(ROWS)).rows:
            body.append(_row(table, row, heads))
        made = _e("table", _e("caption", f"{table.title}: {rows}"), _e("thead", names), body)
        # A wide table scrolls within itself, by the keyboard too.
        about = f"table-{table.name}"
        looks = "wide matrix" if table.marks else "wide"
        yield _e("div", made, class_=looks, tabindex="0", role="group", aria_labelledby=about)
    else:
        yield _e("p", "This table has no rows.")
    if table.notes:
        yield _e("p", "What cannot be said here:")
        yield _list(table.notes)
    told = f"Shown are {rows}. All rows, in full precision: " if long else "In full precision: "
    yield _e("p", told, _link(csv_name(table)))


def _heads(table: ResultTable) -> int:
    """Number of first columns that head a row: the fewest columns of words that tell rows apart."""
    words = 1
    while words < len(table.columns) and table.columns[words].kind is Kind.TEXT:
        told_apart = not table.frame.iloc[:, :words].duplicated().any()
        if table.columns[words].name == NOTE or told_apart:
            break
        words += 1
    return words


def _row(table: ResultTable, row: tuple[Value, ...], heads: int) -> Element:
    made = _e("tr")
    for at, (value, column) in enumerate(zip(row, table.columns, strict=True)):
        text = to_print(value, column.kind)
        if at < heads:
            made.append(_e("th", text or "(empty)", scope="row", class_=_side(column.kind)))
            continue
        looks = [_side(column.kind)]
        content: list[Element | str] = [text]
        if (mark := table.mark(row, at)) is not None:
            looks.append("marked most" if mark == table.marks[-1] else "marked")
            content = [_e("strong", text), _e("span", f" above {mark}", class_="hidden")]
        elif table.is_right(row, at):
            looks.append("right")
        elif table.marks and value == 0:
            looks.append("zero")
        made.append(_e("td", *content, class_=" ".join(filter(None, looks))))
    return made


def _figure(figure: ReportFigure, title: str, source: str) -> Element:
    svg, png, pdf = (_link(figure_name(figure, kind)) for kind in KINDS)
    numbers = _e("a", f"table “{title}”", href=f"#table-{figure.table}")
    told = f"Figure: {figure.title}. What it shows is told beside it."
    return _e(
        "figure",
        _e("h3", f"Figure: {figure.title}"),
        _e("img", src=source, alt=told),
        _e(
            "figcaption",
            _e("p", figure.text),
            _e("p", "Its numbers: ", numbers, ". The figure: ", svg, ", ", png, ", ", pdf, "."),
        ),
        id=f"figure-{figure.name}",
    )


def csv_name(table: ResultTable) -> str:
    """Path of a table's file in the report's directory."""
    return f"tables/{table.name}.csv"


def figure_name(figure: ReportFigure, kind: str) -> str:
    """Path of a figure's file in the report's directory."""
    return f"figures/{figure.name}.{kind}"


def _side(kind: Kind) -> str:
    return "" if kind is Kind.TEXT else "number"


def _link(name: str) -> Element:
    return _e("a", name, href=quote(name))


def _list(items: Iterable[Element | str]) -> Element:
    return _e("ul", *(_e("li", item) for item in items))


def _e(tag: str, *content: Element | str, **attributes: str) -> Element:
    """Element with text and elements in it; empty attributes are left out."""
    made = Element(tag)
    for name, value in attributes.items():
        if value:
            made.set(name.rstrip("_").replace("_", "-"), plain(value))
    for part in content:
        if isinstance(part, Element):
            made.append(part)
        elif len(made):
            made[-1].tail = (made[-1].tail or "") + plain(part)
        else:
            made.text = (made.text or "") + plain(part)
    if tag not in _INLINE:
        made.tail = "\n"
    return made
