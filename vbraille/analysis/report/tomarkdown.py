"""Results as a Markdown text, with tables as GitHub and Pandoc read them."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from vbraille.analysis.report.tohtml import elements
from vbraille.pictures.words import plain

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from vbraille.analysis.report.tohtml import Element
    from vbraille.analysis.results import Results

# What Markdown gives a meaning to: anywhere, in an address, at the beginning of a line.
_ACTIVE = re.compile(r"[\\`*_{}\[\]<>|~$&]|(?<=:)//|(?<=www)\.|^[#+=-]")
_NUMBERED = re.compile(r"^(\d+)(?=[.)](?: |$))")  # a list begins like this
_TABLE = "#table-"  # how a link to a table of the page begins


def to_markdown(results: Results, beside: Sequence[str] = ()) -> str:
    """Text of the results, with an empty line between paragraphs.

    Parameters
    ----------
    beside
        Names of other files in the report's directory.
    """
    parts = [part for element in elements(results, beside) for part in _blocks(element)]
    return "\n\n".join(filter(None, parts)) + "\n"


def escape(text: str) -> str:
    """Text on one line, escaped so that Markdown shows it as it is."""
    escaped = _ACTIVE.sub(lambda found: f"\\{found[0]}", plain(text).strip())
    return _NUMBERED.sub(r"\1\\", escaped)


def _blocks(element: Element) -> Iterator[str]:
    """Paragraphs, lists and tables of an element of the report; contents are those of the page."""
    match element.tag:
        case "h1" | "h2" | "h3":
            yield f"{'#' * int(element.tag[1])} {_inline(element)}"
        case "p":
            yield _inline(element)
        case "ul":
            yield "\n".join(f"- {_inline(item)}" for item in element)
        case "dl":
            pairs = zip(element[::2], element[1::2], strict=True)
            yield "\n".join(f"- **{_inline(word)}**: {_inline(what)}" for word, what in pairs)
        case "img":
            yield f"![{escape(element.get('alt', ''))}]({element.get('src')})"
        case "table":
            heads, *rows = ([_inline(cell) for cell in row] for row in element.iter("tr"))
            sides = ["---:" if cell.get("class") else "---" for cell in element.iter("th")]
            lines = [heads, sides[: len(heads)], *rows]
            yield "\n".join(f"| {' | '.join(line)} |" for line in lines)
        case "nav":
            pass
        case _:
            for part in element:
                yield from _blocks(part)


def _inline(element: Element) -> str:
    """Text of an element with what is in it; links lead to files, and not within the page."""
    text = _spaced(element.text)
    for part in element:
        inner, to = _inline(part), part.get("href", "")
        if part.tag == "strong":
            inner = f"**{inner}**"
        elif part.tag == "span":
            inner = f" ({inner})"
        elif to.startswith(_TABLE):
            inner = f"[{inner}](tables/{to.removeprefix(_TABLE)}.csv)"
        elif to and not to.startswith("#"):
            inner = f"[{inner}]({to})"
        text += inner + _spaced(part.tail)
    return text.strip()


def _spaced(text: str | None) -> str:
    """Escaped text with the spaces around it."""
    text = text or ""
    return f"{' ' * text.startswith(' ')}{escape(text)}{' ' * text.endswith(' ')}"
