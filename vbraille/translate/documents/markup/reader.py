"""A tree of HTML or DTBook as passages: what each element begins, and what its attributes say."""

from __future__ import annotations

from dataclasses import replace
from pathlib import PurePosixPath
from typing import TYPE_CHECKING, NamedTuple
from urllib.parse import unquote

from vbraille.translate.documents.markup import attributes as attribute
from vbraille.translate.documents.markup.tables import BULLET, ListNumbers, numbering_of, whole
from vbraille.translate.documents.markup.writing import Writing
from vbraille.translate.source import BlockKind, MarkKind

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping, Sequence

    from lxml.etree import _Element as Element

    from vbraille.translate.documents.chapters import Passage

    Steps = Iterator[None]  # between which passages may be taken
    Handler = Callable[["MarkupReader", "Begun"], Steps]

# Elements within others that are read by their roles; what is deeper only begins and ends blocks.
_DEEPEST = 120
_DEEPEST_LISTS = 64  # lists in lists, quotations in quotations
_PIECE = 65_536  # characters of a text that are read at a time
_LONGEST_ASIDE = 65_536  # characters of a title or a formula
_LONGEST_NUMBER = 40  # characters of a page's number; more is text
_BACK = frozenset("↩↑⏎←⤴^\ufe0e\ufe0f \u00a0")  # what a link back from a note shows
# Elements that are shown though they are said to be hidden: a page would be empty otherwise, and
# a caption is hidden where it says the same as its picture, which `Writing` finds out.
_SHOWN = frozenset(("html", "body", "figcaption"))
_ROOTS = frozenset(("html", "body", "dtbook"))
# Text of these is not for a reader, or is told elsewhere.
_DROPPED_NAMES = (
    "script style template noscript rp datalist param source track iframe noframes noembed"
)
_DROPPED = frozenset(_DROPPED_NAMES.split())
_BLOCKS_NAMES = (
    "address article aside blockquote body caption center dd details dialog dir div dl dt "
    "fieldset figcaption figure footer form frameset h1 h2 h3 h4 h5 h6 header hgroup hr html "
    "legend li listing main menu nav ol optgroup p plaintext pre search section summary table "
    "tbody tfoot thead title tr ul xmp"
)
BLOCKS = frozenset(_BLOCKS_NAMES.split())
_DTBOOK_NAMES = (
    "annotation author bodymatter book bridgehead byline covertitle dateline docauthor "
    "doctitle epigraph frontmatter hd imggroup level level1 level2 level3 level4 level5 "
    "level6 line linegroup list note poem prodnote rearmatter sidebar"
)
DTBOOK_BLOCKS = BLOCKS | frozenset(_DTBOOK_NAMES.split())
_DTBOOK_SECTIONS = frozenset(("level", *(f"level{level}" for level in range(1, 7))))
_HEADINGS = {f"h{level}": level for level in range(1, 7)}
_EMPHASES = {
    **dict.fromkeys(("em", "i", "cite", "dfn", "var"), MarkKind.ITALIC),
    **dict.fromkeys(("strong", "b"), MarkKind.BOLD),
    **dict.fromkeys(("u", "ins"), MarkKind.UNDERLINE),
    **dict.fromkeys(("code", "kbd", "samp", "tt"), MarkKind.CODE),
    "sup": MarkKind.SUPERSCRIPT,
    "sub": MarkKind.SUBSCRIPT,
}
_STYLES = {
    "font-style:italic": MarkKind.ITALIC,
    "font-style:oblique": MarkKind.ITALIC,
    "font-weight:bold": MarkKind.BOLD,
    "text-decoration:underline": MarkKind.UNDERLINE,
    "vertical-align:super": MarkKind.SUPERSCRIPT,
    "vertical-align:sub": MarkKind.SUBSCRIPT,
}
_SMALL = {kind.value: kind for kind in (MarkKind.SUPERSCRIPT, MarkKind.SUBSCRIPT)}
_UNSHOWN = {
    "canvas": ("drawing", "drawing"),
    "audio": ("sound", "sound"),
    "bgsound": ("sound", "sound"),
    "video": ("film", "film"),
    "object": ("embedded object", "object"),
    "embed": ("embedded object", "object"),
    "applet": ("embedded object", "object"),
    "symbol": ("symbol", "symbol"),  # of word processors, not of HTML
}
_EMPTY = frozenset(("br", "hr", "img"))
_BUTTONS = frozenset(("submit", "reset", "button"))
# HTML in a drawing, by which its author, or a parser that mends a mistake, leaves the drawing.
_HTML_NAMES = (
    "b big blockquote body br center code dd div dl dt em embed h1 h2 h3 h4 h5 h6 head hr i "
    "img li listing menu meta nobr ol p pre ruby s small span strong strike sub sup table tt "
    "u ul var"
)
_HTML = frozenset(_HTML_NAMES.split())
# A formula of only these is a row of signs.
_LINEAR = frozenset(
    ("math", "mrow", "mi", "mn", "mo", "mtext", "mspace", "mstyle", "semantics", "none")
)
_NOTHING: dict[str, str] = {}


