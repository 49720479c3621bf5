"""Results as one page that needs nothing else: no script, no network.

A screen reader comes first: headings in their order, tables whose cells are headed, and
beside each figure what is to be seen in it. Elements are built as a tree, whose text
the standard library escapes.
"""

from __future__ import annotations

from base64 import b64encode
from typing import TYPE_CHECKING
from urllib.parse import quote
from xml.etree import ElementTree

from vbraille.analysis.report import shown
from vbraille.analysis.schemas import Kind
from vbraille.pictures.words import plain

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence

    from vbraille.analysis.results import Chapter, ReportFigure, Results
    from vbraille.analysis.schemas import ResultTable, Value

Element = ElementTree.Element
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
    figures
        SVG of each figure, by its name.
    beside
        Names of other files in the report's directory, to which the page links.
    """
    titles = {table.name: table.title for table in results.result_tables()}
    main = _e("main", id="results", tabindex="-1")
    main.extend(_findings(results, titles, drawings))
    main.extend(_about(results))
    main.append(_contents(results))
    for number, chapter in enumerate(results.chapters, 1):
        main.append(_chapter(chapter, number, titles, drawings, results.main))
    if beside:
        main.append(_e("h2", shown.FILES, id="files"))
        main.append(_list(_e("li", _link(name)) for name in beside))
    style = _e("style")
    style.text = _STYLE
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
            _header(results),
            main,
        ),
        lang="en",
    )
    return "<!DOCTYPE html>\n" + ElementTree.tostring(page, encoding="unicode", method="html")


def _header(results: Results) -> Element:
    header = _e("header", _e("h1", results.title))
    if results.warnings:
        header.append(_e("h2", shown.WARNINGS, id="warnings"))
        header.append(_list(_e("li", warning) for warning in results.warnings))
    return header


def _findings(
    results: Results, titles: Mapping[str, str], drawings: Mapping[str, bytes]
) -> Iterator[Element]:
    """What was found, with the main figure; empty if nothing was found."""
    figure = results.main_figure()
    if results.findings or figure is not None:
        yield _e("h2", shown.FINDINGS, id="findings")
    if results.findings:
        yield _list(_e("li", finding) for finding in results.findings)
    if figure is not None:
        yield _figure(figure, titles[figure.table], drawings[figure.name])


def _about(results: Results) -> Iterator[Element]:
    if results.about:
        about = _e("dl")
        for word, what in results.about:
            about.extend([_e("dt", word), _e("dd", what)])
        yield _e("h2", shown.ABOUT, id="about")
        yield about


def _contents(results: Results) -> Element:
    items = []
    for number, chapter in enumerate(results.chapters, 1):
        inner = [(f"#table-{table.name}", table.title) for table in chapter.tables]
        inner += [(f"#figure-{each.name}", f"Figure: {each.title}") for each in chapter.figures]
        links = _list(_e("li", _e("a", title, href=to)) for to, title in inner)
        items.append(_e("li", _e("a", chapter.title, href=f"#section-{number}"), links))
    return _e("nav", _e("h2", shown.CONTENTS), _list(items), aria_label=shown.CONTENTS)


def _chapter(
    chapter: Chapter,
    number: int,
    titles: Mapping[str, str],
    drawings: Mapping[str, bytes],
    main: str,
) -> Element:
    made = _e("section", _e("h2", chapter.title, id=f"section-{number}"), _e("p", chapter.text))
    for table in chapter.tables:
        made.extend(_table(table))
    for figure in chapter.figures:
        if figure.name == main:
            there = _e("a", figure.title, href=f"#figure-{figure.name}")
            made.append(_e("p", f"{shown.ABOVE} ", there, "."))
        else:
            made.append(_figure(figure, titles[figure.table], drawings[figure.name]))
    return made


def _table(table: ResultTable) -> Iterator[Element]:
    table = shown.in_report(table)
    yield _e("h3", table.title, id=f"table-{table.name}")
    for text in filter(None, (table.schema.about, shown.marking(table))):
        yield _e("p", text)
    if len(table):
        heads = shown.heads(table)
        names = _e("tr")
        for column in table.columns:
            names.append(_e("th", column.heading, scope="col", class_=_side(column.kind)))
        body = _e("tbody")
        for row in shown.rows(table):
            body.append(_row(table, row, heads))
        made = _e("table", _e("caption", shown.caption(table)), _e("thead", names), body)
        # A wide table scrolls within itself, by the keyboard too.
        about = f"table-{table.name}"
        looks = "wide matrix" if table.marks else "wide"
        yield _e("div", made, class_=looks, tabindex="0", role="group", aria_labelledby=about)
    else:
        yield _e("p", shown.NO_ROWS)
    if table.notes:
        yield _e("p", f"{shown.UNKNOWN}:")
        yield _list(_e("li", note) for note in table.notes)
    yield _e("p", f"{shown.numbers(table)} ", _link(shown.csv_name(table)))


def _row(table: ResultTable, row: tuple[Value, ...], heads: int) -> Element:
    made = _e("tr")
    for at, (text, column) in enumerate(zip(shown.values(table, row), table.columns, strict=True)):
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
        elif table.marks and row[at] == 0:
            looks.append("zero")
        made.append(_e("td", *content, class_=" ".join(filter(None, looks))))
    return made


def _figure(figure: ReportFigure, title: str, svg: bytes) -> Element:
    source = f"data:image/svg+xml;base64,{b64encode(svg).decode()}"
    return _e(
        "figure",
        _e("h3", f"Figure: {figure.title}"),
        _e("img", src=source, alt=shown.alternative(figure)),
        _e(
            "figcaption",
            _e("p", figure.text),
            _e(
                "p",
                "Its numbers: ",
                _e("a", f"table “{title}”", href=f"#table-{figure.table}"),
                ". The figure: ",
                *_files(figure),
                ".",
            ),
        ),
        id=f"figure-{figure.name}",
    )


def _files(figure: ReportFigure) -> Iterator[Element | str]:
    for number, kind in enumerate(shown.KINDS):
        if number:
            yield ", "
        yield _link(shown.figure_name(figure, kind))


def _side(kind: Kind) -> str:
    return "" if kind is Kind.TEXT else "number"


def _link(name: str) -> Element:
    return _e("a", name, href=quote(name))


def _list(items: Iterable[Element]) -> Element:
    return _e("ul", *items)


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
