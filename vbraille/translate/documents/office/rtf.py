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
from vbraille.translate.documents.markup.tables import BULLET
from vbraille.translate.documents.office.htmltree import (
    HIDDEN,
    PLAIN,
    BlockFlow,
    Draft,
    Look,
    OfficeTable,
    Styles,
    TextStyle,
    field_target,
    heading_level,
    put,
    put_page_break,
    put_picture,
    symbol,
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
    "bullet": "•", "emspace": "\u2003", "enspace": "\u2002", "tab": "\t", "~": "\xa0",
    "_": "\u2011", "-": "", "{": "{", "}": "}", "\\": "\\",
}  # fmt: skip
_TAGS = {"b": "b", "i": "i", "ul": "u", "strike": "s", "striked": "s", "super": "sup"}
_TAGS |= {"sub": "sub", "uldb": "u", "ulw": "u", "uld": "u", "ulwave": "u"}
_TAGS |= {"v": HIDDEN, "deleted": HIDDEN}
_ENDS = {"ulnone": frozenset(("u",)), "nosupersub": frozenset(("sup", "sub"))}
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
_SHOWN = frozenset(("", "shppict", "shpinst"))  # groups whose text is the document's
_FLOWS = frozenset(("footnote", "shptxt", "dptxbxtext"))  # those whose text goes elsewhere
_CODECS = {"mac": "mac-roman", "pc": "cp437", "pca": "cp850"}
_CHARSETS = {
    0: "cp1252", 77: "mac-roman", 128: "cp932", 129: "cp949", 130: "johab", 134: "cp936",
    136: "cp950", 161: "cp1253", 162: "cp1254", 163: "cp1258", 177: "cp1255", 178: "cp1256",
    186: "cp1257", 204: "cp1251", 222: "cp874", 238: "cp1250",
}  # fmt: skip
_NO_LANGUAGES = frozenset((0, 1024, 4096))


@dataclass(frozen=True, slots=True)
class _Group:
    r"""Properties that hold for the text of a group.

    Parameters
    ----------
    what
        What is made of its text: "" for the document's, or the name of the group's first word.
    blanks
        Number of characters after a \u that stand for it elsewhere.
    link
        Whether it is the text of a link.
    """

    what: str = ""
    look: Look = PLAIN
    font: int = 0
    blanks: int = 1
    link: bool = False


@dataclass(slots=True)
class _Told:
    """Properties that a paragraph states, or has from the one before."""

    s: int = 0  # style
    outlinelevel: int = 9
    ls: int = 0  # list
    ilvl: int = 0  # level in that
    intbl: int = 0
    is_own: bool = False


@dataclass(slots=True)
class _Row:
    """A row of a table: the right edges and the merging of its cells, and these."""

    edges: list[int] = field(default_factory=list)
    merges: dict[int, str] = field(default_factory=dict)
    cells: list[Element] = field(default_factory=list)
    is_head: bool = False
    is_ruled: bool = False


@dataclass(slots=True)
class _Place:
    """Target of the text: a body or a note, and the paragraph and the table that are read."""

    flow: BlockFlow
    told: _Told = field(default_factory=_Told)
    paragraph: Element | None = None
    link: Element | None = None  # within the paragraph
    label: str = ""
    rows: list[_Row] = field(default_factory=list)
    row: _Row = field(default_factory=_Row)
    cell: Element | None = None

    def inner(self) -> Element:
        """Element in which the next text stands."""
        if self.paragraph is None:
            self.paragraph = etree.Element("p")
        return self.paragraph if self.link is None else self.link


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
    return _Reader(name, content.decode("latin-1")).read()


