"""What DOCX and ODT say in XML and a converter leaves out: languages, small letters, pages.

It is written into the text itself, as annotations that `officehtml` takes out again.
"""

from __future__ import annotations

import io
from dataclasses import dataclass
from typing import TYPE_CHECKING
from zipfile import ZIP_STORED, BadZipFile, ZipFile

from lxml import etree

from vbraille.translate.documents.office.docxmarks import mark_docx
from vbraille.translate.documents.office.odtmarks import mark_odt

if TYPE_CHECKING:
    from lxml.etree import _Element

    Element = _Element

LARGEST_MEMBER_BYTES = 200 << 20
_TEXTS = {
    "docx": ("word/document.xml", "word/footnotes.xml", "word/endnotes.xml"),
    "odt": ("content.xml",),
}
_ABOUT = {"docx": ("docProps/core.xml", "word/styles.xml"), "odt": ("meta.xml", "styles.xml")}
_NO_PICTURE = b"\x89PNG\r\n\x1a\n"
_KEPT = (".xml", ".rels", "mimetype")


@dataclass(frozen=True, slots=True)
class Annotated:
    """A document with its annotations.

    Parameters
    ----------
    content
        The document's bytes; unchanged if nothing could be read of them.
    title
        Title of the document; empty if it has none.
    language
        Tag of the language that most of its text is in; empty if it does not say.
    """

    content: bytes
    title: str = ""
    language: str = ""


def annotated(content: bytes, form: str) -> Annotated:
    """Annotate a document.

    A file that is damaged comes back as it is, for the converter to say what is wrong.

    Parameters
    ----------
    content
        Bytes of the document.
    form
        "docx" or "odt".
    """
    try:
        with ZipFile(io.BytesIO(content)) as archive:
            about, styles = (_parsed(archive, name) for name in _ABOUT[form])
            parsed = {name: _parsed(archive, name) for name in _TEXTS[form]}
            roots = {name: root for name, root in parsed.items() if root is not None}
            if _TEXTS[form][0] not in roots:
                return Annotated(content)
            told = _told(about, "language")
            mark = mark_docx if form == "docx" else mark_odt
            language = mark(list(roots.values()), styles, told)
            packed = _packed(archive, roots)
            return Annotated(packed or content, _told(about, "title"), language)
    except (BadZipFile, OSError, ValueError, RuntimeError, NotImplementedError, etree.LxmlError):
        return Annotated(content)


def _parsed(archive: ZipFile, name: str) -> Element | None:
    """Root of a member; None if there is none, or it is larger than any should be."""
    import zlib

    try:
        info = archive.getinfo(name)
        if info.file_size > LARGEST_MEMBER_BYTES:
            return None
        with archive.open(info) as member:
            read = member.read(LARGEST_MEMBER_BYTES)
    except (KeyError, EOFError, zlib.error):
        return None
    parser = etree.XMLParser(
        resolve_entities=False, no_network=True, load_dtd=False, huge_tree=False
    )
    return etree.fromstring(read, parser)


def _packed(archive: ZipFile, roots: dict[str, Element]) -> bytes | None:
    """Archive with some members replaced, and with no more than the names of pictures.

    The result is None if the archive holds more than any document should.
    """
    packed = io.BytesIO()
    with ZipFile(packed, "w", ZIP_STORED) as out:
        for info in archive.infolist():
            if info.filename in roots:
                out.writestr(info.filename, etree.tostring(roots[info.filename], encoding="utf-8"))
            elif not info.filename.endswith(_KEPT):
                out.writestr(info.filename, _NO_PICTURE)
            elif packed.tell() + info.file_size > LARGEST_MEMBER_BYTES:
                return None
            else:
                with archive.open(info) as member:
                    out.writestr(info.filename, member.read(LARGEST_MEMBER_BYTES))
    return packed.getvalue()


def _told(about: Element | None, name: str) -> str:
    """Value of the first of Dublin Core's elements with a name."""
    found = None if about is None else about.find(f".//{{http://purl.org/dc/elements/1.1/}}{name}")
    return "" if found is None else " ".join("".join(map(str, found.itertext())).split())
