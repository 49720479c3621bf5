"""An RTF file as a tree of HTML: styles, lists, tables, notes, links, languages."""

from __future__ import annotations

import codecs
import locale
import re
from collections import Counter
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

from lxml import etree

from vbraille.errors import InputError
from vbraille.translate.documents.office.htmltree import (
    CODES,
    HEADING,
    QUOTES,
    Notes,
    Pictures,
    field_target,
    last_of,
    most_frequent,
    primary,
    put,
    put_inner,
    put_page,
    put_text,
    put_unshown,
    symbol,
    unwrap,
)

if TYPE_CHECKING:
    from lxml.etree import _Element as Element

_TOKEN = re.compile(
    r"\\([a-zA-Z]{1,32})(-?\d{1,10})? ?|\\'([0-9a-fA-F]{2})|\\([^a-zA-Z])"
    r"|([{}])|([^\\{}\r\n]+)|[\r\n]+"
)
_UNPRINTABLE = re.compile("[^\t\n\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
_USUAL = re.compile(r"\\deflang(\d{1,5})\b")
_LANGUAGE = re.compile(r"\\lang(\d{1,5})\b")
_HEADER = 65_536  # characters
_MOST_GROUPS = 2_000  # within each other
_SPOKEN = {
    "emdash": "—", "endash": "–", "lquote": "‘", "rquote": "’", "ldblquote": "“", "rdblquote": "”",
    "bullet": "•", "emspace": "\u2003", "enspace": "\u2002", "tab": "\t", "cell": "", "~": "\xa0",
    "_": "\u2011", "-": "", "{": "{", "}": "}", "\\": "\\", "\n": "\n", "\r": "\n",
}  # fmt: skip
_EMPHASIS = {"b": "b", "i": "i", "ul": "u", "strike": "s", "striked": "s", "super": "sup"}
_EMPHASIS |= {"sub": "sub", "uldb": "u", "ulw": "u", "uld": "u", "ulwave": "u"}
# Groups whose text is not the document's.
_SKIPPED_NAMES = (
    "fonttbl colortbl info header headerl headerr headerf footer footerl footerr footerf "
    "listtable listoverridetable revtbl rsidtbl annotation atnid atnauthor atrfstart atrfend "
    "atnref atndate atntime atnparent xe tc rxe txe bkmkend pgdsctbl pgdsc nonshppict nonesttables "
    "themedata colorschememapping latentstyles datastore generator xmlnstbl filetbl fldtype "
    "objdata objclass objname template pnseclvl pn ftnsep ftnsepc ftncn aftnsep aftnsepc aftncn "
    "nesttableprops mmathPr userprops shprslt"
)
_SKIPPED = frozenset(_SKIPPED_NAMES.split())
# Groups that programs may not know, and this one does.
_KNOWN = frozenset(("footnote", "fldinst", "bkmkstart", "shppict", "shpinst", "shptxt", "do"))
_GATHERED = frozenset(("fldinst", "bkmkstart", "listtext", "pntext", "pict", "sn", "sv"))
_GATHERED |= {"stylesheet"}
_CHARSETS = {
    0: "cp1252", 77: "mac-roman", 128: "cp932", 129: "cp949", 130: "johab", 134: "cp936",
    136: "cp950", 161: "cp1253", 162: "cp1254", 163: "cp1258", 177: "cp1255", 178: "cp1256",
    186: "cp1257", 204: "cp1251", 222: "cp874", 238: "cp1250",
}  # fmt: skip
_NO_LANGUAGES = frozenset((0, 1024, 4096))


@dataclass(frozen=True, slots=True)
class _Group:
    """What holds for the text of a group.

    Parameters
    ----------
    what
        What is made of its text: "" for the document's, or the name of the group's first word.
    tags
        Names of HTML's elements for how it looks.
    link
        Whether it is the text of a link.
    """

    what: str = ""
    tags: frozenset[str] = frozenset()
    hidden: bool = False
    language: int = 0
    font: int = 0
    blanks: int = 1  # characters after a \u that stand for it elsewhere
    link: bool = False


@dataclass(slots=True)
class _Flow:
    """Where the text goes: a body, a cell or a note, and the paragraph that is being read."""

    into: Element
    paragraph: Element | None = None
    at: Element | None = None  # within the paragraph, such as a link
    style: int = 0
    outline: int = 9
    number: int = 0  # of the list
    level: int = 0
    in_table: bool = False
    label: str = ""
    is_told: bool = False  # whether the paragraph's place is its own, not that of the one before
    lists: list[Element] = field(default_factory=list)
    rows: list[_Row] = field(default_factory=list)
    cells: list[Element] = field(default_factory=list)
    cell: Element | None = None


@dataclass(slots=True)
class _Row:
    """A row of a table: the right edges and the merging of its cells, and these."""

    edges: list[int] = field(default_factory=list)
    merges: list[str] = field(default_factory=list)
    cells: list[Element] = field(default_factory=list)
    is_head: bool = False
    is_ruled: bool = False


def read_rtf(content: bytes, name: str) -> tuple[Element, str, str]:
    """Read an RTF file.

    Returns
    -------
    root
        Root of the tree of HTML.
    title, language
        Title, and tag of the language that most of the text is in; empty if it does not say.

    Raises
    ------
    InputError
        If it is no RTF file, or nested too deep.
    """
    if not content.startswith(b"{\\rtf"):
        raise InputError(
            f"{name} is damaged or no RTF file; get it again, or open it in a word processor and "
            f"save it anew"
        )
    return _Reader(name).read(content.decode("latin-1"))


class _Reader:
    """Reads one document."""

    def __init__(self, name: str) -> None:
        self._name = name
        self._html = etree.Element("html")
        self._flow = _Flow(put(self._html, "body"))
        self._group = _Group()
        self._around: list[tuple[_Group, _Flow | None]] = []  # groups, and flows that end with them
        self._texts: dict[str, list[str]] = {}  # of groups that are no text of the document
        self._notes = Notes()
        self._bodies: dict[str, Element] = {}
        self._pictures = Pictures()
        self._codecs: dict[int, str] = {}  # of fonts
        self._fonts: dict[int, str] = {}
        self._usual_codec = "cp1252"
        self._usual_language = 0
        self._styles: dict[int, tuple[str, int, int]] = {}  # name, outline level, based on
        self._counted = Counter[int]()
        self._spans: list[tuple[Element, int]] = []
        self._bytes = bytearray()
        self._swallow = 0
        self._high = 0  # first half of a character of two
        self._row = _Row()
        self._opens = self._starred = False  # whether a group has just begun, and with a star
        self._font_at = self._style_at = -1
        self._style_told = (9, -1)  # outline level of a style, and what it is based on

    def read(self, text: str) -> tuple[Element, str, str]:
        usual = _USUAL.search(text, 0, _HEADER)
        named = Counter(map(int, _LANGUAGE.findall(text))) if usual is None else {int(usual[1]): 1}
        known = (number for number, _ in Counter(named).most_common() if _tag(number))
        self._usual_language = next(known, 0)
        self._group = replace(self._group, language=self._usual_language)
        at = 0
        while (token := _TOKEN.match(text, at)) is not None:
            at = token.end()
            word, number, byte, sign, brace, plain = token.groups()
            if word == "bin":
                at += max(int(number or 0), 0)
            elif byte is not None:
                self._byte(int(byte, 16))
            else:
                self._flush()
                if brace is not None:
                    self._brace(brace)
                elif word is not None:
                    self._word(word, None if number is None else int(number))
                elif sign is not None:
                    self._sign(sign)
                elif plain is not None:
                    self._plain(plain)
        self._flush()
        while self._around:
            self._brace("}")
        self._end_paragraph()
        self._end_table()
        for identity, item in self._notes.section(self._flow.into):
            item.extend(list(self._bodies[identity]))
        tags = {number: _tag(number) for number in self._counted}
        counted = Counter[str]()
        for number, size in self._counted.items():
            counted[tags[number]] += size
        most = most_frequent(counted, _tag(self._usual_language))
        for span, number in self._spans:
            tag = tags[number]
            if tag and primary(tag) != primary(most):
                span.set("lang", tag)
        title = " ".join("".join(self._texts.get("title", ())).split())
        return self._html, title, most

    def _brace(self, brace: str) -> None:
        self._swallow = 0
        if brace == "{":
            if len(self._around) > _MOST_GROUPS:
                raise InputError(
                    f"{self._name} has thousands of groups within each other, which no book has; "
                    f"give another copy of it"
                )
            self._around.append((self._group, None))
            self._opens = True
            return
        if not self._around:
            return
        ended, (self._group, flow) = self._group, self._around.pop()
        if flow is not None:
            self._end_paragraph()
            self._end_table()
            self._flow = flow
        elif ended.what != self._group.what or ended.what == "font":
            self._end_group(ended.what)
        if ended.link and not self._group.link:
            self._flow.at = None

    def _end_group(self, what: str) -> None:
        """End a group of text that was gathered."""
        text = "".join(self._texts.get(what, ()))
        if what == "bkmkstart":
            put(self._paragraph(), "a", id=text.strip())
        elif what == "stylesheet-entry":
            outline, based = self._style_told
            self._styles[self._style_at] = (text.strip(" ;").lower(), outline, based)
        elif what in ("listtext", "pntext"):
            self._flow.label = text.strip()
        elif what == "pict" and self._group.what in ("", "shppict"):
            described = "".join(self._texts.pop("described", ())).strip()
            if described:
                put(self._paragraph(), "img", alt=described)
            else:
                put_unshown(self._paragraph(), "picture")
        elif what == "sv" and "".join(self._texts.get("sn", ())).strip() == "wzDescription":
            self._texts["described"] = [text]
        elif what == "font" and text:
            self._fonts[self._font_at] = text.strip(" ;").lower()
        if what not in ("title", "described", "sn", "fldinst"):
            self._texts.pop(what, None)

    def _plain(self, text: str) -> None:
        if self._swallow:
            left = min(self._swallow, len(text))
            self._swallow -= left
            text = text[left:]
        if text and not text.isascii():  # a byte as it is
            text = text.encode("latin-1").decode(self._codec(), "replace")
        self._say(text)

    def _byte(self, byte: int) -> None:
        if self._swallow:
            self._swallow -= 1
        else:
            self._bytes.append(byte)

    def _codec(self) -> str:
        return self._codecs.get(self._group.font, self._usual_codec)

    def _flush(self) -> None:
        """Read the bytes that were gathered, of which two may be one character."""
        if self._bytes:
            content, self._bytes = bytes(self._bytes), bytearray()
            font = self._fonts.get(self._group.font, "")
            if font.startswith(("symbol", "wingdings")):
                self._say("".join(symbol(byte, font) or "\ufffd" for byte in content))
            else:
                self._say(content.decode(self._codec(), "replace"))

    def _say(self, text: str) -> None:
        group = self._group
        if not text:
            return
        if group.what not in ("", "shppict", "shpinst"):
            self._texts.setdefault(group.what, []).append(text)
            return
        if group.hidden or group.what:
            return
        at = self._place()
        without = {"u"} if group.link else ()
        self._counted[group.language] += len(text)
        last = self._spans[-1] if self._spans else None
        if last is not None and last[1] == group.language and last_of(at) is last[0]:
            span = None if last[0].tail else last[0]
        else:
            span = None
        if span is None:
            span = put(at, "span")
            self._spans.append((span, group.language))
        put_text(put_inner(span, sorted(group.tags), without=without), _UNPRINTABLE.sub("", text))

    def _sign(self, sign: str) -> None:
        if sign == "*":
            self._starred = True
        elif sign == "~" and self._flow.paragraph is None:
            return  # before a note's text
        elif sign in "\r\n":
            self._end_paragraph()
        elif sign in _SPOKEN:
            self._say(_SPOKEN[sign])

    def _word(self, word: str, number: int | None) -> None:
        """Read a control word."""
        opens, self._opens = self._opens, False
        starred, self._starred = self._starred, False
        self._swallow = 0
        group = self._group
        if opens and (word in _SKIPPED or (starred and word not in _KNOWN)):
            self._texts.pop(word, None)
            self._group = replace(group, what="skipped" if word != "fonttbl" else "font")
            if word == "info":
                self._group = replace(group, what="info")
        elif group.what == "skipped":
            return
        elif word == "u":
            self._unicode(number or 0)
        elif word in _SPOKEN and word != "cell":
            self._say(_SPOKEN[word])
        elif word in ("ansicpg", "deff", "mac", "pca", "pc"):
            self._header(word, number)
        elif not self._destination(word):
            if group.what in ("", "shppict", "shpinst"):
                self._of_text(word, number)
            elif group.what in ("font", "stylesheet", "stylesheet-entry"):
                self._of_tables(word, number)
            self._of_characters(word, number)

    def _unicode(self, number: int) -> None:
        code = number + 65_536 if number < 0 else number
        self._swallow = self._group.blanks
        if 0xD800 <= code < 0xDC00:
            self._high = code
            return
        if 0xDC00 <= code < 0xE000:
            code = 0x10000 + ((self._high - 0xD800) << 10) + code - 0xDC00 if self._high else 0xFFFD
        self._high = 0
        if 0xF000 <= code < 0xF100:
            font = self._fonts.get(self._group.font, "")
            is_of_signs = font.startswith(("symbol", "wingdings"))
            self._say(symbol(code, font if is_of_signs else "symbol") or "\ufffd")
        elif code < 0x110000:
            self._say(chr(code))

    def _header(self, word: str, number: int | None) -> None:
        if word == "ansicpg" and number:
            self._usual_codec = _known_codec(f"cp{number}")
        elif word == "mac":
            self._usual_codec = "mac-roman"
        elif word in ("pc", "pca"):
            self._usual_codec = "cp437" if word == "pc" else "cp850"
        elif word == "deff":
            self._group = replace(self._group, font=number or 0)

    def _destination(self, word: str) -> bool:
        """Begin a group whose text is no text of the document, or goes elsewhere."""
        group = self._group
        if word in ("footnote", "shptxt", "dptxbxtext") and self._around:
            self._around[-1] = (self._around[-1][0], self._flow)
            if word == "footnote":
                identity = f"note-{len(self._bodies)}"
                body = self._bodies[identity] = etree.Element("div")
                self._notes.refer(self._place(), identity)
            else:
                body = put(self._paragraph(), "div")
            self._flow = _Flow(body)
            self._group = _Group(
                language=group.language, font=group.font, blanks=group.blanks, hidden=group.hidden
            )
        elif word in _GATHERED:
            self._texts[word] = []
            self._group = replace(group, what=word)
        elif word in ("shppict", "shpinst", "sp"):
            self._group = replace(group, what=group.what if word != "sp" and group.what else word)
        elif word == "title" and group.what == "info":
            self._group = replace(group, what="title")
        elif word == "fldrslt":
            target = field_target("".join(self._texts.pop("fldinst", ())))
            if target and not group.what:
                self._flow.at = put(self._paragraph(), "a", href=target)
                self._group = replace(group, link=True)
        else:
            return False
        return True

    def _of_tables(self, word: str, number: int | None) -> None:
        """Read what is said of a font or of a style."""
        group = self._group
        if group.what == "font":
            if word == "f":
                self._font_at = number or 0
                self._texts.pop("font", None)
            elif word == "fcharset" and number in _CHARSETS:
                self._codecs[self._font_at] = _CHARSETS[number]
            return
        if group.what == "stylesheet" and word in ("s", "cs", "ts", "ds", "snext", "sbasedon"):
            self._group = replace(group, what="stylesheet-entry")
            self._style_at = (number or 0) if word == "s" else -1
            self._style_told = (9, -1)
        elif word == "outlinelevel":
            self._style_told = (number or 0, self._style_told[1])
        elif word == "sbasedon":
            self._style_told = (self._style_told[0], number or 0)

    def _of_characters(self, word: str, number: int | None) -> None:
        """Read how characters look."""
        group = self._group
        if word == "plain":
            language = self._usual_language
            self._group = replace(group, tags=frozenset(), hidden=False, language=language)
        elif word in _EMPHASIS:
            tag = _EMPHASIS[word]
            tags = group.tags - {tag} if number == 0 else group.tags | {tag}
            self._group = replace(group, tags=tags)
        elif word in ("ulnone", "nosupersub"):
            ended = {"u"} if word == "ulnone" else {"sup", "sub"}
            self._group = replace(group, tags=group.tags - ended)
        elif word in ("v", "deleted"):
            self._group = replace(group, hidden=number != 0)
        elif word == "lang" and number is not None:
            language = self._usual_language if number in _NO_LANGUAGES else number
            self._group = replace(group, language=language)
        elif word == "f":
            self._group = replace(group, font=number or 0)
        elif word == "uc":
            self._group = replace(group, blanks=max(number or 0, 0))

    def _of_text(self, word: str, number: int | None) -> None:
        """Read what words of paragraphs, tables and breaks say."""
        if word in ("par", "sect", "nestcell"):
            self._end_paragraph()
        elif word == "line":
            put(self._paragraph(), "br")
        elif word == "page":
            put_page(self._paragraph())
        elif word == "pard":
            self._begin_paragraph()
        elif word == "s":
            self._flow.style = number or 0
        elif word == "outlinelevel":
            self._flow.outline = number or 0
        elif word == "ls":
            self._flow.number = number or 0
        elif word == "ilvl":
            self._flow.level = min(max(number or 0, 0), 8)
        elif word == "intbl":
            self._flow.in_table = True
        elif word == "cell":
            self._end_cell()
        elif word == "row":
            self._end_row()
        elif word == "trowd":
            self._row = _Row()
        elif word == "trhdr":
            self._row.is_head = True
        elif word == "clbrdrb":
            self._row.is_ruled = True
        elif word in ("clmgf", "clmrg", "clvmgf", "clvmrg"):
            self._row.merges += [""] * (len(self._row.edges) - len(self._row.merges)) + [word]
        elif word == "cellx":
            self._row.edges.append(number or 0)

    def _begin_paragraph(self) -> None:
        """Forget what was said of the paragraph."""
        flow = self._flow
        flow.style, flow.outline, flow.number, flow.level, flow.in_table = 0, 9, 0, 0, False
        flow.is_told = True

    def _paragraph(self) -> Element:
        if self._flow.paragraph is None:
            self._flow.paragraph = etree.Element("p")
        return self._flow.paragraph

    def _place(self) -> Element:
        """Element in which the next text stands."""
        paragraph = self._paragraph()
        return paragraph if self._flow.at is None else self._flow.at

    def _end_paragraph(self) -> None:
        """Put the paragraph where it belongs."""
        flow = self._flow
        paragraph, flow.paragraph, flow.at = flow.paragraph, None, None
        if paragraph is None:
            return
        if self._flow.in_table:
            flow.cell = etree.Element("td") if flow.cell is None else flow.cell
            flow.cell.append(paragraph)
            return
        self._end_table()
        name, level = self._styled()
        into = flow.into
        if level:
            paragraph.tag = f"h{min(level, 6)}"
            _plain_style(paragraph)
        elif flow.number or flow.label:
            self._item(paragraph)
            flow.label, flow.is_told = "", False
            return
        elif not QUOTES.isdisjoint(name):
            last = last_of(into)
            is_same = last is not None and last.tag == "blockquote"
            into = last if last is not None and is_same else put(into, "blockquote")
            _plain_style(paragraph)
        elif not CODES.isdisjoint(name):
            paragraph.tag = "pre"
        flow.lists = []
        if self._pictures.repeats(paragraph):
            return
        into.append(paragraph)

    def _styled(self) -> tuple[list[str], int]:
        """Names of the paragraph's style and of those below it; and its level as a heading."""
        names: list[str] = []
        level = self._flow.outline + 1 if self._flow.outline < 9 else 0
        at, seen = self._flow.style, set[int]()
        while at in self._styles and at not in seen:
            seen.add(at)
            name, outline, based = self._styles[at]
            names.append(name)
            found = HEADING.search(name)
            if not level and found is not None:
                level = int(found[1])
            elif not level and outline < 9:
                level = outline + 1
            at = based
        return names, level

    def _item(self, paragraph: Element) -> None:
        """Put a paragraph into a list, as an item if it has a label."""
        flow, level, label = self._flow, self._flow.level, self._flow.label
        if not label and flow.lists and flow.is_told:
            flow.lists[min(level, len(flow.lists) - 1)].append(paragraph)
            return
        is_bullet = not any(map(str.isalnum, label)) or label in ("o", "§")
        name = "bullets" if is_bullet else "labels"
        listed = flow.lists[level].getparent() if level < len(flow.lists) else None
        if listed is not None and listed.get("class") != name:
            listed = None
        del flow.lists[level:]
        while len(flow.lists) < level:
            flow.lists.append(flow.lists[-1] if flow.lists else flow.into)
        if listed is None:
            listed = put(flow.lists[-1] if flow.lists else flow.into, "ul", class_=name)
            if not is_bullet:
                listed.set("style", "list-style: none")
        item = put(listed, "li", "" if is_bullet else f"{label} ")
        put_text(item, paragraph.text or "")
        item.extend(list(paragraph))
        flow.lists.append(item)

    def _end_cell(self) -> None:
        flow = self._flow
        self._flow.in_table = True
        self._end_paragraph()
        cell = etree.Element("td") if flow.cell is None else flow.cell
        flow.cell = None
        unwrap(cell)
        flow.cells.append(cell)

    def _end_row(self) -> None:
        flow = self._flow
        if flow.cells:
            row = replace(self._row, cells=flow.cells)
            flow.cells = []
            flow.rows.append(row)
        self._flow.in_table = False

    def _end_table(self) -> None:
        """Put the rows that were read as a table."""
        flow = self._flow
        if flow.cell is not None:  # said to be in a table, and in no cell of one
            flow.into.extend(list(flow.cell))
            flow.cell = None
        if flow.cells:
            self._end_row()
        rows, flow.rows = flow.rows, []
        if not rows:
            return
        flow.lists = []
        if sum(len(row.cells) for row in rows) <= 1:
            for cell in rows[0].cells:
                cell.tag = "div"
                flow.into.append(cell)
            return
        table = put(flow.into, "table")
        edges = sorted({edge for row in rows for edge in row.edges})
        above: dict[int, Element] = {}  # cells that go on in the next row, by their columns
        is_ruled = rows[0].is_ruled and not all(row.is_ruled for row in rows)
        for number, row in enumerate(rows):
            is_bold = all(map(_is_bold, row.cells)) and len(rows) > 1
            is_head = row.is_head or (number == 0 and (is_ruled or is_bold))
            line = put(put(table, "thead"), "tr") if is_head else put(table, "tr")
            column = 0
            for place, cell in enumerate(row.cells):
                merge = row.merges[place] if place < len(row.merges) else ""
                edge = row.edges[place] if place < len(row.edges) else None
                after = edges.index(edge) + 1 if edge is not None else column + 1
                span = max(after - column, 1)
                if merge == "clvmrg" and column in above:
                    first = above[column]
                    first.set("rowspan", str(int(first.get("rowspan", "1")) + 1))
                elif merge == "clmrg" and len(line):
                    line[-1].set("colspan", str(int(line[-1].get("colspan", "1")) + span))
                else:
                    cell.tag = "th" if is_head else "td"
                    if is_head:
                        _plain_style(cell)
                    if span > 1:
                        cell.set("colspan", str(span))
                    line.append(cell)
                    above[column] = cell
                column += span


def _is_bold(cell: Element) -> bool:
    """Whether all text of a cell is bold, and there is some."""
    text = "".join(map(str, cell.itertext())).strip()
    bold = "".join("".join(map(str, e.itertext())) for e in cell.iter("b")).strip()
    return bool(text) and text == bold


def _plain_style(element: Element) -> None:
    """Take out emphasis that all the text of a heading has, which is its style's."""
    text = "".join(map(str, element.itertext())).strip()
    for tag in ("b", "i", "u"):
        found = list(element.iter(tag))
        if text and "".join("".join(map(str, e.itertext())) for e in found).strip() == text:
            for inner in found:
                inner.tag = "span"


def _known_codec(name: str) -> str:
    try:
        return codecs.lookup("utf-8" if name == "cp65001" else name).name
    except LookupError:
        return "cp1252"


def _tag(number: int) -> str:
    """Tag of a language by its number; empty if it is not known."""
    # A number below 1024 is a language's without a country, which is added here.
    tag = locale.windows_locale.get(number if number >= 0x400 else number | 0x400)
    if not number or tag is None:
        return ""
    return tag.replace("_", "-") if number >= 0x400 else tag.partition("_")[0]
