"""The package of an EPUB: title, language, chapters in their order, and tables of contents."""

from __future__ import annotations

import posixpath
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any
from urllib.parse import unquote

from vbraille.errors import InputError

if TYPE_CHECKING:
    from vbraille.translate.documents.markup.archive import Archive

CONTAINER = "META-INF/container.xml"
_EBRAILLE = "application/ebrl+zip"
_XHTML = frozenset(("application/xhtml+xml", "text/html", "text/x-oeb1-document"))
_DTBOOK = "application/x-dtbook+xml"
_OPS = "{http://www.idpf.org/2007/ops}"


@dataclass(frozen=True, slots=True)
class BookPart:
    """A document that a book is read from.

    Parameters
    ----------
    member
        Name of its member in the archive.
    kind
        Type of the document, such as "application/xhtml+xml".
    """

    member: str
    kind: str

    @property
    def is_text(self) -> bool:
        """Tell whether the document is markup."""
        return self.kind in _XHTML or self.kind in (_DTBOOK, "image/svg+xml")

    @property
    def is_dtbook(self) -> bool:
        """Tell whether the document is of DAISY's markup."""
        return self.kind == _DTBOOK


@dataclass(frozen=True, slots=True)
class Package:
    """Facts that an EPUB says of itself.

    Parameters
    ----------
    title, language
        Title, and tag of the language; empty if it does not say.
    chapters
        Documents in the order of reading; those that are not part of it come last.
    contents
        Member with the table of contents: a navigation document, or an NCX; empty if none.
    is_braille
        Whether the book is in braille, so that it is an eBraille publication.
    """

    title: str
    language: str
    chapters: tuple[BookPart, ...]
    contents: str
    is_braille: bool


def read_package(archive: Archive) -> Package:
    """Read the package of an EPUB.

    Raises
    ------
    InputError
        If a part that says where the text is is missing, damaged or empty.
    """
    member = _package_member(archive)
    root = archive.xml(member)
    items: dict[str, Any] = {}
    for item in root.iterfind("{*}manifest/{*}item"):
        items.setdefault(item.get("id", ""), item)

    def place(item: Any) -> str:
        return inside(member, item.get("href", ""))

    first, last = [], []
    for reference in root.iterfind("{*}spine/{*}itemref"):
        item = _readable(items, reference.get("idref", ""))
        if item is not None:
            kind = item.get("media-type", "").strip().lower()
            chapter = BookPart(place(item), kind)
            (last if reference.get("linear") == "no" else first).append(chapter)
    chapters = tuple(dict.fromkeys(first + last))
    if not chapters:
        raise InputError(
            f"{archive.name} does not say what its chapters are: its spine is empty; get another "
            f"copy of the book"
        )
    if not any(chapter.member in archive for chapter in chapters):
        raise InputError(f"{archive.name} has none of its chapters; get the book again")
    contents = [i for i in items.values() if "nav" in i.get("properties", "").split()]
    contents += [i for i in items.values() if i.get("media-type") == "application/x-dtbncx+xml"]
    return Package(
        _said(root, "title"),
        _said(root, "language"),
        chapters,
        next((place(item) for item in contents if place(item) in archive), ""),
        _is_braille(archive, root),
    )


def inside(member: str, address: str) -> str:
    """Name of the member that an address in another member means."""
    path = unquote(address.partition("#")[0].partition("?")[0])
    folder = posixpath.dirname(member)
    return posixpath.normpath(posixpath.join(folder, path)) if path else member


def _package_member(archive: Archive) -> str:
    """Member with the package, as the container says, or else one with its usual name."""
    if CONTAINER in archive:
        for file in archive.xml(CONTAINER).iter("{*}rootfile"):
            member = posixpath.normpath(file.get("full-path", ""))
            if member in archive:
                return member
    member = archive.any_of(("package.opf", "content.opf", "OEBPS/content.opf", "OPS/content.opf"))
    if member is None:
        what = "package document" if CONTAINER in archive else CONTAINER
        raise InputError(f"{archive.name} is no EPUB: it has no {what}; give a book")
    return member


def _readable(items: dict[str, Any], identity: str) -> Any | None:
    """Item of the manifest, or the one to fall back to that is markup."""
    item = first = items.get(identity)
    seen = set()
    while item is not None and identity not in seen:
        seen.add(identity)
        if BookPart("", item.get("media-type", "").strip().lower()).is_text:
            return item
        identity = item.get("fallback", "")
        item = items.get(identity)
    return first


