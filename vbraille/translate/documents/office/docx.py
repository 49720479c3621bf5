"""A DOCX file as a tree of HTML: styles, lists, tables, notes, links, languages, pages."""

from __future__ import annotations

import re
from collections import Counter
from dataclasses import dataclass, field
from itertools import count
from typing import TYPE_CHECKING

from lxml import etree

from vbraille.translate.documents.markup.tables import numeral
from vbraille.translate.documents.office.formulas import tex_of
from vbraille.translate.documents.office.htmltree import (
    CODES,
    DEEPEST,
    HEADING,
    QUOTES,
    Notes,
    Pictures,
    chain,
    field_target,
    last_of,
    most_frequent,
    primary,
    put,
    put_inner,
    put_page,
    put_text,
    put_unshown,
    remove,
    symbol,
    tag_of,
    told,
    unwrap,
)

if TYPE_CHECKING:
    from collections.abc import Iterator

    from lxml.etree import _Element as Element

    from vbraille.translate.documents.markup.archive import Archive

_RELATION = "{http://schemas.openxmlformats.org/package/2006/relationships}Relationship"
_NUMBERING = {
    "decimal": "1",
    "decimalZero": "1",
    "lowerLetter": "a",
    "upperLetter": "A",
    "lowerRoman": "i",
    "upperRoman": "I",
}
_SHOWING = frozenset(("a", "canvas", "img", "math", "span", "symbol"))  # without text
_BOXES = frozenset("☐☑☒")  # bullets of lists of what is done
_PLACE = re.compile(r"%([1-9])")
_STYLES = {"b": "b", "i": "i", "strike": "s", "dstrike": "s"}
_OFF = frozenset(("0", "false", "none", "off"))
# What is not read: deleted text, what is kept for other programs, properties.
_SKIPPED_NAMES = (
    "del moveFrom delText instrText Fallback pPr rPr sdtPr tblPr trPr tcPr sectPr tblGrid "
    "footnoteRef endnoteRef annotationRef"
)
_SKIPPED = frozenset(_SKIPPED_NAMES.split())


@dataclass(frozen=True, slots=True)
class _Level:
    """How the items of a list's level are numbered, as `w:lvl` has it."""

    form: str
    text: str
    start: int


@dataclass(slots=True)
class _Styles:
    """Paragraph and character styles by their names, and the text without any."""

    found: dict[str, Element] = field(default_factory=dict)
    based: dict[str, str] = field(default_factory=dict)
    usual: str = ""  # language


def read_docx(archive: Archive) -> tuple[Element, str, str]:
    """Read a DOCX file.

    Returns
    -------
    root
        Root of the tree of HTML.
    title, language
        Title, and tag of the language that most of the text is in; empty if it does not say.

    Raises
    ------
    InputError
        If a part that is needed is missing, damaged or too large.
    """
    return _Reader(archive).read()