class Begun(NamedTuple):
    """An element that is read.

    Parameters
    ----------
    element
        The element.
    name
        Name of the element, in lower case, without a namespace.
    found
        Attributes that are known here.
    """

    element: Element
    name: str
    found: Mapping[str, str]


class MarkupReader:
    """Makes passages of a tree, or of a part of it.

    Parameters
    ----------
    resolve
        What makes a mark's target of the address in a link.
    prefix
        What comes before the name of each anchor, such as the name of a book's chapter and "#".
    anchors
        Names by which the first passage is found.
    language
        Tag of the language of the whole source; blocks in it say nothing of their language.
    is_dtbook
        Whether the names of elements are those of DTBook.
    spell
        What spells the text that is not the document's own, as the document is spelt.
    pages
        Numbers of pages of the printed book that begin at anchors, by the anchors' names.
    """

    def __init__(
        self,
        resolve: Callable[[str], str] = str,
        prefix: str = "",
        anchors: tuple[str, ...] = (),
        language: str = "",
        *,
        is_dtbook: bool = False,
        spell: Callable[[str], str] = str,
        pages: Mapping[str, str] = _NOTHING,
    ) -> None:
        self.writing = Writing(anchors, language, spell, resolve)
        self._resolve = resolve
        self._prefix = prefix
        self._listed = pages
        self._number = ""  # of the page that was begun last
        self._handlers = _DTBOOK if is_dtbook else _HANDLERS
        self._blocks = DTBOOK_BLOCKS if is_dtbook else BLOCKS
        self._sections = _DTBOOK_SECTIONS if is_dtbook else frozenset[str]()
        self._depth = 0
        for anchor in anchors:
            self._begin_listed(anchor)

    def read(
        self, root: Element, first: Sequence[int] = (), last: Sequence[int] = ()
    ) -> Iterator[Passage]:
        """Read a tree.

        Parameters
        ----------
        root
            Root of the tree.
        first, last
            Ways to the first element that is read, and to the one before which reading ends: the
            index of each element on the way in the one around it. Empty for the whole tree.
        """
        self.writing.has_written = bool(first)
        for _ in self._element(root, tuple(first), tuple(last)):
            yield from self.writing.take()
        self.writing.close()
        yield from self.writing.take()
        yield from self.writing.take_last()

    def _element(
        self, element: Element, first: tuple[int, ...] = (), last: tuple[int, ...] = ()
    ) -> Steps:
        """Read an element, without the text after it."""
        writing = self.writing
        name = attribute.named(element.tag)
        found = attribute.known(element.items())
        if not _is_shown(name, found):
            if name == "iframe":
                writing.unshown("embedded page", "page")
            return
        if self._depth >= _DEEPEST:
            yield from self._flat(element)
            return
        is_block = name in self._blocks
        if is_block:
            writing.begin_block()
        before = writing.place, writing.flow.language
        self._depth += 1
        if found:
            yield from self._with_attributes(element, name, found, (first, last), is_block=is_block)
        else:
            yield from self._by_name(element, name, found, (first, last))
        if is_block:
            writing.begin_block()
        writing.place, writing.flow.language = before
        self._depth -= 1

    def _with_attributes(
        self,
        element: Element,
        name: str,
        found: Mapping[str, str],
        part: tuple[tuple[int, ...], tuple[int, ...]],
        *,
        is_block: bool,
    ) -> Steps:
        """Read an element by what its attributes say, and by its name."""
        writing, flow = self.writing, self.writing.flow
        roles = attribute.roles(found)
        if (
            name == "pagenum"
            or "page" in roles
            or ("page?" in roles and name in {"span", "a"} and "id" in found)
        ):
            self._page(element, found)
            return
        if "back" in roles:
            return
        identity = found.get("id") or (found.get("name") if name == "a" else None)
        if identity and not part[0]:
            self._begin_listed(self._prefix + identity)
            writing.anchor(self._prefix + identity)
        language = attribute.language(found)
        if language is not None:
            self._begin_language(name, language, is_block=is_block)
        label = " ".join((found.get("aria-label") or "").split())
        if name != "img" and "img" in roles and label:
            writing.picture(label)
            return
        if "presentation" in roles and name == "img":
            return
        apart = False
        if "heading" in roles and name not in _HEADINGS:
            apart = True
            writing.begin_block()
            self._begin_heading(whole(found.get("aria-level"), 2))
        if "note" in roles:
            apart = True
            writing.begin_block()
            self._begin_note()
        if "notes" in roles:
            writing.place = replace(writing.place, in_notes=True)
        if "noteref" in roles and name != "a":
            writing.place = replace(writing.place, refers=True)
        marks = [(kind, "") for kind in _styled(found)]
        if name == "span":  # a paragraph's class of these names is a title's
            marks += ((kind, "") for role, kind in _SMALL.items() if role in roles)
        link = self._link(name, found, roles)
        marks += [link] if link is not None else []
        start = flow.length
        for kind, target in marks:
            flow.open(kind, target)
        yield from self._by_name(element, name, found, part)
        if apart:
            writing.begin_block()
        for kind, _ in reversed(marks):
            flow.close(kind)
        if link is not None and (writing.place.is_note or writing.place.in_notes):
            if 0 < flow.length - start < 8 and _BACK.issuperset(flow.since(start)):
                flow.cut(start)
        elif "number" in roles:  # a note's own, which leads back
            flow.blank()

    def _by_name(
        self,
        element: Element,
        name: str,
        found: Mapping[str, str],
        part: tuple[tuple[int, ...], tuple[int, ...]] = ((), ()),
    ) -> Steps:
        """Read an element by its name."""
        handler = self._handlers.get(name)
        kind = _EMPHASES.get(name)
        if handler is not None:
            yield from handler(self, Begun(element, name, found))
        elif kind is not None:
            self.writing.flow.open(kind)
            yield from self.inside(element)
            self.writing.flow.close(kind)
        else:
            if name in self._sections:
                place = self.writing.place
                sections = int(name[5:]) if name[5:].isdigit() else place.sections + 1
                self.writing.place = replace(place, sections=sections)
            yield from self.inside(element, *part)

    def inside(
        self, element: Element, first: tuple[int, ...] = (), last: tuple[int, ...] = ()
    ) -> Steps:
        """Read what is in an element: its text, and its elements with the text after each."""
        if not first and element.text:
            yield from self._text(element.text)
        for index, child in enumerate(element):
            if first and index < first[0]:
                continue
            is_last = bool(last) and index == last[0]
            if is_last and len(last) == 1:
                return
            begins = first[1:] if first and index == first[0] else ()
            yield from self._element(child, begins, last[1:] if is_last else ())
            if is_last:
                return
            if child.tail:
                yield from self._text(child.tail)
            yield

    def _text(self, text: str) -> Steps:
        for start in range(0, len(text), _PIECE):
            self.writing.write(text[start : start + _PIECE])
            yield

    def _flat(self, element: Element) -> Steps:
        """Read what is too deep for roles: its text, and where its blocks begin and end."""
        from lxml import etree

        walk = etree.iterwalk(element, events=("start", "end"))
        for event, found in walk:
            name = attribute.named(found.tag)
            if event == "start" and not _is_shown(name, attribute.known(found.items())):
                walk.skip_subtree()
                continue
            if name in self._blocks:
                self.writing.begin_block()
            if name in _EMPTY and event == "start":
                at = Begun(found, name, attribute.known(found.items()))
                yield from self._handlers[name](self, at)
            text = found.text if event == "start" else found.tail if found is not element else None
            if text:
                yield from self._text(text)

    def _begin_heading(self, level: int) -> None:
        writing = self.writing
        writing.lay_out_table()
        writing.place = replace(writing.place, kind=BlockKind.HEADING, level=max(level, 1))

    def _begin_note(self) -> None:
        place = self.writing.place
        self.writing.place = replace(place, kind=BlockKind.NOTE, level=0, is_note=True)

    def _begin_language(self, name: str, tag: str, *, is_block: bool) -> None:
        """Have the next text be in a language."""
        writing = self.writing
        tag = tag.replace("_", "-")
        if name in _ROOTS:
            writing.given = writing.given or tag
        writing.flow.language = writing.same(tag)
        if is_block or name in _ROOTS:
            writing.place = replace(writing.place, language=writing.flow.language)

    def _link(
        self, name: str, found: Mapping[str, str], roles: frozenset[str]
    ) -> tuple[MarkKind, str] | None:
        """Mark of a link or of a reference to a note; None if the element is neither."""
        if name not in {"a", "noteref", "annoref"} or "number" in roles:
            return None
        address = attribute.target(found)
        if not address:
            return None
        is_note = "noteref" in roles or name != "a" or self.writing.place.refers
        return MarkKind.NOTE if is_note else MarkKind.LINK, self._resolve(address)

    def _begin_listed(self, anchor: str) -> None:
        """Begin a page that the book's list of pages has here, unless the text has it already."""
        number = self._listed.get(anchor, "")
        if number not in ("", self._number) and len(number) < _LONGEST_NUMBER:
            self._number = number
            self.writing.page(number, ())

    def _page(self, element: Element, found: Mapping[str, str]) -> None:
        """Begin a page of the printed book, whose number may be the element's text."""
        told = found.get("title") or found.get("aria-label") or found.get("value") or ""
        anchors = (self._prefix + found["id"],) if found.get("id") else ()
        listed = self._listed.get(anchors[0], "") if anchors else ""
        inside = all_text(element)
        number = " ".join(told.split()) or inside
        if number.lower().startswith("page "):
            number = number[5:].strip(" .")
        self._number = number = number or listed
        self.writing.page(number if len(number) < _LONGEST_NUMBER else "", anchors)
        if len(inside) >= _LONGEST_NUMBER:
            self.writing.write(f" {inside} ")


