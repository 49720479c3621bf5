"""Results as a Markdown text, with tables as GitHub and Pandoc read them."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING
from urllib.parse import quote

from vbraille.analysis.report import shown
from vbraille.analysis.schemas import Kind
from vbraille.pictures.words import plain

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    from vbraille.analysis.results import ReportFigure, Results
    from vbraille.analysis.schemas import ResultTable, Value

# What Markdown gives a meaning to: anywhere, in an address, at the beginning of a line.
_ACTIVE = re.compile(r"[\\`*_{}\[\]<>|~$&]|(?<=:)//|(?<=www)\.|^[#+=-]")
_NUMBERED = re.compile(r"^(\d+)(?=[.)](?: |$))")  # a list begins like this


def to_markdown(results: Results, beside: Sequence[str] = ()) -> str:
    """Text of the results, with an empty line between paragraphs.

    Parameters
    ----------
    beside
        Names of other files in the report's directory.
    """
    titles = {table.name: table.title for table in results.result_tables()}
    parts = [f"# {escape(results.title)}"]
    if results.warnings:
        parts += [f"## {shown.WARNINGS}", _items(map(escape, results.warnings))]
    figure = results.main_figure()
    if results.findings or figure is not None:
        parts += [f"## {shown.FINDINGS}", _items(map(escape, results.findings))]
    if figure is not None:
        parts += _figure(figure, titles[figure.table])
    if results.about:
        about = (f"**{escape(word)}**: {escape(what)}" for word, what in results.about)
        parts += [f"## {shown.ABOUT}", _items(about)]
    for chapter in results.chapters:
        parts += [f"## {escape(chapter.title)}", escape(chapter.text)]
        for table in chapter.tables:
            parts += _table(table)
        for figure in chapter.figures:
            if figure.name == results.main:
                parts.append(f"{shown.ABOVE} {escape(figure.title)}.")
            else:
                parts += _figure(figure, titles[figure.table])
    if beside:
        parts += [f"## {shown.FILES}", _items(map(_link, beside))]
    return "\n\n".join(filter(None, parts)) + "\n"


def escape(text: str) -> str:
    """Text on one line, escaped so that Markdown shows it as it is."""
    escaped = _ACTIVE.sub(lambda found: f"\\{found[0]}", plain(text).strip())
    return _NUMBERED.sub(r"\1\\", escaped)


def _table(table: ResultTable) -> Iterator[str]:
    table = shown.in_report(table)
    yield f"### {escape(table.title)}"
    yield escape(table.schema.about)
    yield escape(shown.marking(table))
    if len(table):
        sides = ["---" if column.kind is Kind.TEXT else "---:" for column in table.columns]
        lines = [[escape(column.heading) for column in table.columns], sides]
        lines += [_row(table, row) for row in shown.rows(table)]
        yield "\n".join(f"| {' | '.join(line)} |" for line in lines)
    else:
        yield shown.NO_ROWS
    if table.notes:
        yield f"{shown.UNKNOWN}:"
        yield _items(map(escape, table.notes))
    yield f"{shown.numbers(table)} {_link(shown.csv_name(table))}"


def _row(table: ResultTable, row: tuple[Value, ...]) -> list[str]:
    texts = [escape(text) for text in shown.values(table, row)]
    for at, text in enumerate(texts):
        if (mark := table.mark(row, at)) is not None:
            texts[at] = f"**{text}** (\\> {mark})"
    return texts


def _figure(figure: ReportFigure, title: str) -> Iterator[str]:
    yield f"### Figure: {escape(figure.title)}"
    yield f"![{escape(shown.alternative(figure))}]({quote(shown.figure_name(figure, 'svg'))})"
    yield escape(figure.text)
    yield (
        f"Its numbers: [{escape(title)}]({quote(f'tables/{figure.table}.csv')}). "
        f"The figure: "
        f"{', '.join(_link(shown.figure_name(figure, kind)) for kind in shown.KINDS)}."
    )


def _items(texts: Iterable[str]) -> str:
    return "\n".join(f"- {text}" for text in texts)


def _link(name: str) -> str:
    return f"[{escape(name)}]({quote(name)})"
