"""Markdown, by way of HTML, with tables, notes, definition lists and formulas."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from vbraille.translate.encodings import read_text_of
from vbraille.translate.html import tree_blocks
from vbraille.translate.plain import text_blocks
from vbraille.translate.trees import read_tree

if TYPE_CHECKING:
    from collections.abc import Iterator

    from markdown_it.rules_core import StateCore

    from vbraille.translate.blocks import Block
    from vbraille.translate.source import Source

_LONGEST = 20_000  # characters of a paragraph in which marks are looked for
# What some writers of Markdown set behind a heading, for links to it.
_NAME = re.compile(r"(.*?)\s*\{\s*#([^\s{}]+)[^{}]*\}\s*$", re.S)
_FRONT = re.compile(r"^(title|lang|language)\s*:[ \t]*(.*(?:\n[ \t]+.*)*)", re.M | re.I)


def read_markdown(source: Source, encoding: str | None = None) -> Iterator[Block]:
    """Read a file of Markdown, all at once, since a reference may be explained at the end.

    Raises
    ------
    InputError
        If the encoding is unknown, or there is no text.
    """
    from markdown_it import MarkdownIt
    from mdit_py_plugins.anchors import anchors_plugin
    from mdit_py_plugins.attrs import attrs_plugin
    from mdit_py_plugins.deflist import deflist_plugin
    from mdit_py_plugins.dollarmath import dollarmath_plugin
    from mdit_py_plugins.footnote import footnote_plugin
    from mdit_py_plugins.front_matter import front_matter_plugin
    from mdit_py_plugins.subscript import sub_plugin
    from mdit_py_plugins.superscript import superscript_plugin

    text = read_text_of(source, encoding)
    parser = MarkdownIt("commonmark", {"maxNesting": len(text)}).enable(["table", "strikethrough"])
    parser.core.ruler.before("inline", "leave_long", _leave_long)
    for plugin in (front_matter_plugin, footnote_plugin, deflist_plugin, sub_plugin):
        parser.use(plugin)
    # As pandoc has it: "$5 and $6" is no formula, nor is "$20,000 or US$15".
    parser.use(dollarmath_plugin, allow_space=False, allow_digits=False)
    parser.use(superscript_plugin)
    parser.use(attrs_plugin, spans=True).use(anchors_plugin, max_level=6)
    try:
        tokens = parser.parse(text)
    except RecursionError:
        source.note(f"{source.name} nests its parts too deep, and is read as plain text")
        return text_blocks(source, text)
    for token in tokens:
        if token.type == "front_matter":
            _read_front(source, token.content)
    html = parser.renderer.render(tokens, parser.options, {})
    content = html.encode("utf-8", "replace")
    root = read_tree(content, source.name, source.note)
    for image in root.iter("img"):  # an empty text is none here, and no sign of a decoration
        if not image.get("alt").strip():
            image.attributes.pop("alt", None)
    for heading in root.iter("h1", "h2", "h3", "h4", "h5", "h6"):
        last = heading.children[-1] if heading.children else ""
        found = _NAME.match(last) if isinstance(last, str) else None
        if found is not None:
            heading.children[-1] = found[1]
            heading.attributes["id"] = found[2]
    return tree_blocks(source, root)


def _read_front(source: Source, front: str) -> None:
    """Take the title and the language of the front matter, folded lines too."""
    for key, value in _FRONT.findall(front):
        folded = " ".join(re.sub(r"^[>|][+-]?[ \t]*\n", "", value).split()).strip("\"'")
        if key.lower() == "title":
            source.title = source.title or folded
        elif re.fullmatch(r"[A-Za-z]{2,3}([-_]\w+)*", folded):
            source.language = source.language or folded.replace("_", "-")


def _leave_long(state: StateCore) -> None:
    """Make plain texts of paragraphs that are too long to look for marks in them."""
    for token in state.tokens:
        if token.type == "inline" and len(token.content) > _LONGEST:
            token.type = "text"