def title_and_language(root: Element) -> tuple[str, str]:
    """Title that a document gives itself, and the tag of its language; empty if it says none."""
    title = told = ""
    languages: list[str] = []
    for element in root.iter("{*}title", "{*}meta", *(f"{{*}}{name}" for name in _ROOTS)):
        name, found = attribute.named(element.tag), attribute.known(element.items())
        content = " ".join(found.get("content", "").split())
        if name == "title":
            title = title or ("" if _is_in_drawing(element) else all_text(element))
        elif name != "meta":
            languages.append(attribute.language(found) or "")
        elif found.get("name", "").lower() == "dc:title":
            title = content or title
        elif found.get("name", "").lower() in ("dc:language", "dcterms.language"):
            told = told or content
    return title, next(filter(None, [*languages, told]), "").replace("_", "-")


def _is_in_drawing(element: Element) -> bool:
    around = element.getparent()
    return around is not None and attribute.named(around.tag) == "svg"


def all_text(element: Element) -> str:
    """All text in an element, with white space folded."""
    return " ".join("".join(map(str, element.itertext())).split())[:_LONGEST_ASIDE]


def _is_shown(name: str, found: Mapping[str, str]) -> bool:
    """Tell whether an element is for a reader, going by its name and its own attributes."""
    if name in _DROPPED:
        return False
    if not found or not attribute.is_hidden(found) or name in _SHOWN:
        return True
    # Notes are hidden where a program is to show them on demand.
    return not attribute.roles(found).isdisjoint(("note", "notes"))


