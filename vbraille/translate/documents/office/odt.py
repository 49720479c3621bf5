"""An ODT file as a tree of HTML: styles, lists, tables, notes, links, languages, pages."""

from __future__ import annotations

import posixpath
from collections import Counter
from dataclasses import dataclass, field
from itertools import count
from typing import TYPE_CHECKING

from lxml import etree

from vbraille.errors import InputError
from vbraille.translate.documents.markup.tables import numeral, whole
from vbraille.translate.documents.office.htmltree import (
    DEEPEST,
    Notes,
    Pictures,
    chain,
    last_of,
    most_frequent,
    primary,
    put,
    put_inner,
    put_page,
    put_text,
    put_unshown,
    remove,
    tag_of,
    told,
    unwrap,
)

if TYPE_CHECKING:
    from collections.abc import Iterator

    from lxml.etree import _Element as Element

    from vbraille.translate.documents.markup.archive import Archive

_OASIS = "{urn:oasis:names:tc:opendocument:xmlns:"
_TEXT, _STYLE, _TABLE = (f"{_OASIS}{name}:1.0}}" for name in ("text", "style", "table"))
_FO = f"{_OASIS}xsl-fo-compatible:1.0}}"
_FORM = f"{_OASIS}form:1.0}}"
_XML_ID = "{http://www.w3.org/XML/1998/namespace}id"
_HREF = "{http://www.w3.org/1999/xlink}href"
_MATH = "{http://www.w3.org/1998/Math/MathML}math"
_BLOCKS = frozenset(("p", "h", "list", "table"))
# What is not read: comments, deleted text, what only programs need.
_SKIPPED_NAMES = (
    "annotation annotation-end tracked-changes forms sequence-decls variable-decls "
    "user-field-decls dde-connection-decls alphabetical-index-auto-mark-file bookmark-end "
    "reference-mark-end note-citation hidden-text hidden-paragraph toc-mark-start toc-mark-end "
    "desc title script index-source table-of-content-source illustration-index-source "
    "table-index-source object-index-source user-index-source alphabetical-index-source "
    "bibliography-source list-header-source event-listeners"
)
_SKIPPED = frozenset(_SKIPPED_NAMES.split())
_MOST_REPEATED = 1_000  # columns, rows or blanks


@dataclass(frozen=True, slots=True)
class _Look:
    """What styles say of a text: its language and the names of HTML's elements for it."""

    language: str = ""
    tags: frozenset[str] = frozenset()
    without: frozenset[str] = frozenset()
    hidden: bool = False

    def within(self, around: _Look) -> _Look:
        """Look of text of this style inside of another."""
        tags = (around.tags - self.without) | self.tags
        language = self.language or around.language
        return _Look(language, tags, frozenset(), self.hidden or around.hidden)


@dataclass(slots=True)
class _Styles:
    """Styles by their names."""

    looks: dict[str, _Look] = field(default_factory=dict)
    based: dict[str, str] = field(default_factory=dict)
    breaking: set[str] = field(default_factory=set)  # those that begin a page
    lists: dict[str, Element] = field(default_factory=dict)
    outlines: dict[str, str] = field(default_factory=dict)  # lists of paragraph styles
    usual: _Look = _Look()


def read_odt(archive: Archive) -> tuple[Element, str, str]:
    """Read an ODT file.

    Returns
    -------
    root
        Root of the tree of HTML.
    title, language
        Title, and tag of the language that most of the text is in; empty if it does not say.

    Raises
    ------
    InputError
        If a part that is needed is missing, locked, damaged or too large.
    """
    if b"encryption-data" in archive.read_if("META-INF/manifest.xml"):
        raise InputError(
            f"{archive.name} is locked with a password; open it with that and save it without one"
        )
    return _Reader(archive).read()


