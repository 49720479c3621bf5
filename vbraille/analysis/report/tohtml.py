"""First layer of a report: a short page that needs no script and no network.

It has the question, the people, the result with one figure and one table, the methods and what was
left out, and links to the tables and figures beside it. A screen reader comes first: headings in
their order, a table whose cells are headed, and below the figure what is to be seen in it. The
standard library escapes the tree's text.
"""

from __future__ import annotations

from base64 import b64encode
from typing import TYPE_CHECKING
from urllib.parse import quote
from xml.etree import ElementTree

from vbraille.pictures.words import plain
from vbraille.wording import count

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence

    from vbraille.analysis.results import ReportFigure, Results, ResultTable, ShownTable

Element = ElementTree.Element
KINDS = ("svg", "png", "pdf")  # kinds of files that a figure is written as
_INLINE = {"a"}  # every other element begins a new line in the source
# Nothing is fetched, whatever names there are in the data.
_POLICY = "default-src 'none'; img-src data:; style-src 'unsafe-inline'; base-uri 'none'"
_STYLE = """
:root { color-scheme: light dark; --ink: #111; --paper: #fff; --line: #767676; --shade: #e2e2e2;
  --faint: #595959; --link: #00408f; }
@media (prefers-color-scheme: dark) { :root { --ink: #eee; --paper: #161616; --line: #8c8c8c;
  --shade: #3a3a3a; --faint: #a8a8a8; --link: #9ec5ff; } }
body { color: var(--ink); background: var(--paper); font: 1rem/1.5 sans-serif; margin: 0 auto;
  max-width: 80rem; padding: 1rem; overflow-wrap: anywhere; }
p, li, figcaption { max-width: 45rem; }
a { color: var(--link); }
.skip { position: absolute; left: -100rem; }
.skip:focus { position: static; }
.wide { overflow-x: auto; max-width: 100%; position: relative; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; }
caption { text-align: left; padding: 0.3rem 0; }
th, td { border: 1px solid var(--line); padding: 0.2rem 0.5rem; text-align: left;
  vertical-align: top; overflow-wrap: normal; max-width: 20rem; }
thead th { vertical-align: bottom; }
.number { text-align: right; }
figure { margin: 1rem 0; }
img { max-width: 100%; height: auto; background: #fff; }
@page { size: A4; margin: 15mm; }
@media print { nav, .skip { display: none; }
  body { max-width: none; padding: 0; font-size: 10pt; }
  h2, h3 { break-after: avoid; } figure, tr { break-inside: avoid; }
  img { max-height: 100mm; } .wide { overflow: visible; }
  table { font-size: 8pt; }
  th, td { padding: 0.2mm 0.8mm; overflow-wrap: anywhere; max-width: none; } }
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
            *_content(results, sources),
            _files(results, beside),
        ),
        lang="en",
    )
    return "<!DOCTYPE html>\n" + ElementTree.tostring(page, encoding="unicode", method="html")


def _content(results: Results, sources: Mapping[str, str]) -> Iterator[Element]:
    """Header and main part of the page."""
    header = _e("header", _e("h1", results.title))
    if results.warnings:
        header.append(_e("h2", "Read this first", id="warnings"))
        header.append(_list(results.warnings))
    yield header
    main = _e("main", id="results", tabindex="-1")
    if results.question:
        main.append(_e("h2", "Question", id="question"))
        main.extend(_e("p", sentence) for sentence in results.question)
    data = dict(results.about).get("Data")
    if data:
        main.append(_e("h2", "Data", id="data"))
        main.append(_e("p", f"{data}."))
    if results.findings:
        main.append(_e("h2", "Result", id="findings"))
        main.append(_list(results.findings))
    for figure in results.figures():
        if figure.name == results.main:
            main.append(_figure(figure, sources[figure.name]))
    if results.shown is not None:
        main.append(_table(results.shown, results.title))
    if results.notes:
        main.append(_e("p", f"What is missing: {'; '.join(results.notes)}."))
    if results.methods:
        main.append(_e("h2", "Methods", id="methods"))
        main.append(_e("p", results.methods))
    main.append(_e("h2", "Left out", id="left-out"))
    main.append(_list(results.excluded) if results.excluded else _e("p", "Nothing."))
    yield main


def _files(results: Results, beside: Sequence[str]) -> Element:
    """Links to all tables and figures, by chapters; what is in them is exploratory."""
    made = _e("section", _e("h2", "Tables and figures", id="files"))
    made.append(
        _e(
            "p",
            "All but the primary analysis is exploratory: it was not planned, and a corrected p "
            "there takes account of all exploratory tests together. ",
            *(part for name in beside for part in (_link(name), ", ")),
            "and:",
        )
    )
    items = []
    for chapter in results.chapters:
        links: list[Element | str] = [f"{chapter.title}: "]
        for table in chapter.tables:
            links += [_link(csv_name(table), table.title), f" ({count(len(table), 'row')}), "]
        for figure in chapter.figures:
            links += [_link(figure_name(figure, "svg"), f"figure: {figure.title}"), ", "]
        items.append(_e("li", *links[:-1]))
    made.append(_e("ul", *items))
    return made


def _table(table: ShownTable, title: str) -> Element:
    names = _e("tr", *(_e("th", heading, scope="col") for heading in table.headings))
    body = _e("tbody")
    for first, *rest in table.rows:
        row = _e("tr", _e("th", first, scope="row"))
        row.extend(_e("td", text or "–", class_="number") for text in rest)
        body.append(row)
    made = _e("table", _e("caption", f"{title}: the numbers"), _e("thead", names), body)
    # A wide table scrolls within itself, by the keyboard too.
    return _e("div", made, class_="wide", tabindex="0", role="group", aria_label="The numbers")


def _figure(figure: ReportFigure, source: str) -> Element:
    svg, png, pdf = (_link(figure_name(figure, kind)) for kind in KINDS)
    return _e(
        "figure",
        _e("img", src=source, alt=f"Figure: {figure.title}. What it shows is told below it."),
        _e(
            "figcaption",
            _e("p", f"{figure.title}. {figure.text} The figure: ", svg, ", ", png, ", ", pdf, "."),
        ),
        id=f"figure-{figure.name}",
    )


def csv_name(table: ResultTable) -> str:
    """Path of a table's file in the report's directory."""
    return f"tables/{table.name}.csv"


def figure_name(figure: ReportFigure, kind: str) -> str:
    """Path of a figure's file in the report's directory."""
    return f"figures/{figure.name}.{kind}"


def _link(name: str, text: str = "") -> Element:
    return _e("a", text or name, href=quote(name))


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