def _styled(found: Mapping[str, str]) -> list[MarkKind]:
    """Emphasis that an element's style gives it."""
    style = found.get("style")
    if not style:
        return []
    style = style.lower().replace(" ", "")
    return [kind for words, kind in _STYLES.items() if words in style]


def _heading(reader: MarkupReader, at: Begun) -> Steps:
    reader._begin_heading(whole(at.found.get("aria-level"), _HEADINGS[at.name]))
    yield from reader.inside(at.element)


def _list(reader: MarkupReader, at: Begun) -> Steps:
    _begin_list(reader, numbering_of(at.name, at.found))
    yield from reader.inside(at.element)


def _begin_list(reader: MarkupReader, numbering: ListNumbers | None) -> None:
    writing, place = reader.writing, reader.writing.place
    if place.items < _DEEPEST_LISTS:
        group = place.group if place.items else writing.group()
        numbering = numbering or place.numbering
        writing.place = replace(place, items=place.items + 1, group=group, numbering=numbering)


def _terms(reader: MarkupReader, at: Begun) -> Steps:
    _begin_list(reader, None)
    yield from reader.inside(at.element)


def _item(reader: MarkupReader, at: Begun) -> Steps:
    writing, place = reader.writing, reader.writing.place
    usual = BULLET if place.numbering is None else place.numbering.marker(at.found)
    writing.begin_item(at.found.get("data-marker", usual))
    if place.is_note or (place.in_notes and place.items == 1):
        reader._begin_note()
    else:
        writing.place = replace(place, kind=BlockKind.ITEM, level=max(place.items, 1))
    yield from reader.inside(at.element)
    writing.begin_block()
    writing.end_item()


