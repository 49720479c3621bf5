"""Markdown, by way of HTML, with tables, notes, definition lists and formulas."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from vbraille.translate.encodings import read_text_of
from vbraille.translate.html import tree_blocks
from vbraille.translate.trees import read_tree

if TYPE_CHECKING:
    from collections.abc import Iterator

    from markdown_it.rules_block import StateBlock

    from vbraille.translate.blocks import Block
    from vbraille.translate.source import Source

# Quotations and lists within others that are read as such. The parser drops what is nested deeper
# than its own limit, which is not reached.
_DEEPEST, _LIMIT = 100, 110
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
    from markdown_it.renderer import RendererHTML
    from mdit_py_plugins.anchors import anchors_plugin
    from mdit_py_plugins.attrs import attrs_plugin
    from mdit_py_plugins.deflist import deflist_plugin
    from mdit_py_plugins.dollarmath import dollarmath_plugin
    from mdit_py_plugins.footnote import footnote_plugin
    from mdit_py_plugins.front_matter import front_matter_plugin
    from mdit_py_plugins.subscript import sub_plugin
    from mdit_py_plugins.superscript import superscript_plugin

    text = read_text_of(source, encoding)
    parser = MarkdownIt("commonmark", {"maxNesting": _LIMIT}).enable(["table", "strikethrough"])
    parser.block.ruler.before("table", "deepest", _deepest)
    for plugin in (front_matter_plugin, footnote_plugin, deflist_plugin):
        parser.use(plugin)
    # As pandoc has it: "$5 and $6" is no formula, nor is "$20,000 or US$15".
    parser.use(dollarmath_plugin, allow_space=False, allow_digits=False)
    parser.use(sub_plugin).use(superscript_plugin)
    parser.use(attrs_plugin, spans=True).use(anchors_plugin, max_level=6)
    tokens = parser.parse(text)
    for token in tokens:
        if token.type == "front_matter":
            _read_front(source, token.content)
        for image in token.children or ():
            if image.type == "image" and not image.content.strip():
                # A picture without words; an `alt` would say that it is a decoration.
                image.attrs.pop("alt")
                image.type = "html_inline"
                image.content = f"<img{RendererHTML.renderAttrs(image)}>"
    html = parser.renderer.render(tokens, parser.options, {})
    content = html.encode("utf-8", "replace")
    root = read_tree(content, source.name, source.note, xml=False)
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


def _deepest(state: StateBlock, first: int, after: int, silent: bool) -> bool:
    """Take the text of what is nested too deep for a paragraph, without its nesting."""
    if silent or state.level < _DEEPEST:
        return False
    lines = state.getLines(first, after, state.blkIndent, keepLastLF=False).split("\n")
    state.push("paragraph_open", "p", 1)
    inline = state.push("inline", "", 0)
    inline.content = "\n".join(line.lstrip("> \t") for line in lines).strip()
    inline.children = []
    inline.map = [first, after]
    state.push("paragraph_close", "p", -1)
    state.line = after
    return True