class _Reader:
    """Reads one document."""

    def __init__(self, archive: Archive) -> None:
        self._archive = archive
        self._root = archive.xml("content.xml")
        common = archive.xml("styles.xml") if "styles.xml" in archive else None
        self._about = archive.xml("meta.xml") if "meta.xml" in archive else None
        self._styles = _read_styles([e for e in (common, self._root) if e is not None])
        self._pictures = Pictures()
        self._notes = Notes()
        self._bodies: dict[str, Element] = {}  # of notes
        self._ended: dict[str, int] = {}  # numbers at which lists ended, by styles
        self._pending = 0  # pages that begin with the next paragraph
        self._is_first = True
        self._is_head = False  # of a table

    def read(self) -> tuple[Element, str, str]:
        usual = self._styles.usual.language or told(self._about, "language")
        around = _Look(usual)
        counted = Counter[str]()
        for paragraph in self._root.iter(f"{_TEXT}p", f"{_TEXT}h"):
            self._count(paragraph, around, counted, 0)
        self._most = most_frequent(counted, usual)
        self._pages = count(2)
        self._is_laid_out = next(self._root.iter(f"{_TEXT}soft-page-break"), None) is not None
        html = etree.Element("html")
        body = put(html, "body")
        for text in self._root.iterfind(f"{_OASIS}office:1.0}}body/{_OASIS}office:1.0}}text"):
            self._blocks(text, body, around, 0)
        for identity, item in self._notes.section(body):
            self._blocks(self._bodies[identity], item, around, 0)
        return html, told(self._about, "title"), self._most

    def _look(self, element: Element, around: _Look) -> _Look:
        found = self._styles.looks.get(element.get(f"{_TEXT}style-name", ""))
        return around if found is None else found.within(around)

    def _count(self, element: Element, around: _Look, counted: Counter[str], depth: int) -> None:
        """Count the characters of each language."""
        look = self._look(element, around)
        counted[look.language] += len(element.text or "")
        for child in element:
            if _name(child) in ("span", "a") and depth < DEEPEST:
                self._count(child, look, counted, depth + 1)
            counted[look.language] += len(child.tail or "")

    def _blocks(self, holder: Element, into: Element, around: _Look, depth: int) -> None:
        """Read the blocks of a body, of a cell, of an item or of a note."""
        for element in self._within(holder):
            name = _name(element)
            if name == "list":
                self._list(element, into, around, depth, self._list_style(element, ""))
            elif name == "table":
                self._table(element, into, around, depth)
            elif name == "soft-page-break":
                self._pending += 1
            elif name == "frame":
                self._frame(element, put(into, "p"), around, depth)
            elif name in ("p", "h"):
                self._paragraph(element, into, around, depth)

    def _within(self, holder: Element) -> Iterator[Element]:
        """Paragraphs, lists and tables, whatever holds them."""
        for element in holder:
            name = _name(element)
            if name in _BLOCKS or name in ("soft-page-break", "frame"):
                yield element
            elif name and name not in _SKIPPED:
                yield from self._within(element)

    def _paragraph(self, element: Element, into: Element, around: _Look, depth: int) -> None:
        style = element.get(f"{_TEXT}style-name", "")
        names = [name.lower() for name in (style, *chain(style, self._styles.based))]
        look = self._look(element, around)
        if look.hidden:
            return
        level = whole(element.get(f"{_TEXT}outline-level"), 1) if _name(element) == "h" else 0
        is_quote = any(name.startswith("quotation") for name in names)
        is_code = any(name.startswith("preformatted") for name in names)
        parent = into
        if is_quote and not level:
            last = last_of(into)
            is_same = last is not None and last.tag == "blockquote"
            parent = last if last is not None and is_same else put(into, "blockquote")
        tag = f"h{min(max(level, 1), 6)}" if level else "pre" if is_code else "p"
        block = put(parent, tag)
        if not self._is_first and style in self._styles.breaking:
            self._pending += 1
        self._is_first = False
        for _ in range(self._pending):
            put_page(block, str(next(self._pages)) if self._is_laid_out else "")
        self._pending = 0
        if level:  # by which tables of contents find it
            put(block, "a", id="".join(map(str, element.itertext())))
        # What all of a heading or a quotation looks like is its style.
        is_styled = level or is_quote or self._is_head
        common = self._common(element, look) if is_styled else frozenset[str]()
        self._inner(element, block, look, common, depth)
        if self._pictures.repeats(block) or (not len(block) and not (block.text or "").strip()):
            remove(block)

    def _common(self, element: Element, look: _Look) -> frozenset[str]:
        """Emphasis of all the text of a paragraph."""
        looks: list[frozenset[str]] = []

        def gather(holder: Element, look: _Look, depth: int) -> None:
            if (holder.text or "").strip():
                looks.append(look.tags)
            for child in holder:
                if _name(child) in ("span", "a") and depth < DEEPEST:
                    gather(child, self._look(child, look), depth + 1)
                if (child.tail or "").strip():
                    looks.append(look.tags)

        gather(element, look, 0)
        return frozenset.intersection(*looks) if looks else frozenset()

    def _inner(
        self, element: Element, into: Element, look: _Look, common: frozenset[str], depth: int
    ) -> None:
        """Read the text of an element and what stands in it."""
        self._say(element.text, into, look, common)
        for child in element:
            name = _name(child)
            if depth > DEEPEST:
                put_text(into, "".join(map(str, child.itertext())))
            elif name and name not in _SKIPPED:
                self._thing(child, name, into, look, common, depth)
            elif not name and not isinstance(child, etree._Comment):
                put_text(into, child.text or "")  # an entity that is not unfolded
            self._say(child.tail, into, look, common)

    def _say(self, text: str | None, into: Element, look: _Look, common: frozenset[str]) -> None:
        if not text:
            return
        tag = look.language
        language = tag if tag and primary(tag) != primary(self._most) else ""
        tags = sorted(look.tags)
        in_link = any(parent.tag == "a" for parent in (into, *into.iterancestors()))
        without = common | {"u"} if in_link else common
        put_text(put_inner(into, tags, language, without=without), text)

    def _thing(
        self,
        element: Element,
        name: str,
        into: Element,
        look: _Look,
        common: frozenset[str],
        depth: int,
    ) -> None:
        """Read an element within a paragraph."""
        match name:
            case "span":
                inner = self._look(element, look)
                if not inner.hidden:
                    self._inner(element, into, inner, common, depth + 1)
            case "a":
                address = element.get(_HREF, "")
                address = address.removesuffix("|outline") if address[:1] == "#" else address
                link = put(into, "a", href=address) if address else into
                self._inner(element, link, self._look(element, look), common, depth + 1)
            case "s":
                blanks = whole(element.get(f"{_TEXT}c"), 1)
                self._say(" " * min(blanks, _MOST_REPEATED), into, look, common)
            case "tab":
                put_text(into, "\t")
            case "line-break":
                put(into, "br")
            case "soft-page-break":
                put_page(into, str(next(self._pages)))
            case "bookmark" | "bookmark-start" | "reference-mark" | "reference-mark-start":
                put(into, "a", id=element.get(f"{_TEXT}name", ""))
            case "note":
                identity = element.get(f"{_TEXT}id") or f"note-{len(self._bodies)}"
                body = element.find(f"{_TEXT}note-body")
                self._bodies[identity] = element if body is None else body
                self._notes.refer(into, identity)
            case "frame":
                self._frame(element, into, look, depth)
            case "ruby":
                base, above = element.find(f"{_TEXT}ruby-base"), element.find(f"{_TEXT}ruby-text")
                texts = ["".join(map(str, e.itertext())) for e in (base, above) if e is not None]
                put(put(into, "ruby", texts[0] if texts else ""), "rt", "".join(texts[1:]))
            case "control":
                self._control(element, into)
            case "custom-shape" | "rect" | "ellipse" | "line" | "path" | "polygon" | "g":
                if next(element.iter(f"{_TEXT}p"), None) is not None:
                    self._blocks(element, put(into, "div"), look, depth + 1)
                else:
                    put_unshown(into, "drawing")
            case _:
                self._inner(element, into, look, common, depth + 1)

    def _control(self, element: Element, into: Element) -> None:
        """Read a field of a form: a check box by its state."""
        identity = element.get(f"{_OASIS}drawing:1.0}}control", "")
        for control in self._root.iter(f"{_FORM}checkbox"):
            if identity in (
                control.get(f"{_FORM}id"),
                control.get("{http://www.w3.org/XML/1998/namespace}id"),
            ):
                state = control.get(f"{_FORM}current-state") or control.get(f"{_FORM}state")
                put_text(into, "☑" if state == "checked" else "☐")
                return
        put_unshown(into, "form field")

    def _frame(self, frame: Element, into: Element, look: _Look, depth: int) -> None:
        """Read a picture by its text, a formula, a box by what is in it; mark all else."""
        box = next((e for e in frame if _name(e) == "text-box"), None)
        if box is not None and depth < DEEPEST:
            self._blocks(box, put(into, "div"), look, depth + 1)
            return
        texts = [
            "".join(map(str, e.itertext())).strip()
            for name in ("desc", "title")
            for e in frame
            if _name(e) == name
        ]
        described = next(filter(None, texts), "")
        formula = self._formula(frame)
        kinds = {_name(e) for e in frame}
        if formula is not None:
            into.append(formula)
        elif described:
            put(into, "img", alt=described)
        else:
            put_unshown(into, "embedded object" if "object" in kinds else "picture")

    def _formula(self, frame: Element) -> Element | None:
        """Formula in MathML that a frame holds, or that another part of the archive is."""
        inside = next(frame.iter(_MATH), None)
        if inside is None:
            for element in frame:
                address = element.get(_HREF, "") if _name(element) == "object" else ""
                member = posixpath.normpath(f"{address}/content.xml")
                if address and member in self._archive:
                    inside = self._archive.xml(member)
                    break
        if inside is None or _name(inside) != "math":
            return None
        math = etree.fromstring(etree.tostring(inside, with_tail=False))
        notes = list(math.iter("{*}annotation"))
        if any("tex" in note.get("encoding", "").lower() for note in notes):
            for note in notes:  # StarMath says the same once more
                if "tex" not in note.get("encoding", "").lower():
                    remove(note)
        return math

    def _list_style(self, element: Element, around: str) -> str:
        name = element.get(f"{_TEXT}style-name", "")
        if not name:
            first = next(element.iter(f"{_TEXT}p", f"{_TEXT}h"), None)
            style = "" if first is None else first.get(f"{_TEXT}style-name", "")
            name = around or next(
                (self._styles.outlines[n] for n in chain(style, self._styles.based)
                 if n in self._styles.outlines), "",
            )  # fmt: skip
        return name

    def _list(
        self,
        element: Element,
        into: Element,
        around: _Look,
        depth: int,
        style: str,
        numbers: tuple[str, ...] = (),
    ) -> None:
        """Read a list, within items of these numbers."""
        if depth > DEEPEST:
            put_text(put(into, "p"), "".join(map(str, element.itertext())))
            return
        levels = self._styles.lists.get(style, ())
        level = str(len(numbers) + 1)
        how = next((e for e in levels if e.get(f"{_TEXT}level") == level), None)
        form = "" if how is None else how.get(f"{_STYLE}num-format", "")
        is_bullets = how is None or _name(how) != "list-level-style-number"
        listed = put(into, "ol" if form and not is_bullets else "ul")
        number, shown, suffix = 0, 1, "."
        if how is not None and not is_bullets:
            number = whole(how.get(f"{_TEXT}start-value"), 1) - 1
            shown = whole(how.get(f"{_TEXT}display-levels"), 1)
            suffix = how.get(f"{_STYLE}num-suffix", "")
        if element.get(f"{_TEXT}continue-numbering") == "true":
            number = self._ended.get(style, number)
        prefix = "" if how is None else how.get(f"{_STYLE}num-prefix", "")
        is_simple = shown == 1 and suffix == "." and not prefix
        if listed.tag == "ol" and is_simple:
            listed.set("type", form)
        elif not is_bullets:
            listed.set("style", "list-style: none")
        for item in element:
            if _name(item) not in ("list-item", "list-header"):
                continue
            made = put(listed, "li" if _name(item) == "list-item" else "div")
            if made.tag == "li":
                number = whole(item.get(f"{_TEXT}start-value"), number + 1)
                made.set("value", str(number))
            own = (*numbers, numeral(number, form) if form in {"a", "A", "i", "I"} else str(number))
            if made.tag == "li" and listed.tag == "ol" and not is_simple:
                put_text(made, f"{prefix}{'.'.join(own[-shown:])}{suffix} ")
            for inner in self._within(item):
                if _name(inner) == "list":
                    inner_style = self._list_style(inner, style)
                    self._list(inner, made, around, depth + 1, inner_style, own)
                elif _name(inner) == "table":
                    self._table(inner, made, around, depth + 1)
                elif _name(inner) == "soft-page-break":
                    self._pending += 1
                else:
                    self._paragraph(inner, made, around, depth + 1)
            if len(made) and made[0].tag == "p":
                _open_first(made)
        self._ended[style] = number

    def _table(self, table: Element, into: Element, around: _Look, depth: int) -> None:
        if depth > DEEPEST:
            put_text(put(into, "p"), "".join(map(str, table.itertext())))
            return
        rows = list(self._rows(table, is_head=False))
        cells = [e for row, _ in rows for e in row if _name(e).endswith("table-cell")]
        if len(cells) <= 1:  # a box around its text
            for cell in cells:
                self._blocks(cell, into, around, depth + 1)
            return
        made = put(into, "table")
        for row, is_told in rows:
            is_head = self._is_head = is_told or self._is_heading_row(row)
            line = put(put(made, "thead"), "tr") if is_head else put(made, "tr")
            for cell in row:
                if _name(cell) == "table-cell":
                    self._cell(cell, line, around, depth, is_head=is_head)
        self._is_head = False

    def _is_heading_row(self, row: Element) -> bool:
        """Whether the paragraphs of a row have the style of a table's head."""
        styles = [e.get(f"{_TEXT}style-name", "") for e in row.iter(f"{_TEXT}p")]
        return bool(styles) and all(
            any(name.startswith("Table_20_Heading") for name in chain(style, self._styles.based))
            for style in styles
        )

    def _cell(
        self, cell: Element, line: Element, around: _Look, depth: int, *, is_head: bool
    ) -> None:
        repeated = whole(cell.get(f"{_TABLE}number-columns-repeated"), 1)
        for _ in range(min(repeated, _MOST_REPEATED)):
            made = put(line, "th" if is_head else "td")
            for name, attribute in (("columns", "colspan"), ("rows", "rowspan")):
                span = whole(cell.get(f"{_TABLE}number-{name}-spanned"), 1)
                if span > 1:
                    made.set(attribute, str(span))
            self._blocks(cell, made, around, depth + 1)
            unwrap(made)

    def _rows(self, holder: Element, *, is_head: bool) -> Iterator[tuple[Element, bool]]:
        for element in holder:
            name = _name(element)
            if name == "table-row":
                yield element, is_head
            elif name in ("table-header-rows", "table-rows", "table-row-group"):
                yield from self._rows(element, is_head=is_head or name == "table-header-rows")


