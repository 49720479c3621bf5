"""A parser's target that makes passages of the events of HTML, however deep or broken it is."""

from __future__ import annotations

from typing import TYPE_CHECKING

from vbraille.translate.documents.markup import attributes as attribute
from vbraille.translate.documents.markup import elements
from vbraille.translate.documents.markup.asides import Aside, Collected, Drawing, Formula
from vbraille.translate.documents.markup.lists import whole
from vbraille.translate.documents.markup.writing import Writing
from vbraille.translate.source import MarkKind

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from vbraille.translate.documents.markup.elements import Begin, Undo
    from vbraille.translate.documents.parted import Passage

# Below so many open elements, others only begin and end blocks: what each of them would have to
# end again is not kept, so that a million of them fit into memory.
_DEEPEST = 2_000
_LONGEST_NUMBER = 40  # characters of a page's number; more is text
_BACK = frozenset("↩↑⏎←⤴^\ufe0e\ufe0f \u00a0")  # what a link back from a note shows
# Elements that are shown though they are said to be hidden: a page would be empty otherwise, and
# a caption is hidden where it says the same as its picture, which `Writing` finds out.
_SHOWN = frozenset(("html", "body", "figcaption"))
_ROOTS = frozenset(("html", "body", "dtbook"))
_SPECIAL = frozenset(("math", "svg", "title", "pagenum"))
_STYLES = {
    "font-style:italic": MarkKind.ITALIC,
    "font-style:oblique": MarkKind.ITALIC,
    "font-weight:bold": MarkKind.BOLD,
    "text-decoration:underline": MarkKind.UNDERLINE,
    "vertical-align:super": MarkKind.SUPERSCRIPT,
    "vertical-align:sub": MarkKind.SUBSCRIPT,
}
_SMALL = {kind.value: kind for kind in (MarkKind.SUPERSCRIPT, MarkKind.SUBSCRIPT)}
_NOTHING: dict[str, str] = {}