def _term(reader: MarkupReader, at: Begun) -> Steps:
    writing, place = reader.writing, reader.writing.place
    if place.is_note or place.in_notes:
        reader._begin_note()
        yield from reader.inside(at.element)
        return
    writing.begin_item("")
    level = max(place.items, 1) + (at.name == "dd")
    writing.place = replace(place, kind=BlockKind.ITEM, level=level)
    yield from reader.inside(at.element)
    writing.begin_block()
    writing.end_item()


def _quote(reader: MarkupReader, at: Begun) -> Steps:
    writing = reader.writing
    writing.lay_out_table()
    place = writing.place
    if not place.is_note:
        quotes = min(place.quotes + 1, _DEEPEST_LISTS)
        writing.place = replace(place, kind=BlockKind.QUOTE, level=quotes, quotes=quotes)
    yield from reader.inside(at.element)


def _lines(reader: MarkupReader, at: Begun) -> Steps:
    writing = reader.writing
    writing.lay_out_table()
    writing.place = replace(writing.place, kind=BlockKind.LINE, level=0, keeps_lines=True)
    writing.starts_lines = True
    yield from reader.inside(at.element)
    writing.starts_lines = False


def _line(reader: MarkupReader, at: Begun) -> Steps:
    reader.writing.place = replace(reader.writing.place, kind=BlockKind.LINE, level=0)
    yield from reader.inside(at.element)


def _table(reader: MarkupReader, at: Begun) -> Steps:
    writing = reader.writing
    table = writing.begin_table()
    table.lays_out = at.found.get("role") in {"presentation", "none"}
    writing.place = replace(writing.place, table=table)
    yield from reader.inside(at.element)
    writing.begin_block()
    writing.end_row()