def _open_first(item: Element) -> None:
    """Have an item hold the text of its first paragraph, which its number stands before."""
    first = item[0]
    item.text = (item.text or "") + (first.text or "")
    for place, inner in enumerate(list(first)):
        item.insert(place, inner)
    remove(first)


def _read_styles(holders: list[Element]) -> _Styles:
    found = _Styles()
    for holder in holders:
        for style in holder.iter(f"{_STYLE}default-style"):
            if style.get(f"{_STYLE}family") == "paragraph":
                found.usual = _look_of(style)
        for style in holder.iter(f"{_TEXT}list-style"):
            found.lists[style.get(f"{_STYLE}name", "")] = style
        for style in holder.iter(f"{_STYLE}style"):
            name = style.get(f"{_STYLE}name", "")
            found.looks[name] = _look_of(style)
            found.based[name] = style.get(f"{_STYLE}parent-style-name", "")
            if style.get(f"{_STYLE}list-style-name"):
                found.outlines[name] = style.get(f"{_STYLE}list-style-name", "")
            properties = style.find(f"{_STYLE}paragraph-properties")
            broken = properties is not None and properties.get(f"{_FO}break-before") == "page"
            if broken or style.get(f"{_STYLE}master-page-name"):
                found.breaking.add(name)
    own = dict(found.looks)
    for name in own:
        look = _Look()
        for style in reversed(chain(name, found.based)):
            inner = own[style].within(look)
            look = _Look(
                inner.language, inner.tags, own[style].without | look.without, inner.hidden
            )
        found.looks[name] = look
    return found