class MarkupReader:
    """Makes passages of what a parser tells it; its methods are called by lxml.

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
    begins
        Elements by name, with what they begin.
    spell
        What spells the text that is not the document's own, as the document is spelt.
    pages
        Numbers of pages of the printed book that begin at anchors, by the anchors' names.

    Attributes
    ----------
    title : str
        Title that the document gives itself; empty as long as it has not.
    root_language : str
        Tag of the language of the document; empty if it does not say.
    """

    def __init__(
        self,
        resolve: Callable[[str], str] = str,
        prefix: str = "",
        anchors: tuple[str, ...] = (),
        language: str = "",
        begins: Mapping[str, Begin] = elements.BEGINS,
        spell: Callable[[str], str] = str,
        pages: Mapping[str, str] = _NOTHING,
    ) -> None:
        self.title = self.root_language = ""
        self.writing = Writing(anchors, language, spell, resolve)
        self._resolve = resolve
        self._prefix = prefix
        self._listed = pages
        self._number = ""  # of the page that was begun last
        self._begins = begins
        self._names: dict[object, str] = {}
        self._block = (self.writing.begin_block,)  # what most blocks end with
        self._open: list[tuple[Undo, ...]] = []
        self._closed = False
        self._refers = 0  # number of open elements whose links are references to notes
        self._skipped = 0  # number of open elements that are passed over
        self._aside: Aside | None = None
        for anchor in anchors:
            self._begin_listed(anchor)

    def take(self) -> list[Passage]:
        """Take the passages that are finished; the last one only after the end."""
        passages = self.writing.passages
        stop = len(passages) if self._closed else -1
        self.writing.passages = passages[stop:]
        return passages[:stop]

    def start(self, tag: object, attrib: Mapping[str, str]) -> None:
        """Take the start of an element."""
        name = self._names.get(tag)
        if name is None:
            name = attribute.named(tag)
            if len(self._names) < 10_000:
                self._names[tag] = name
        if self._skipped:
            if self._aside is None or not self._aside.start(name):
                self._skipped += 1
                return
            back = self._left_aside()
            self._open.append((*self._begin(name, attribute.known(attrib)), back))
            return
        found = attribute.known(attrib) if attrib else _NOTHING
        self._open.append(self._begin(name, found))

    def end(self, tag: object) -> None:  # noqa: ARG002
        """Take the end of the element that was begun last."""
        if self._skipped:
            self._skipped -= 1
            if self._skipped:
                if self._aside is not None:
                    self._aside.end()
                return
            self._aside = None
        for undo in self._open.pop():
            undo()

    def data(self, text: str) -> None:
        """Take text."""
        if not self._skipped:
            self.writing.write(text)
        elif self._aside is not None:
            self._aside.text(text)

    def comment(self, text: str) -> None:
        """Pass over a comment."""

    def pi(self, target: str, text: str | None = None) -> None:
        """Pass over what is meant for a program."""

    def close(self) -> None:
        """Take the end of the document."""
        self.writing.close()
        self._closed = True

    def _begin(self, name: str, found: dict[str, str]) -> tuple[Undo, ...]:
        """Begin an element that is not passed over; what is returned ends it."""
        writing = self.writing
        if name in elements.DROPPED:
            return self._drop(name)
        # Notes are hidden where a program is to show them on demand.
        if (
            found
            and attribute.is_hidden(found)
            and name not in _SHOWN
            and not attribute.roles(found) & {"note", "notes"}
        ):
            return self._pass_over(None)
        if name in elements.BLOCKS:
            writing.begin_block()
            undos = self._block
        else:
            undos = ()
        if len(self._open) > _DEEPEST:
            return undos
        if not found:
            begin = self._begins.get(name)
            if begin is not None:
                return (*undos, *begin(writing, name, found))
            kind = elements.EMPHASES.get(name)
            if kind is not None:
                return (*undos, self._emphasis(kind))
            if name in _SPECIAL:
                return (*undos, *self._special(name, found))
            return undos
        return (*undos, *self._begin_with(name, found, is_block=bool(undos)))

    def _begin_with(self, name: str, found: dict[str, str], *, is_block: bool) -> tuple[Undo, ...]:
        """Begin an element that has attributes."""
        writing = self.writing
        roles = attribute.roles(found)
        if name == "meta":
            self._meta(found)
        if (
            name == "pagenum"
            or "page" in roles
            or ("page?" in roles and name in {"span", "a"} and "id" in found)
        ):
            return self._page(found)
        if "back" in roles:
            return self._pass_over(None)
        undos: list[Undo] = []
        identity = found.get("id") or (found.get("name") if name == "a" else None)
        if identity:
            self._begin_listed(self._prefix + identity)
            writing.anchor(self._prefix + identity)
        language = attribute.language(found)
        if language is not None:
            undos.append(self._language(name, language, is_block=is_block))
        if name in _SPECIAL or (name != "img" and "img" in roles):
            return (*undos, *self._special(name, found))
        if "presentation" in roles and name == "img":
            return tuple(undos)
        begin = self._begins.get(name)
        if "heading" in roles and name not in elements.HEADINGS:
            writing.begin_block()
            level = whole(found.get("aria-level"), 2)
            undos += (writing.begin_block, *elements.begin_heading(writing, level))
        elif begin is not None:
            undos += begin(writing, name, found)
        kind = elements.EMPHASES.get(name)
        if kind is not None:
            undos.append(self._emphasis(kind))
        if "note" in roles:
            writing.begin_block()
            undos += (writing.begin_block, *elements.begin_note(writing))
        if "notes" in roles:
            undos += elements.begin_notes(writing)
        if "noteref" in roles and name != "a":
            undos.append(self._referring())
        undos += self._reference(name, found, roles)
        undos += self._styled(found)
        if name == "span":  # a paragraph's class of these names is a title's
            undos += (self._emphasis(kind) for role, kind in _SMALL.items() if role in roles)
        return tuple(undos)

    def _reference(
        self, name: str, found: Mapping[str, str], roles: frozenset[str]
    ) -> tuple[Undo, ...]:
        """Begin a link, or a reference to a note."""
        if name not in {"a", "noteref", "annoref"}:
            return ()
        if "number" in roles:  # a note's own, which leads back
            return (self.writing.flow.blank,)
        address = attribute.target(found)
        if not address:
            return ()
        flow, place = self.writing.flow, self.writing.place
        is_note = "noteref" in roles or name != "a" or self._refers > 0
        kind = MarkKind.NOTE if is_note else MarkKind.LINK
        flow.open(kind, self._resolve(address))
        if not (place.is_note or self.writing.in_notes):
            return (lambda: flow.close(kind),)
        start = flow.length

        def end() -> None:
            flow.close(kind)
            if 0 < flow.length - start < 8 and _BACK.issuperset(flow.since(start)):
                flow.cut(start)

        return (end,)

    def _referring(self) -> Undo:
        """Take links within an element for references to notes."""
        self._refers += 1

        def end() -> None:
            self._refers -= 1

        return end

    def _emphasis(self, kind: MarkKind) -> Undo:
        flow = self.writing.flow
        flow.open(kind)
        return lambda: flow.close(kind)

    def _styled(self, found: Mapping[str, str]) -> tuple[Undo, ...]:
        """Begin the emphasis that an element's style gives it."""
        style = found.get("style")
        if not style:
            return ()
        style = style.lower().replace(" ", "")
        return tuple(self._emphasis(kind) for words, kind in _STYLES.items() if words in style)

    def _language(self, name: str, tag: str, *, is_block: bool) -> Undo:
        """Have the next text be in a language."""
        writing, flow = self.writing, self.writing.flow
        tag = tag.replace("_", "-")
        if name in _ROOTS and not self.root_language:
            self.root_language = tag
            writing.given = writing.given or tag
        before = writing.language, flow.language
        flow.language = writing.same(tag)
        if is_block or name in _ROOTS:
            writing.language = flow.language

        def end() -> None:
            writing.language, flow.language = before

        return end

    def _begin_listed(self, anchor: str) -> None:
        """Begin a page that the book's list of pages has here, unless the text has it already."""
        number = self._listed.get(anchor, "")
        if number not in ("", self._number) and len(number) < _LONGEST_NUMBER:
            self._number = number
            self.writing.page(number, ())

    def _page(self, found: Mapping[str, str]) -> tuple[Undo, ...]:
        """Begin a page of the printed book, whose number may be the element's text."""
        writing = self.writing
        told = found.get("title") or found.get("aria-label") or found.get("value") or ""
        anchors = (self._prefix + found["id"],) if found.get("id") else ()
        listed = self._listed.get(anchors[0], "") if anchors else ""
        inside = Collected()
        self._pass_over(inside)

        def end() -> None:
            number = " ".join(told.split()) or inside.found
            if number.lower().startswith("page "):
                number = number[5:].strip(" .")
            self._number = number = number or listed
            writing.page(number if len(number) < _LONGEST_NUMBER else "", anchors)
            if len(inside.found) >= _LONGEST_NUMBER:
                writing.write(f" {inside.found} ")

        return (end,)

    def _special(self, name: str, found: Mapping[str, str]) -> tuple[Undo, ...]:
        """Begin what another text stands for: a title, a formula, a drawing, a picture."""
        writing = self.writing
        label = " ".join((found.get("aria-label") or "").split())
        if name == "pagenum":
            return self._page(found)
        if name == "title":
            title = Collected()
            self._pass_over(title)
            return (lambda: self._entitle(title.found),)
        if name == "math":
            formula = Formula()
            self._pass_over(formula)
            told = found.get("alttext") or found.get("data-latex") or label

            def end() -> None:
                text = " ".join(told.split()) or formula.found
                if text:
                    writing.flow.write(writing.spell(text))
                else:
                    writing.unshown("formula", "formula")

            return (end,)
        if name == "svg":
            drawing = Drawing()
            self._pass_over(drawing)

            def end_drawing() -> None:
                text = label or drawing.found
                if text:
                    writing.picture(text)
                else:
                    writing.unshown("drawing", "drawing")

            return (end_drawing,)
        if label:
            self._pass_over(None)
            writing.picture(label)
        return ()

    def _meta(self, found: Mapping[str, str]) -> None:
        """Take what is said of the whole document."""
        name, content = found.get("name", "").lower(), " ".join(found.get("content", "").split())
        if name == "dc:title" and content:
            self.title = content
        elif name in ("dc:language", "dcterms.language") and not self.root_language:
            self.root_language = content

    def _entitle(self, title: str) -> None:
        self.title = self.title or title

    def _drop(self, name: str) -> tuple[Undo, ...]:
        """Pass over an element whose text is not for a reader."""
        self._pass_over(None)
        if name == "iframe":
            self.writing.unshown("embedded page", "page")
        return ()

    def _pass_over(self, aside: Aside | None) -> tuple[Undo, ...]:
        """Pass over what is in the element that begins."""
        self._skipped, self._aside = 1, aside
        return ()

    def _left_aside(self) -> Undo:
        """Read on within what is passed over; what is returned passes over the rest."""
        before = self._skipped, self._aside
        self._skipped, self._aside = 0, None

        def end() -> None:
            self._skipped, self._aside = before

        return end