class _Reader:
    """Reads one document."""

    def __init__(self, archive: Archive) -> None:
        self._archive = archive
        self._member = self._main()
        self._root = archive.xml(self._member)
        self._word = f"{{{etree.QName(self._root).namespace or ''}}}"
        folder = self._member.rpartition("/")[0]
        self._notes_of = {
            kind: self._part(f"{folder}/{kind}s.xml") for kind in ("footnote", "endnote")
        }
        self._links = self._relations(f"{folder}/_rels/{self._member.rpartition('/')[2]}.rels")
        self._note_links = {
            kind: self._relations(f"{folder}/_rels/{kind}s.xml.rels")
            for kind in ("footnote", "endnote")
        }
        self._styles = self._read_styles(self._part(f"{folder}/styles.xml"))
        self._levels = self._read_numbering(self._part(f"{folder}/numbering.xml"))
        self._counters: dict[str, Counter[int]] = {}
        self._is_head = False  # of a table
        self._around: list[Element] = []  # styles of the paragraph
        self._lists: list[Element] = []  # open lists and items, by level
        self._pictures = Pictures()
        self._notes = Notes()
        self._fields: list[str] = []  # instructions of the fields around the run
        self._formed: list[Element] = []  # elements in which links of fields are

    def read(self) -> tuple[Element, str, str]:
        about = self._part("docProps/core.xml")
        usual = self._styles.usual or told(about, "language")
        roots = [self._root, *(root for root in self._notes_of.values() if root is not None)]
        counted = Counter[str]()
        for root in roots:
            for paragraph in root.iter(f"{self._word}p"):
                around = self._language_of(paragraph, "pPr/pStyle") or usual
                for run in paragraph.iter(f"{self._word}r"):
                    tag = self._language(run) or around
                    counted[tag] += sum(len(t.text or "") for t in run.iter(f"{self._word}t"))
        self._most = most_frequent(counted, usual)
        self._usual = usual
        self._is_laid_out = next(self._root.iter(f"{self._word}lastRenderedPageBreak"), None)
        start = self._root.find(f".//{self._way('sectPr/pgNumType')}")
        number = "" if start is None else start.get(f"{self._word}start", "")
        self._pages = count(int(number) + 1 if number.isascii() and number.isdigit() else 2)
        html = etree.Element("html")
        body = put(html, "body")
        self._blocks(self._root, body)
        for identity, item in self._notes.section(body):
            kind, _, number = identity.partition("-")
            root = self._notes_of[kind]
            self._lists, self._links = [], self._note_links[kind]
            for note in () if root is None else root.iterfind(f"{self._word}{kind}"):
                if note.get(f"{self._word}id") == number:
                    self._blocks(note, item)
        return html, told(about, "title"), self._most

    def _main(self) -> str:
        """Name of the member with the text."""
        if "_rels/.rels" in self._archive:
            for relation in self._archive.xml("_rels/.rels").iter(_RELATION):
                target = relation.get("Target", "").lstrip("/")
                if relation.get("Type", "").endswith("/officeDocument") and target in self._archive:
                    return target
        return "word/document.xml"

    def _part(self, member: str) -> Element | None:
        return self._archive.xml(member) if member in self._archive else None

    def _relations(self, member: str) -> dict[str, str]:
        root = self._part(member)
        found = () if root is None else root.iter(_RELATION)
        return {relation.get("Id", ""): relation.get("Target", "") for relation in found}

    def _way(self, path: str) -> str:
        """Way of names with the document's namespace, of which there are two."""
        return "/".join(f"{self._word}{name}" for name in path.split("/"))

    def _value(self, holder: Element | None, path: str) -> str | None:
        """Value of an element on a way of names; "" if it has none, None if it is not there."""
        found = None if holder is None else holder.find(self._way(path))
        return None if found is None else found.get(f"{self._word}val", "")

    def _read_styles(self, root: Element | None) -> _Styles:
        styles = _Styles()
        if root is None:
            return styles
        for style in root.iter(f"{self._word}style"):
            name = style.get(f"{self._word}styleId", "")
            styles.found[name] = style
            styles.based[name] = self._value(style, "basedOn") or ""
        default = root.find(self._way("docDefaults/rPrDefault/rPr/lang"))
        styles.usual = "" if default is None else tag_of(default.get(f"{self._word}val"))
        return styles

    def _read_numbering(self, root: Element | None) -> dict[str, dict[int, _Level]]:
        """Levels of lists, by the numbers of these."""
        if root is None:
            return {}
        word = self._word
        abstract = {e.get(f"{word}abstractNumId"): e for e in root.iter(f"{word}abstractNum")}
        found = {}
        for number in root.iter(f"{word}num"):
            levels: dict[int, _Level] = {}
            holders = [abstract.get(self._value(number, "abstractNumId"))]
            holders += number.iterfind(f"{word}lvlOverride")
            for holder in holders:
                for level in () if holder is None else holder.iterfind(f"{word}lvl"):
                    levels[_whole(level.get(f"{word}ilvl"), 0)] = _Level(
                        self._value(level, "numFmt") or "decimal",
                        self._value(level, "lvlText") or "",
                        _whole(self._value(level, "start"), 1),
                    )
                start = self._value(holder, "startOverride")
                at = 0 if holder is None else _whole(holder.get(f"{word}ilvl"), 0)
                if start is not None and at in levels:
                    levels[at] = _Level(levels[at].form, levels[at].text, _whole(start, 1))
            found[number.get(f"{word}numId", "")] = levels
        return found

    def _chain(self, holder: Element, path: str) -> list[Element]:
        """Properties of a paragraph or a run, and then of its styles."""
        name = self._value(holder, path)
        found = [holder]
        if name is not None:
            found += [self._styles.found[n] for n in chain(name, self._styles.based)]
        return found

    def _language(self, run: Element) -> str:
        return self._language_of(run, "rPr/rStyle")

    def _language_of(self, holder: Element, path: str) -> str:
        for properties in self._chain(holder, path):
            found = properties.find(self._way("rPr/lang"))
            tag = "" if found is None else tag_of(found.get(f"{self._word}val"))
            if tag:
                return tag
        return ""

    def _blocks(self, holder: Element, into: Element, depth: int = 0) -> None:
        """Read the blocks of a body, of a cell or of a note."""
        if depth > DEEPEST:
            put_text(put(into, "p"), "".join(t.text or "" for t in holder.iter(f"{self._word}t")))
            return
        outer, self._lists = self._lists, []
        pending: list[Element] = []  # bookmarks between paragraphs, which are those of the next
        for element in self._within(holder):
            name = _name(element)
            if name == "bookmarkStart":
                pending.append(element)
            elif name == "p":
                self._paragraph(element, into, depth, pending)
                pending = []
            elif name == "tbl":
                self._lists = []
                self._table(element, into, depth)
        self._lists = outer

    def _within(self, holder: Element) -> Iterator[Element]:
        """Paragraphs, tables and bookmarks, whatever holds them."""
        for element in holder:
            name = _name(element)
            if name in ("p", "tbl", "bookmarkStart"):
                yield element
            elif name not in _SKIPPED and name:
                yield from self._within(element)

    def _paragraph(self, element: Element, into: Element, depth: int, marks: list[Element]) -> None:
        chained = self._chain(element, "pPr/pStyle")
        title = next((self._value(s, "name") or "" for s in chained[1:2]), "").lower()
        kinds = [(self._value(style, "name") or "").lower() for style in chained[1:]]
        level = self._heading_level(chained, title)
        number, at = self._listed(chained)
        listing = self._levels.get(number, {}).get(at)
        is_quote = not QUOTES.isdisjoint(kinds)
        label = ""
        if level:
            self._lists = []
            block = put(into, f"h{min(level, 6)}")
            if listing is not None and listing.form not in ("bullet", "none"):
                label = f"{self._label(number, at, listing)} "
        elif listing is not None:
            block, label = self._item(into, number, at, listing)
        else:
            self._lists = []
            inner = into
            if is_quote:
                last = last_of(into)
                is_same = last is not None and last.tag == "blockquote"
                inner = last if last is not None and is_same else put(into, "blockquote")
            block = put(inner, "p" if CODES.isdisjoint(kinds) else "pre")
        self._around = chained[1:]
        for mark in marks:
            self._bookmark(mark, block)
        if self._value(element, "pPr/pageBreakBefore") == "" and self._is_laid_out is None:
            put_page(block)
        common = (
            self._common_style(element) if level or is_quote or self._is_head else frozenset[str]()
        )
        language = self._language_of(element, "pPr/pStyle") or self._usual
        put_text(block, label)
        self._runs(element, block, common, language, depth)
        shows = any(inner.tag in _SHOWING for inner in block.iter())
        is_empty = not shows and not "".join(map(str, block.itertext())).strip()
        is_caption = listing is None and not level and self._pictures.repeats(block)
        if is_caption or (is_empty and block.tag != "li"):
            remove(block)

    def _heading_level(self, chained: list[Element], title: str) -> int:
        """Level of a heading; 0 for what is none."""
        if title in ("title", "titel", "titre"):
            return 1
        for properties in chained:
            found = HEADING.search(self._value(properties, "name") or "")
            outline = self._value(properties, "pPr/outlineLvl")
            if found is not None:
                return int(found[1])
            if outline is not None and outline.isdigit():
                return int(outline) + 1 if int(outline) < 9 else 0
        return 0

    def _listed(self, chained: list[Element]) -> tuple[str, int]:
        """Number of a paragraph's list, and its level in that; "0" if it is in none."""
        number, at = None, None
        for properties in chained:
            number = self._value(properties, "pPr/numPr/numId") if number is None else number
            at = self._value(properties, "pPr/numPr/ilvl") if at is None else at
        return number or "0", min(_whole(at, 0), 8)

    def _item(self, into: Element, number: str, at: int, level: _Level) -> tuple[Element, str]:
        """Begin an item of a list, or go on with one; give its element and what stands before it.

        An item whose bullet is blank is a further paragraph of the one before.
        """
        if level.form == "none" or (level.form == "bullet" and not level.text.strip()):
            if self._lists:
                return put(self._lists[min(at, len(self._lists) - 1)], "p"), ""
            return put(into, "p"), ""
        name = "ol" if level.form in _NUMBERING else "ul"
        listed = self._lists[at].getparent() if at < len(self._lists) else None
        if listed is not None and listed.get("class") != number:
            listed = None
        del self._lists[at:]
        while len(self._lists) < at:  # levels that are left out
            self._lists.append(self._lists[-1] if self._lists else into)
        is_simple = (name == "ul" and level.text not in _BOXES) or level.text == f"%{at + 1}."
        if listed is None:
            listed = put(self._lists[-1] if self._lists else into, name, class_=number)
            if not is_simple:
                listed.set("style", "list-style: none")
            elif name == "ol":
                listed.set("type", _NUMBERING[level.form])
        item = put(listed, "li")
        self._lists.append(item)
        label = self._label(number, at, level)
        if level.text in _BOXES:
            return item, f"{level.text} "
        if is_simple and name == "ol":
            item.set("value", str(self._counters[number][at]))
        return item, "" if is_simple else f"{label} "

    def _label(self, number: str, at: int, level: _Level) -> str:
        """Count an item of a list, and give the number that stands before it."""
        counter = self._counters.setdefault(number, Counter())
        counter[at] = counter.get(at, level.start - 1) + 1
        for deeper in [other for other in counter if other > at]:
            del counter[deeper]

        def numbered(found: re.Match[str]) -> str:
            place = int(found[1]) - 1
            one = self._levels[number].get(place, level)
            return numeral(counter.get(place, one.start), _NUMBERING.get(one.form, "1"))

        return _PLACE.sub(numbered, level.text)

    def _table(self, table: Element, into: Element, depth: int) -> None:
        rows = list(self._all(table, "tr"))
        grid = [self._cells(row) for row in rows]
        if sum(map(len, grid)) <= 1:  # a box around its text
            for cell, _, _ in (cell for row in grid for cell in row):
                self._blocks(cell, into, depth + 1)
            return
        look = table.find(self._way("tblPr/tblLook"))
        looks = {} if look is None else {_name_of(k): str(v) for k, v in look.items()}
        first = looks.get("firstRow", str(_whole(looks.get("val"), 0, base=16) >> 5 & 1))
        has_head = first not in _OFF and len(rows) > 1
        made = put(into, "table")
        for number, (row, cells) in enumerate(zip(rows, grid, strict=True)):
            flag = self._value(row, "trPr/tblHeader")
            is_head = flag not in _OFF if flag is not None else number == 0 and has_head
            self._is_head = is_head
            line = put(put(made, "thead"), "tr") if is_head else put(made, "tr")
            if cells and cells[0][1]:
                put(line, "td", colspan=str(cells[0][1]))
            for cell, column, span in cells:
                merge = self._value(cell, "tcPr/vMerge")
                if merge is not None and merge != "restart":
                    continue
                made_cell = put(line, "th" if is_head else "td")
                if span > 1:
                    made_cell.set("colspan", str(span))
                if merge == "restart":
                    made_cell.set("rowspan", str(self._rows_of(grid, number, column)))
                self._blocks(cell, made_cell, depth + 1)
                unwrap(made_cell)
        self._is_head = False

    def _all(self, holder: Element, name: str) -> Iterator[Element]:
        """Elements of a name, whatever holds them within."""
        for element in holder:
            if _name(element) == name:
                yield element
            elif _name(element) not in _SKIPPED and _name(element):
                yield from self._all(element, name)

    def _cells(self, row: Element) -> list[tuple[Element, int, int]]:
        """Cells of a row, each with its first column and its number of columns."""
        found = []
        column = _whole(self._value(row, "trPr/gridBefore"), 0)
        for cell in self._all(row, "tc"):
            span = max(_whole(self._value(cell, "tcPr/gridSpan"), 1), 1)
            found.append((cell, column, span))
            column += span
        return found

    def _rows_of(self, grid: list[list[tuple[Element, int, int]]], number: int, column: int) -> int:
        """Number of rows that a cell goes through."""
        rows = 1
        for cells in grid[number + 1 :]:
            below = next((cell for cell, at, _ in cells if at == column), None)
            merge = None if below is None else self._value(below, "tcPr/vMerge")
            if merge is None or merge == "restart":
                break
            rows += 1
        return rows

    def _common_style(self, paragraph: Element) -> frozenset[str]:
        """Emphasis of all the text of a paragraph, which is its style's."""
        styles = [
            frozenset(self._emphasis(run))
            for run in paragraph.iter(f"{self._word}r")
            if any((text.text or "").strip() for text in run.iter(f"{self._word}t"))
        ]
        return frozenset.intersection(*styles) if styles else frozenset()

    def _emphasis(self, run: Element) -> list[str]:
        """Names of HTML's elements for how a run looks."""
        chained = [*self._chain(run, "rPr/rStyle"), *self._around]
        found: list[str] = []
        for name, tag in _STYLES.items():
            values = (self._value(properties, f"rPr/{name}") for properties in chained)
            value = next((value for value in values if value is not None), "0")
            if value not in _OFF and tag not in found:
                found.append(tag)
        line = self._value(run, "rPr/u")
        found += ["u"] if line not in (None, "", "none") else []
        small = next((v for c in chained if (v := self._value(c, "rPr/vertAlign"))), "")
        found += {"superscript": ["sup"], "subscript": ["sub"]}.get(small or "", [])
        return found

    def _runs(
        self,
        holder: Element,
        into: Element,
        common: frozenset[str],
        language: str,
        depth: int,
        *,
        in_link: bool = False,
    ) -> None:
        """Read what is in a paragraph, or in a link."""
        for element in holder:
            name = _name(element)
            if name == "r":
                at = self._formed[-1] if self._formed else into
                self._run(element, at, common, language, depth, in_link=in_link)
            elif name == "hyperlink":
                named = {_name_of(key): str(value) for key, value in element.items()}
                anchor = element.get(f"{self._word}anchor")
                address = self._links.get(named.get("id", ""), "") + (
                    f"#{anchor}" if anchor else ""
                )
                link = put(into, "a", href=address) if address else into
                self._runs(element, link, common, language, depth, in_link=True)
            elif name == "bookmarkStart":
                self._bookmark(element, into)
            elif name in ("oMath", "oMathPara"):
                put(into, "math", alttext=tex_of(element))
            elif name == "fldSimple":
                self._fields.append(element.get(f"{self._word}instr", ""))
                link = self._link_of_field(into)
                self._runs(element, link, common, language, depth, in_link=link is not into)
                self._fields.pop()
            elif name and name not in _SKIPPED:
                self._runs(element, into, common, language, depth, in_link=in_link)

    def _bookmark(self, mark: Element, into: Element) -> None:
        name = mark.get(f"{self._word}name", "")
        if name != "_GoBack":  # where the author wrote last
            put(into, "a", id=name)

    def _link_of_field(self, into: Element) -> Element:
        """Put the link that a field makes of its text; the same element if it makes none."""
        target = field_target(self._fields[-1])
        return put(into, "a", href=target) if target else into

    def _run(
        self,
        run: Element,
        into: Element,
        common: frozenset[str],
        around: str,
        depth: int,
        *,
        in_link: bool,
    ) -> None:
        """Read a run of text that looks the same."""
        chained = self._chain(run, "rPr/rStyle")
        hidden = next((v for c in chained if (v := self._value(c, "rPr/vanish")) is not None), "0")
        is_hidden = hidden not in _OFF
        tag = self._language(run) or around
        language = tag if tag and primary(tag) != primary(self._most) else ""
        without = common | {"u"} if in_link else common
        inner: Element | None = None
        for element in run:
            name = _name(element)
            if name == "fldChar":
                self._field(element, into)
                into = self._formed[-1] if self._formed else into
                inner = None
            elif name == "instrText" and self._fields:
                self._fields[-1] += element.text or ""
            elif is_hidden or not name:
                continue
            elif (text := self._text_of(element, name)) is not None:
                if inner is None:
                    inner = put_inner(into, self._emphasis(run), language, without=without)
                put_text(inner, text)
            else:
                inner = None
                self._thing(element, name, into, depth)

    def _text_of(self, element: Element, name: str) -> str | None:
        """Characters that an element of a run stands for; None for what is no text."""
        if name == "t":
            return element.text or ""
        if name in ("noBreakHyphen", "softHyphen"):
            return "\u2011" if name == "noBreakHyphen" else ""
        if name in ("tab", "ptab"):
            return "\t"
        if name == "sym":
            code = _whole(element.get(f"{self._word}char"), 0, base=16)
            return symbol(code, element.get(f"{self._word}font", "")) or None
        return None

    def _thing(self, element: Element, name: str, into: Element, depth: int) -> None:
        """Read what stands in a run and is no text."""
        word = self._word
        if name in ("footnoteReference", "endnoteReference"):
            kind = name.removesuffix("Reference")
            self._notes.refer(into, f"{kind}-{element.get(f'{word}id', '')}")
        elif name == "lastRenderedPageBreak":
            put_page(into, str(next(self._pages)))
        elif name in ("br", "cr"):
            if element.get(f"{word}type") != "page":
                put(into, "br")
            elif self._is_laid_out is None:
                put_page(into)
        elif name == "sym":
            put_unshown(into, "symbol")
        elif name in ("drawing", "pict", "object"):
            self._drawing(element, name, into, depth)
        elif name == "ruby":
            base, above = element.find(f"{word}rubyBase"), element.find(f"{word}rt")
            texts = [
                "".join(t.text or "" for t in part.iter(f"{word}t")) if part is not None else ""
                for part in (base, above)
            ]
            put(put(into, "ruby", texts[0]), "rt", texts[1])
        elif name == "AlternateContent":
            # What this program knows, or else what is there for older ones.
            choices = [inner for choice in list(element)[:1] for inner in choice]
            if all(_name(inner) not in ("drawing", "pict", "object") for inner in choices):
                choices = [inner for inner in element.iter() if _name(inner) in ("t", "sym")]
            for inner in choices:
                if (text := self._text_of(inner, _name(inner))) is not None:
                    put_text(into, text)
                else:
                    self._thing(inner, _name(inner), into, depth)

    def _field(self, mark: Element, into: Element) -> None:
        """Begin a field, its text, or its end."""
        kind = mark.get(f"{self._word}fldCharType")
        if kind == "begin":
            self._fields.append("")
            box = mark.find(f"{self._word}ffData/{self._word}checkBox")
            if box is not None:
                value = self._value(box, "checked")
                value = self._value(box, "default") if value is None else value
                put_text(into, "☐" if value is None or value in _OFF else "☑")
        elif kind == "separate" and self._fields:
            link = self._link_of_field(into)
            if link is not into:
                self._formed.append(link)
        elif kind == "end" and self._fields:
            words = self._fields.pop().split()
            if self._formed and words and words[0].upper() == "HYPERLINK":
                self._formed.pop()

    def _drawing(self, element: Element, name: str, into: Element, depth: int) -> None:
        """Read a picture by its text, a box by what is in it; mark all else."""
        box = next(element.iter(f"{self._word}txbxContent"), None)
        if box is not None:
            self._blocks(box, put(into, "div"), depth + 1)
            return
        kinds = [e.get("uri", "") for e in element.iter("{*}graphicData")]
        described = next(
            (e.get("descr") or "" for e in element.iter("{*}docPr")),
            next((e.get("alt") or "" for e in element.iter("{*}shape")), ""),
        )
        has_picture = any(True for _ in element.iter("{*}pic", "{*}imagedata"))
        if described.strip():
            put(into, "img", alt=described.strip())
        elif name == "object":
            put_unshown(into, "embedded object")
        elif any("/chart" in kind for kind in kinds):
            put_unshown(into, "chart")
        elif any(kind.endswith("/diagram") for kind in kinds):
            put_unshown(into, "diagram")
        else:
            put_unshown(into, "picture" if has_picture else "drawing")


def _name(element: Element) -> str:
    """Name of an element without its namespace; empty for what is none."""
    return _name_of(element.tag) if isinstance(element.tag, str) else ""


def _name_of(tag: object) -> str:
    return str(tag).rpartition("}")[2]


def _whole(text: str | None, otherwise: int, base: int = 10) -> int:
    try:
        return int(text or "", base) if len(text or "") < 9 else otherwise
    except ValueError:
        return otherwise
