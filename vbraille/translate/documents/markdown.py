"""A file of Markdown as a source, by way of HTML."""

from __future__ import annotations

import hashlib
import re
from itertools import pairwise
from typing import TYPE_CHECKING, BinaryIO

from vbraille.errors import InputError
from vbraille.translate.documents.encodings import SAMPLE_BYTES, TextDecoder
from vbraille.translate.documents.html import HtmlBook, read_whole
from vbraille.translate.documents.markup.tree import markup_encoding, read_tree

if TYPE_CHECKING:
    from collections.abc import Sequence

    from markdown_it.renderer import RendererHTML
    from markdown_it.rules_block import StateBlock
    from markdown_it.token import Token
    from markdown_it.utils import EnvType, OptionsDict

# Quotations and lists within others that are read as such. The parser drops what is nested deeper
# than its own limit, which is not reached.
_DEEPEST, _LIMIT = 100, 110
# What some writers of Markdown set behind a heading, for links to it.
_NAME = re.compile(r"\s*\{\s*#([^\s{}]+)[^{}]*\}\s*$")
# Lines of the front matter that say what the book is.
_TITLE = re.compile(r"^title\s*:\s*(.+?)\s*$", re.M | re.I)
_LANGUAGE = re.compile(r"^lang(?:uage)?\s*:\s*[\"']?([A-Za-z]{2,3}(?:[-_]\w+)*)", re.M | re.I)


def read_markdown(stream: BinaryIO, name: str, encoding: str | None = None) -> HtmlBook:
    """Read a file of Markdown, with tables, footnotes, definition lists and formulas.

    The whole file is read at once, since a reference may be explained at the end.

    Parameters
    ----------
    stream
        Bytes of the file, from its start; it is closed when it has been read.
    name
        Name of the file in messages.
    encoding
        Encoding that overrides what the bytes say: its name.

    Raises
    ------
    InputError
        If it cannot be read, holds no text, or the encoding is unknown.
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

    content = read_whole(stream, name)
    found = markup_encoding(content[:SAMPLE_BYTES], encoding)
    text = TextDecoder(found.name).decode(content[found.skip :], found.skip, final=True)
    parser = MarkdownIt("commonmark", {"maxNesting": _LIMIT}).enable(["table", "strikethrough"])
    parser.block.ruler.before("table", "deepest", _deepest)
    parser.add_render_rule("image", _image)
    for plugin in (front_matter_plugin, footnote_plugin, deflist_plugin, dollarmath_plugin):
        parser.use(plugin)
    parser.use(sub_plugin).use(superscript_plugin)
    parser.use(attrs_plugin, spans=True).use(anchors_plugin, max_level=6)
    tokens = parser.parse(text)
    _name_headings(tokens)
    front = next((token.content for token in tokens if token.type == "front_matter"), "")
    title, language = _TITLE.search(front), _LANGUAGE.search(front)
    html = parser.renderer.render(tokens, parser.options, {})
    if not html.strip():
        raise InputError(f"{name} holds no text; give a file with text in it")
    root, _ = read_tree(html.encode("utf-8", "replace"), name, xml=False, encoding="utf-8")
    return HtmlBook(
        root,
        name,
        hashlib.sha256(content).hexdigest(),
        title=title[1].strip("\"'") if title else "",
        language=language[1].replace("_", "-") if language else "",
    )


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


def _image(
    renderer: RendererHTML, tokens: Sequence[Token], index: int, options: OptionsDict, env: EnvType
) -> str:
    """HTML of a picture; without words it has no `alt`, which if empty says it is a decoration."""
    token = tokens[index]
    words = renderer.renderInlineAsText(token.children, options, env)
    token.attrs.pop("alt", None)
    if words.strip():
        token.attrSet("alt", words)
    return renderer.renderToken(tokens, index, options, env)


def _name_headings(tokens: list[Token]) -> None:
    """Take the name behind each heading, as in "Two {#two}", for the name of its anchor."""
    for opening, inline in pairwise(tokens):
        last = inline.children[-1] if opening.type == "heading_open" and inline.children else None
        found = _NAME.search(last.content) if last is not None and last.type == "text" else None
        if last is not None and found is not None:
            last.content = last.content[: found.start()]
            opening.attrSet("id", found[1])
