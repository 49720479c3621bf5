"""EPUBs for tests, made as their specification says, or not quite."""

import io
import zipfile

CONTAINER = (
    '<container xmlns="urn:oasis:names:tc:opendocument:xmlns:container" version="1.0"><rootfiles>'
    '<rootfile full-path="OPS/p.opf" media-type="application/oebps-package+xml"/></rootfiles>'
    "</container>"
)
XHTML = (
    '<?xml version="1.0" encoding="utf-8"?><!DOCTYPE html><html xmlns="http://www.w3.org/1999/xhtml"'
    ' xmlns:epub="http://www.idpf.org/2007/ops"{}><head><title/></head><body>{}</body></html>'
)
OPF = (
    '<package xmlns="http://www.idpf.org/2007/opf" version="3.0"><metadata '
    'xmlns:dc="http://purl.org/dc/elements/1.1/"><dc:title>A  book</dc:title>'
    "<dc:language>en</dc:language>{}</metadata><manifest>{}</manifest><spine>{}</spine></package>"
)


def xhtml(body, attributes=""):
    """A document of a chapter."""
    return XHTML.format(attributes, body)


def opf(chapters, *, metadata="", items=""):
    """A package of chapters, given as names of members; one that begins with "-" is not linear."""
    names = [name.lstrip("-") for name in chapters]
    manifest = "".join(
        f'<item id="i{n}" href="{name}" media-type="application/xhtml+xml"/>'
        for n, name in enumerate(names)
    )
    spine = "".join(
        f'<itemref idref="i{n}"{" linear=" + chr(34) + "no" + chr(34) if name[0] == "-" else ""}/>'
        for n, name in enumerate(chapters)
    )
    return OPF.format(metadata, manifest + items, spine)


def packed(members, mimetype="application/epub+zip"):
    """Bytes of a ZIP archive with these members, given by name as text or bytes."""
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("mimetype", mimetype, zipfile.ZIP_STORED)
        for name, content in members.items():
            archive.writestr(name, content)
    return stream.getvalue()


def epub(bodies, *, metadata="", items="", order=None, **members):
    """Bytes of an EPUB with chapters of these bodies, by name."""
    parts = {"META-INF/container.xml": CONTAINER}
    parts["OPS/p.opf"] = opf(order or list(bodies), metadata=metadata, items=items)
    for name, body in bodies.items():
        parts[f"OPS/{name}"] = body if body.startswith("<?") else xhtml(body)
    return packed(parts | members)