def _said(root: Any, name: str) -> str:
    """First text of the metadata with a name, wherever in them it stands."""
    for element in root.iterfind("{*}metadata//{http://purl.org/dc/elements/1.1/}" + name):
        text = " ".join("".join(element.itertext()).split())
        if text:
            return text
    return ""


def _is_braille(archive: Archive, root: Any) -> bool:
    if "mimetype" in archive and archive.read("mimetype", 1_000).strip() == _EBRAILLE.encode():
        return True
    return any(
        meta.get("property") == "a11y:brailleSystem"
        for meta in root.iterfind("{*}metadata/{*}meta")
    )


def read_outline(archive: Archive, package: Package) -> tuple[tuple[int, str, str], ...]:
    """Read the table of contents.

    Returns
    -------
    tuple of (level, title, target)
        Entries in their order: depth from 1, text, and "#" with the name of an anchor.

    Raises
    ------
    InputError
        If it is damaged.
    """
    if not package.contents:
        return ()
    root = archive.xml(package.contents)
    if str(root.tag).endswith("}ncx") or root.tag == "ncx":
        entries = _points(root)
    else:
        tocs = [nav for nav in root.iter("{*}nav") if "toc" in nav.get(f"{_OPS}type", "").split()]
        tocs = tocs or list(root.iter("{*}nav"))
        entries = _links(tocs[0]) if tocs else []
    return tuple(
        (level, " ".join(title.split()), anchor_of(package.contents, address))
        for level, title, address in entries
        if title.strip()
    )


def read_page_list(archive: Archive, package: Package) -> dict[str, str]:
    """Read the list of the printed book's pages: the number of each, by the name of its anchor.

    It is empty if there is none, or if it is damaged.
    """
    if not package.contents:
        return {}
    try:
        root = archive.xml(package.contents)
    except InputError:  # who asks for the table of contents is told of it
        return {}
    if str(root.tag).endswith("}ncx") or root.tag == "ncx":
        entries = [_point(1, page) for page in root.iterfind("{*}pageList/{*}pageTarget")]
    else:
        navs = (n for n in root.iter("{*}nav") if "page-list" in n.get(f"{_OPS}type", "").split())
        entries = [entry for nav in navs for entry in _links(nav)]
    pages: dict[str, str] = {}
    for _, number, address in entries:
        pages.setdefault(anchor_of(package.contents, address)[1:], " ".join(number.split()))
    return pages


def anchor_of(member: str, address: str) -> str:
    """Target of a link from a member: the book-wide name of an anchor, or an address elsewhere.

    >>> anchor_of("OEBPS/a.xhtml", "b%20c.xhtml#d"), anchor_of("OEBPS/a.xhtml", "#e")
    ('#OEBPS/b c.xhtml#d', '#OEBPS/a.xhtml#e')
    >>> anchor_of("OEBPS/a.xhtml", "mailto:reader@example.org")
    'mailto:reader@example.org'
    """
    scheme, colon, _ = address.partition(":")
    if (colon and scheme.isalnum()) or address.startswith("//"):
        return address
    fragment = unquote(address.partition("#")[2])
    place = inside(member, address)
    return f"#{place}#{fragment}" if fragment else f"#{place}"


def _points(root: Any) -> list[tuple[int, str, str]]:
    """Entries of an NCX."""
    entries = []
    open_points = [(1, point) for point in root.iterfind("{*}navMap/{*}navPoint")][::-1]
    while open_points:
        level, point = open_points.pop()
        entries.append(_point(level, point))
        open_points += [(level + 1, inner) for inner in point.iterfind("{*}navPoint")][::-1]
    return entries


def _point(level: int, point: Any) -> tuple[int, str, str]:
    title = "".join(t for label in point.iterfind("{*}navLabel") for t in label.itertext())
    content = point.find("{*}content")
    return level, title, content.get("src", "") if content is not None else ""


def _links(nav: Any) -> list[tuple[int, str, str]]:
    """Entries of a navigation document's list."""
    entries = []
    open_lists = [(1, one) for one in nav.iterfind("{*}ol")][::-1]
    while open_lists:
        level, element = open_lists.pop()
        if element.tag.endswith("li"):
            label = next((e for e in element if _is_label(e)), None)
            if label is not None:
                entries.append((level, "".join(label.itertext()), label.get("href", "")))
            open_lists += [(level + 1, inner) for inner in element.iterfind("{*}ol")][::-1]
        else:
            open_lists += [(level, item) for item in element.iterfind("{*}li")][::-1]
    return entries


def _is_label(element: Any) -> bool:
    return isinstance(element.tag, str) and element.tag.rpartition("}")[2] in ("a", "span")