class _Reader:
    """Reads one document."""

    def __init__(self, name: str, text: str) -> None:
        self._name = name
        self._text = text
        self._draft = Draft()
        self._place = _Place(BlockFlow(self._draft.body))
        usual = _USUAL.search(text, 0, _HEADER)
        named = [usual[1]] if usual is not None else _LANGUAGE.findall(text)
        tags = (_tag(int(number)) for number, _ in Counter(named).most_common())
        self._usual = next(filter(None, tags), "")
        self._group = _Group(look=Look(self._usual))
        self._around: list[tuple[_Group, _Place | None]] = []  # and places that end with them
        self._texts: dict[str, list[str]] = {}  # of groups that are no text of the document
        self._notes: dict[str, Element] = {}
        self._codecs: dict[int, str] = {}  # of fonts
        self._fonts: dict[int, str] = {}
        self._usual_codec = "cp1252"
        self._styles = Styles()
        self._style: dict[str, int] = {}  # what is said of the style that is read
        self._bytes = bytearray()
        self._swallow = 0
        self._high = 0  # first half of a character of two
        self._opens = self._starred = False  # whether a group has just begun, and with a star
        self._font_at = -1

    def read(self) -> tuple[Element, str, str]:
        at = 0
        while (token := _TOKEN.match(self._text, at)) is not None:
            at = token.end()
            word, number, byte, sign, brace, plain = token.groups()
            if word == "bin":
                at += max(int(number or 0), 0)
            elif byte is not None:
                if not self._swallow:
                    self._bytes.append(int(byte, 16))
                self._swallow = max(self._swallow - 1, 0)
            else:
                self._flush()
                if plain is not None:
                    self._plain(plain)
                elif word is not None:
                    self._word(word, None if number is None else int(number))
                elif sign is not None:
                    self._sign(sign)
                elif brace is not None:
                    self._brace(brace)
        self._flush()
        while self._around:
            self._brace("}")
        self._end_table()
        for key, item in self._draft.notes():
            item.extend(list(self._notes[key]))
        language = self._draft.finish(self._usual)
        return self._draft.html, " ".join(self._gathered("title").split()), language

    def _gathered(self, what: str) -> str:
        return "".join(self._texts.get(what, ())).strip()

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
        ended, (self._group, place) = self._group, self._around.pop()
        if place is not None:
            self._end_table()
            self._place = place
        elif ended.what != self._group.what or ended.what == "font":
            self._end_group(ended.what)
        if ended.link and not self._group.link:
            self._place.link = None

    def _end_group(self, what: str) -> None:
        """End a group of text that was gathered."""
        text = self._gathered(what)
        if what == "bkmkstart":
            put(self._place.inner(), "a", id=text)
        elif what == "stylesheet-entry":
            level = self._style.get("outlinelevel", 9) + 1
            based = str(self._style.get("sbasedon", ""))
            name = text.strip(" ;").lower()
            self._styles[str(self._style["s"])] = TextStyle(
                name, based, level=level if level < 10 else None
            )
        elif what in ("listtext", "pntext"):
            self._place.label = text
        elif what == "pict" and self._group.what in ("", "shppict"):
            put_picture(self._place.inner(), self._gathered("described"))
            self._texts.pop("described", None)
        elif what == "sv" and self._gathered("sn") == "wzDescription":
            self._texts["described"] = [text]
        elif what == "font" and text:
            self._fonts[self._font_at] = text.strip(" ;").lower()
        if what not in ("title", "described", "sn", "fldinst"):
            self._texts.pop(what, None)

    def _plain(self, text: str) -> None:
        left = min(self._swallow, len(text))
        self._swallow -= left
        text = text[left:]
        if not text.isascii():  # a byte as it is
            text = text.encode("latin-1").decode(self._codec(), "replace")
        self._say(text)

    def _codec(self) -> str:
        return self._codecs.get(self._group.font, self._usual_codec)

    def _flush(self) -> None:
        """Read the bytes that were gathered, of which two may be one character."""
        if self._bytes:
            content, self._bytes = bytes(self._bytes), bytearray()
            if font := self._signs():
                self._say("".join(symbol(byte, font) or "\ufffd" for byte in content))
            else:
                self._say(content.decode(self._codec(), "replace"))

    def _signs(self) -> str:
        """Name of the font that the text is in, if it is one of signs."""
        font = self._fonts.get(self._group.font, "")
        return font if font.startswith(("symbol", "wingdings")) else ""

    def _say(self, text: str) -> None:
        what = self._group.what
        if what not in _SHOWN:
            self._texts.setdefault(what, []).append(text)
        elif text and not what:
            text = _UNPRINTABLE.sub("", text)
            self._draft.say(self._place.inner(), text, self._group.look)

    def _sign(self, sign: str) -> None:
        if sign == "*":
            self._starred = True
        elif sign in "\r\n":
            self._end_paragraph()
        elif sign != "~" or self._place.paragraph is not None:  # which stands before a note's text
            self._say(_SPOKEN.get(sign, ""))

    def _word(self, word: str, number: int | None) -> None:
        """Read a control word."""
        opens, self._opens = self._opens, False
        starred, self._starred = self._starred, False
        self._swallow = 0
        group = self._group
        if opens and (word in _SKIPPED or (starred and word not in _KNOWN)):
            self._texts.pop(word, None)
            what = {"fonttbl": "font", "info": "info"}.get(word, "skipped")
            self._group = replace(group, what=what)
        elif group.what == "skipped":
            return
        elif word == "u":
            self._unicode(number or 0)
        elif word in _SPOKEN:
            self._say(_SPOKEN[word])
        elif word == "ansicpg" and number:
            self._usual_codec = _known_codec(f"cp{number}")
        elif word in _CODECS:
            self._usual_codec = _CODECS[word]
        elif not self._destination(word):
            if group.what in _SHOWN:
                self._of_text(word, number or 0)
            elif group.what in ("font", "stylesheet", "stylesheet-entry"):
                self._of_tables(word, number or 0)
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
            self._say(symbol(code, self._signs() or "symbol") or "\ufffd")
        elif code < 0x110000:
            self._say(chr(code))

    def _destination(self, word: str) -> bool:
        """Begin a group whose text is no text of the document, or goes elsewhere."""
        group = self._group
        if word in _FLOWS and self._around:
            self._around[-1] = (self._around[-1][0], self._place)
            if word == "footnote":
                key = f"note-{len(self._notes)}"
                body = self._notes[key] = etree.Element("div")
                self._draft.refer(self._place.inner(), key)
            else:
                body = put(self._place.inner(), "div")
            self._place = _Place(BlockFlow(body))
            tags = group.look.tags & {HIDDEN}
            self._group = replace(group, what="", link=False, look=replace(group.look, tags=tags))
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
                self._place.link = put(self._place.inner(), "a", href=target)
                self._group = replace(group, link=True)
        else:
            return False
        return True

    def _of_tables(self, word: str, number: int) -> None:
        """Read what is said of a font or of a style."""
        if self._group.what == "font":
            if word == "f":
                self._font_at = number
                self._texts.pop("font", None)
            elif word == "fcharset" and number in _CHARSETS:
                self._codecs[self._font_at] = _CHARSETS[number]
        elif self._group.what == "stylesheet" and word in ("s", "cs", "ts", "ds"):
            self._group = replace(self._group, what="stylesheet-entry")
            self._style = {"s": number if word == "s" else -1}
        elif word in ("outlinelevel", "sbasedon"):
            self._style[word] = number

    def _of_characters(self, word: str, number: int | None) -> None:
        """Read how characters look."""
        group, look = self._group, self._group.look
        if word == "plain":
            look = Look(self._usual)
        elif word in _TAGS or word in _ENDS:
            tags = _ENDS.get(word) or frozenset((_TAGS[word],))
            is_off = number == 0 or word in _ENDS
            look = replace(look, tags=look.tags - tags if is_off else look.tags | tags)
        elif word == "lang" and number is not None:
            tag = self._usual if number in _NO_LANGUAGES else _tag(number)
            look = replace(look, language=tag)
        elif word in ("f", "deff"):
            self._group = replace(group, font=number or 0)
        elif word == "uc":
            self._group = replace(group, blanks=max(number or 0, 0))
        if look is not group.look:
            self._group = replace(group, look=look)

    def _of_text(self, word: str, number: int) -> None:
        """Read what words of paragraphs, tables and breaks say."""
        place, row = self._place, self._place.row
        match word:
            case "par" | "sect" | "nestcell":
                self._end_paragraph()
            case "line":
                put(place.inner(), "br")
            case "page":
                put_page_break(place.inner())
            case "pard":
                place.told = _Told(is_own=True)
            case "s" | "outlinelevel" | "ls" | "ilvl":
                setattr(place.told, word, number)
            case "intbl":
                place.told.intbl = 1
            case "cell":
                place.told.intbl = 1
                self._end_paragraph()
                row.cells.append(etree.Element("td") if place.cell is None else place.cell)
                place.cell = None
            case "row":
                self._end_row()
            case "trowd":
                place.row = _Row(cells=row.cells)
            case "trhdr":
                row.is_head = True
            case "clbrdrb":
                row.is_ruled = True
            case "clmgf" | "clmrg" | "clvmgf" | "clvmrg":
                row.merges[len(row.edges)] = word
            case "cellx":
                row.edges.append(number)

    def _end_paragraph(self) -> None:
        """Put the paragraph where it belongs."""
        place, told = self._place, self._place.told
        paragraph, place.paragraph, place.link = place.paragraph, None, None
        if paragraph is None:
            return
        if told.intbl:
            place.cell = etree.Element("td") if place.cell is None else place.cell
            place.cell.append(paragraph)
            return
        self._end_table()
        styles = [TextStyle(level=told.outlinelevel + 1 if told.outlinelevel < 9 else None)]
        styles += self._styles.chain(str(told.s))
        level = heading_level(styles)
        label, item = place.label, None
        if (told.ls or label) and not level:
            is_bullet = not any(map(str.isalnum, label)) or label in ("o", "§")
            marker = BULLET if is_bullet else f"{label} "
            goes_on = not label and told.is_own
            at = min(max(told.ilvl, 0), 8)
            item = "bullets" if is_bullet else "labels", at, None if goes_on else marker
            place.label, told.is_own = "", False
        place.flow.add(paragraph, styles, level, item)

    def _end_row(self) -> None:
        place = self._place
        if place.row.cells:
            place.rows.append(place.row)
            place.row = replace(place.row, cells=[])
        place.told.intbl = 0

    def _end_table(self) -> None:
        """Put the rows that were read as a table."""
        place = self._place
        if place.paragraph is not None:
            self._end_paragraph()
        stray, place.cell = place.cell, None  # said to be in a table, and in no cell of one
        self._end_row()
        rows, place.rows = place.rows, []
        if rows:
            place.flow.add_table(_table_of(rows))
        if stray is not None:
            place.flow.into.extend(list(stray))


def _table_of(rows: list[_Row]) -> OfficeTable:
    """Table of rows, whose cells stand at the edges that any of them has."""
    table = OfficeTable()
    edges = sorted({edge for row in rows for edge in row.edges})
    is_ruled = rows[0].is_ruled and not all(row.is_ruled for row in rows)
    for number, row in enumerate(rows):
        is_bold = all(map(_is_bold, row.cells)) and len(rows) > 1
        table.row(is_head=row.is_head or (number == 0 and (is_ruled or is_bold)))
        for index, cell in enumerate(row.cells):
            merge = row.merges.get(index)
            edge = row.edges[index] if index < len(row.edges) else None
            after = edges.index(edge) + 1 if edge is not None else table.column + 1
            span = max(after - table.column, 1)
            if merge == "clmrg" and index:
                table.widen(span)
            else:
                table.cell(span, goes_on=merge == "clvmrg", cell=cell)
    return table


def _is_bold(cell: Element) -> bool:
    """Tell whether all text of a cell is bold, and there is some."""
    text = "".join(map(str, cell.itertext())).strip()
    bold = "".join("".join(map(str, e.itertext())) for e in cell.iter("b")).strip()
    return bool(text) and text == bold


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