def _row(reader: MarkupReader, at: Begun) -> Steps:
    reader.writing.begin_row()
    yield from reader.inside(at.element)
    reader.writing.begin_block()
    reader.writing.end_row()


def _cell(reader: MarkupReader, at: Begun) -> Steps:
    reader.writing.begin_cell(
        columns=whole(at.found.get("colspan"), 1),
        rows=whole(at.found.get("rowspan"), 1),
        is_header=at.name == "th",
    )
    yield from reader.inside(at.element)
    reader.writing.end_cell()


def _head(reader: MarkupReader, at: Begun) -> Steps:
    writing, table = reader.writing, reader.writing.place.table
    writing.end_row()
    if table is not None:
        table.in_head = at.name == "thead"
    yield from reader.inside(at.element)
    if table is not None:
        writing.begin_block()
        table.in_head = False
        writing.end_row()


def _caption(reader: MarkupReader, at: Begun) -> Steps:
    writing, table = reader.writing, reader.writing.place.table
    if at.name == "caption" and table is not None:
        writing.place = replace(writing.place, group=table.group)
    else:
        writing.place = replace(writing.place, in_caption=True)
    yield from reader.inside(at.element)


def _figure(reader: MarkupReader, at: Begun) -> Steps:
    before = reader.writing.swap_pictures()
    yield from reader.inside(at.element)
    reader.writing.begin_block()
    reader.writing.swap_pictures(before)


def _rule(reader: MarkupReader, at: Begun) -> Steps:
    reader.writing.lay_out_table()
    reader.writing.divide()
    yield from reader.inside(at.element)


def _break(reader: MarkupReader, at: Begun) -> Steps:
    reader.writing.line_break()
    yield from reader.inside(at.element)


def _around(before: str, after: str) -> Handler:
    """Text before and after an element."""

    def read(reader: MarkupReader, at: Begun) -> Steps:
        reader.writing.write(reader.writing.spell(before))
        yield from reader.inside(at.element)
        reader.writing.write(reader.writing.spell(after))

    return read


def _image(reader: MarkupReader, at: Begun) -> Steps:
    writing = reader.writing
    if address := attribute.figure_address(at.found):
        told = at.found.get("title") or at.found.get("aria-label") or at.found.get("alt")
        words = " ".join((told or "").split()) or PurePosixPath(unquote(address)).stem
        writing.figure(words, address)
    else:
        said = at.found.get("aria-label") or at.found.get("alt")
        if said is None:
            said = at.found.get("title")
        if said is None:
            writing.unshown("picture", "picture")
        elif said := " ".join(said.split()):
            writing.picture(said)
    yield from reader.inside(at.element)


def _unshown(reader: MarkupReader, at: Begun) -> Steps:
    words, what = _UNSHOWN[at.name]
    label = " ".join((at.found.get("aria-label") or at.found.get("title") or "").split())
    reader.writing.unshown(f"{words}: {label}" if label else words, what)
    yield from reader.inside(at.element)


def _input(reader: MarkupReader, at: Begun) -> Steps:
    kind = at.found.get("type", "").lower()
    if at.name == "input" and kind == "image":
        yield from _image(reader, at)
        return
    if at.name != "input" or kind != "hidden":
        label = " ".join((at.found.get("aria-label") or "").split())
        if kind in _BUTTONS and at.name == "input":
            label = label or " ".join(at.found.get("value", "").split())
        reader.writing.unshown(f"form field: {label}" if label else "form field", "form")
    yield from reader.inside(at.element)


def _apart(reader: MarkupReader, at: Begun) -> Steps:
    reader.writing.flow.blank()
    yield from reader.inside(at.element)
    reader.writing.flow.blank()


def _title(reader: MarkupReader, at: Begun) -> Steps:  # noqa: ARG001
    """Pass over a title, which is said beside the text."""
    yield


