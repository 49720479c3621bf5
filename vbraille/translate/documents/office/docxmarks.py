"""Languages, small letters, pages and anchors in the XML of a DOCX file, as annotations."""

from __future__ import annotations

from itertools import count
from typing import TYPE_CHECKING

from lxml import etree

from vbraille.translate.documents.office.annotations import Languages, annotation, primary, tag_of

if TYPE_CHECKING:
    from collections.abc import Iterator

    from lxml.etree import _Element

_SPACE = "{http://www.w3.org/XML/1998/namespace}space"
_LONGEST_CHAIN = 20  # styles that are based on each other
_SMALL = {"superscript": "sup", "subscript": "sub"}
# Ends of the names of what is drawn and holds neither a picture nor text.
_DRAWN = ("/chart", "/chartex", "/diagram")


def mark_docx(roots: list[_Element], styles: _Element | None, language: str) -> str:
    """Annotate the text of a document and of its notes.

    Parameters
    ----------
    roots
        The document, which is first, and its notes; they are changed.
    styles
        Styles of the document, if it has any.
    language
        Tag of the document's language as its title page has it; empty if that does not say.

    Returns
    -------
    str
        Tag of the language that most of the text is in; empty if nothing says.
    """
    word = _namespace(roots[0])
    by_style, usual = _languages(styles, word)
    usual = usual or language
    runs = [run for root in roots for run in _runs(root, word, by_style, usual)]
    languages = Languages()
    for run, tag in runs:
        languages.count(tag, sum(len(text.text or "") for text in run.iter(f"{word}t")))
    most = languages.most(usual)
    for run, tag in runs:
        words = _words(run, word)
        if tag and primary(tag) != primary(most):
            words.append(f"lang={tag}")
        if words:
            for text in run.findall(f"{word}t"):
                if text.text:
                    text.text = annotation(words, text.text)
    _mark_pages(roots[0], word)
    _mark_drawings(roots[0], word)
    _move_bookmarks(roots[0], word)
    return most


def _namespace(root: _Element) -> str:
    """Namespace of a document's elements, in braces; there are two of them."""
    return f"{{{etree.QName(root).namespace or ''}}}"


def _languages(styles: _Element | None, word: str) -> tuple[dict[str, str], str]:
    """Language of each style, and of text without one."""
    if styles is None:
        return {}, ""
    own, based = {}, {}
    for style in styles.iter(f"{word}style"):
        name = style.get(f"{word}styleId", "")
        own[name] = _language(style, word)
        base = style.find(f"{word}basedOn")
        based[name] = "" if base is None else base.get(f"{word}val", "")
    found = {}
    for name in own:
        at = name
        for _ in range(_LONGEST_CHAIN):
            if own.get(at) or at not in based:
                break
            at = based[at]
        if own.get(at):
            found[name] = own[at]
    defaults = styles.find(f"{word}docDefaults/{word}rPrDefault")
    return found, "" if defaults is None else _language(defaults, word)


def _language(holder: _Element, word: str) -> str:
    """Language that the properties of a run or a style name; empty if none."""
    found = holder.find(f"{word}rPr/{word}lang")
    return "" if found is None else tag_of(found.get(f"{word}val"))


def _runs(
    root: _Element, word: str, by_style: dict[str, str], usual: str
) -> Iterator[tuple[_Element, str]]:
    """Runs of text, each with the tag of its language."""
    for paragraph in root.iter(f"{word}p"):
        around = by_style.get(_value(paragraph, f"{word}pPr/{word}pStyle", word), usual)
        for run in paragraph.iter(f"{word}r"):
            style = _value(run, f"{word}rPr/{word}rStyle", word)
            yield run, _language(run, word) or by_style.get(style, around)


def _value(holder: _Element, path: str, word: str) -> str:
    found = holder.find(path)
    return "" if found is None else found.get(f"{word}val", "")


def _words(run: _Element, word: str) -> list[str]:
    """What is said of a run's text: whether it is raised, lowered or underlined."""
    small = _SMALL.get(_value(run, f"{word}rPr/{word}vertAlign", word))
    line = _value(run, f"{word}rPr/{word}u", word)
    return ([small] if small else []) + (["u"] if line not in ("", "none") else [])


def _mark_pages(root: _Element, word: str) -> None:
    """Annotate where pages begin: where Word began them, or else where the author has them begin.

    Only Word's have numbers: an author's page may take more than one sheet.
    """
    laid = list(root.iter(f"{word}lastRenderedPageBreak"))
    if laid:
        first = root.find(f".//{word}sectPr/{word}pgNumType")
        start = "" if first is None else first.get(f"{word}start", "")
        numbers = count(int(start) + 1 if start.isascii() and start.isdigit() else 2)
        for number, mark in zip(numbers, laid, strict=False):
            _insert(mark, annotation([f"page={number}"]), word)
        return
    for mark in list(root.iter(f"{word}br")):
        if mark.get(f"{word}type") == "page":
            _insert(mark, annotation(["page="]), word)


def _insert(mark: _Element, text: str, word: str) -> None:
    """Put text in the place of an element of a run."""
    run = mark.getparent()
    if run is not None and run.tag == f"{word}r":
        element = etree.Element(f"{word}t")
        element.text = text
        element.set(_SPACE, "preserve")
        run.replace(mark, element)


def _mark_drawings(root: _Element, word: str) -> None:
    """Annotate what is drawn and has no text."""
    for drawing in list(root.iter(f"{word}drawing")):
        kinds = [element.get("uri", "") for element in drawing.iter("{*}graphicData")]
        if any(kind.endswith(_DRAWN) for kind in kinds):
            described = next((e.get("descr") for e in drawing.iter("{*}docPr")), None)
            name = "chart" if any("/chart" in kind for kind in kinds) else "diagram"
            said = described or annotation([f"object={name}"])
            _insert(drawing, said, word)
    for held in list(root.iter(f"{word}object")):
        if next(held.iter(f"{word}t"), None) is None:
            _insert(held, annotation(["object=embedded object"]), word)


def _move_bookmarks(root: _Element, word: str) -> None:
    """Move bookmarks that stand between paragraphs to the paragraph that they are before."""
    for mark in list(root.iter(f"{word}bookmarkStart")):
        parent = mark.getparent()
        if parent is None or parent.tag == f"{word}p":
            continue
        after = mark.getnext()
        while after is not None and after.tag != f"{word}p":
            after = after.getnext()
        if after is not None:
            properties = after.find(f"{word}pPr")
            after.insert(0 if properties is None else 1, mark)
