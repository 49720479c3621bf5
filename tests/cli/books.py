"""Books that are wrong in ways that their makers, or an attacker, have made them."""

import io
import struct
import zipfile
import zlib

CONTAINER = (
    '<container xmlns="urn:oasis:names:tc:opendocument:xmlns:container" version="1.0"><rootfiles>'
    '<rootfile full-path="{}" media-type="application/oebps-package+xml"/></rootfiles></container>'
)
PACKAGE = (
    '<package xmlns="http://www.idpf.org/2007/opf" version="3.0" unique-identifier="i">'
    '<metadata xmlns:dc="http://purl.org/dc/elements/1.1/"><dc:title>Bad</dc:title></metadata>'
    "<manifest>{}</manifest><spine>{}</spine></package>"
)
XHTML = (
    '<html xmlns="http://www.w3.org/1999/xhtml"><head><title>x</title></head><body>{}</body></html>'
)
TYPES = (
    '<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types">'
    '<Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships'
    '+xml"/><Override PartName="/word/document.xml" ContentType="application/vnd.openxmlformats-'
    'officedocument.wordprocessingml.document.main+xml"/></Types>'
)
RELATIONS = (
    '<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">'
    '<Relationship Id="r" Type="http://schemas.openxmlformats.org/officeDocument/2006/'
    'relationships/officeDocument" Target="word/document.xml"/></Relationships>'
)
WORD = (
    '<w:document xmlns:w="http://schemas.openxmlformats.org/wordprocessingml/2006/main"><w:body>'
    "{}</w:body></w:document>"
)
ODT = (
    '<office:document-content xmlns:office="urn:oasis:names:tc:opendocument:xmlns:office:1.0" '
    'xmlns:text="urn:oasis:names:tc:opendocument:xmlns:text:1.0"><office:body><office:text>{}'
    "</office:text></office:body></office:document-content>"
)
BOMB = (
    "<?xml version='1.0'?><!DOCTYPE {root} [<!ENTITY a 'ten letters'>"
    + "".join(f"<!ENTITY {chr(98 + n)} '{f'&{chr(97 + n)};' * 10}'>" for n in range(9))
    + "]>"
)


def archive(members, *, kind="application/epub+zip"):
    """Bytes of a zip archive."""
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as out:
        if kind:
            out.writestr("mimetype", kind, zipfile.ZIP_STORED)
        for name, content in members.items():
            out.writestr(name, content)
    return packed.getvalue()


def item(identity, path, kind="application/xhtml+xml", more=""):
    return f'<item id="{identity}" href="{path}" media-type="{kind}" {more}/>'


def epub(chapters, *, manifest="", spine=None, members=None):
    """An EPUB of chapters, by their names."""
    items = "".join(item(f"c{n}", name) for n, name in enumerate(chapters)) + manifest
    order = "".join(f'<itemref idref="c{n}"/>' for n in range(len(chapters)))
    return archive(
        {
            "META-INF/container.xml": CONTAINER.format("book.opf"),
            "book.opf": PACKAGE.format(items, order if spine is None else spine),
            **chapters,
            **(members or {}),
        }
    )


def docx(document=None, members=None):
    """A DOCX file, perhaps with a document."""
    named = {} if document is None else {"word/document.xml": document}
    types = {"[Content_Types].xml": TYPES, "_rels/.rels": RELATIONS}
    return archive({**types, **named, **(members or {})}, kind="")


def odt(content=None, members=None):
    """An ODT file, perhaps with content."""
    named = {} if content is None else {"content.xml": content}
    kind = "application/vnd.oasis.opendocument.text"
    manifest = (
        '<manifest:manifest xmlns:manifest="urn:oasis:names:tc:opendocument:xmlns:manifest:1.0">'
        f'<manifest:file-entry manifest:full-path="/" manifest:media-type="{kind}"/>'
        "</manifest:manifest>"
    )
    return archive({"META-INF/manifest.xml": manifest, **named, **(members or {})}, kind=kind)


def locked(content, name):
    """The archive with a member marked as encrypted."""
    changed = bytearray(content)
    for signature, flags, names in ((b"PK\3\4", 6, 30), (b"PK\1\2", 8, 46)):
        at = content.find(signature)
        while at >= 0:
            if content[at + names : at + names + len(name)] == name.encode():
                changed[at + flags] |= 1
            at = content.find(signature, at + 1)
    return bytes(changed)


def with_bomb(content, name, mebibytes, *, told=None):
    """Archive with one more member of zeros, of so many MiB, or of what it says it has.

    It is packed a MiB at a time, all alike, which takes no more time than one.
    """
    zeros = bytes(1 << 20)
    packer = zlib.compressobj(9, zlib.DEFLATED, -15)
    packer.compress(b"")
    block = packer.compress(zeros) + packer.flush(zlib.Z_FULL_FLUSH)
    packed = block * mebibytes + b"\3\0"
    crc = 0
    for _ in range(mebibytes):
        crc = zlib.crc32(zeros, crc)
    size = (mebibytes << 20) if told is None else told
    end = content.rindex(b"PK\5\6")
    count, length, start = struct.unpack("<HII", content[end + 10 : end + 20])
    common = struct.pack("<HHHHHIIIHH", 20, 0, 8, 0, 33, crc, len(packed), size, len(name), 0)
    local = b"PK\3\4" + common + name.encode() + packed
    directory = content[start : start + length] + (
        b"PK\1\2\x14\0" + common + struct.pack("<HHHII", 0, 0, 0, 0, start) + name.encode()
    )
    at = start + len(local)
    count += 1
    tail = struct.pack("<HHHHIIH", 0, 0, count, count, len(directory), at, 0)
    return content[:start] + local + directory + b"PK\5\6" + tail