def _formula(reader: MarkupReader, at: Begun) -> Steps:
    """Read a formula by its TeX, or by its text if that is one row of signs."""
    from lxml import etree

    writing = reader.writing
    told = at.found.get("alttext") or at.found.get("data-latex") or at.found.get("aria-label") or ""
    tex, row, is_linear = [], [], True
    walk = etree.iterwalk(at.element, events=("start", "end"))
    for event, inner in walk:
        inner_name = attribute.named(inner.tag)
        if event == "end":
            row.append(inner.tail or "" if inner is not at.element else "")
        elif inner_name.startswith("annotation"):
            # One in XML is the same formula once more, by its meaning.
            tex += [all_text(inner)] if inner_name == "annotation" else []
            walk.skip_subtree()
        else:
            is_linear = is_linear and inner_name in _LINEAR
            row.append(inner.text or "")
    text = " ".join((told or " ".join(tex)).split())
    text = text or (" ".join("".join(row).split()) if is_linear else "")
    if text:
        writing.flow.write(writing.spell(text[:_LONGEST_ASIDE]))
    else:
        writing.unshown("formula", "formula")
    yield


def _drawing(reader: MarkupReader, at: Begun) -> Steps:
    """Read a drawing in SVG by its title; HTML in it is read as text."""
    title = ""
    pending = list(at.element)[::-1]
    while pending:
        inner = pending.pop()
        if attribute.named(inner.tag) in _HTML:
            yield from reader._element(inner)
        else:
            pending += list(inner)[::-1]
        if attribute.named(inner.tag) == "title" and inner.getparent() is at.element:
            title = title or all_text(inner)
    text = " ".join((at.found.get("aria-label") or "").split()) or title
    if text:
        reader.writing.picture(text)
    else:
        reader.writing.unshown("drawing", "drawing")


def _page_number(reader: MarkupReader, at: Begun) -> Steps:
    reader._page(at.element, at.found)
    yield


def _section_heading(reader: MarkupReader, at: Begun) -> Steps:
    sections = max(reader.writing.place.sections, 1)
    reader._begin_heading(1 if at.name == "doctitle" else sections)
    yield from reader.inside(at.element)


def _note(reader: MarkupReader, at: Begun) -> Steps:
    reader._begin_note()
    yield from reader.inside(at.element)


def _dtbook_list(reader: MarkupReader, at: Begun) -> Steps:
    kind = at.found.get("type", "pl")
    told = {**at.found, "type": at.found.get("enum", "1")}
    if kind == "pl":  # its items have their numbers in their text, if any
        told["style"] = "list-style: none"
    yield from _list(reader, at._replace(name="ol" if kind == "ol" else "ul", found=told))


_HANDLERS: dict[str, Handler] = {
    **dict.fromkeys(_HEADINGS, _heading),
    **dict.fromkeys(("ul", "ol", "menu", "dir"), _list),
    **dict.fromkeys(("dt", "dd"), _term),
    **dict.fromkeys(("pre", "listing", "xmp", "plaintext"), _lines),
    **dict.fromkeys(("td", "th"), _cell),
    **dict.fromkeys(("thead", "tbody", "tfoot"), _head),
    **dict.fromkeys(("caption", "figcaption"), _caption),
    **dict.fromkeys(_UNSHOWN, _unshown),
    **dict.fromkeys(("input", "select", "textarea"), _input),
    **dict.fromkeys(("option", "button"), _apart),
    "li": _item,
    "dl": _terms,
    "blockquote": _quote,
    "table": _table,
    "tr": _row,
    "figure": _figure,
    "hr": _rule,
    "br": _break,
    "img": _image,
    "rt": _around("(", ")"),
    "q": _around("“", "”"),
    "title": _title,
    "math": _formula,
    "svg": _drawing,
    "pagenum": _page_number,
}
_DTBOOK: dict[str, Handler] = {
    **{name: handler for name, handler in _HANDLERS.items() if name != "q"},
    **dict.fromkeys(("hd", "doctitle", "bridgehead"), _section_heading),
    **dict.fromkeys(("note", "annotation"), _note),
    "line": _line,
    "list": _dtbook_list,
    "imggroup": _figure,
    "linenum": _apart,
}