def _look_of(style: Element) -> _Look:
    properties = style.find(f"{_STYLE}text-properties")
    if properties is None:
        return _Look()
    tags, without = set[str](), set[str]()
    for name, plain, tag in (("font-weight", "normal", "b"), ("font-style", "normal", "i")):
        value = properties.get(f"{_FO}{name}")
        if value is not None:
            is_plain = value == plain or (value.isdigit() and int(value) < 600)
            (without if is_plain else tags).add(tag)
    for name, tag in (("text-underline-style", "u"), ("text-line-through-style", "s")):
        value = properties.get(f"{_STYLE}{name}")
        if value is not None:
            (without if value == "none" else tags).add(tag)
    position = properties.get(f"{_STYLE}text-position", "").split()[:1]
    raised = position[0] if position else ""
    if raised.startswith(("sub", "-")):
        tags.add("sub")
    elif raised == "super" or (raised.rstrip("%").isdigit() and raised != "0%"):
        tags.add("sup")
    tag = tag_of(properties.get(f"{_FO}language"), properties.get(f"{_FO}country"))
    hidden = properties.get(f"{_TEXT}display") == "none"
    return _Look(tag, frozenset(tags), frozenset(without), hidden)


def _name(element: Element) -> str:
    """Name of an element without its namespace; empty for what is none."""
    return element.tag.rpartition("}")[2] if isinstance(element.tag, str) else ""
