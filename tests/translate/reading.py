"""Books for tests: of every format from a few strings."""

import io
import zipfile

from vbraille.translate import open_source

WORD = "http://schemas.openxmlformats.org/wordprocessingml/2006/main"
MATH = "http://schemas.openxmlformats.org/officeDocument/2006/math"
ODF = {
    name: f"urn:oasis:names:tc:opendocument:xmlns:{name}:1.0"
    for name in ("office", "text", "table", "style", "drawing")
} | {"fo": "urn:oasis:names:tc:opendocument:xmlns:xsl-fo-compatible:1.0"}


def opened(content, name="book.txt", **how):
    """Source of bytes or of a string."""
    content = content.encode() if isinstance(content, str) else content
    return open_source(io.BytesIO(content), name=name, **how)


def blocks(content, name="book.html", **how):
    """All blocks of a book."""
    return list(opened(content, name, **how).blocks())


def said(content, name="book.html", **how):
    """Kind and text of each block: "item 1. one"."""
    return [f"{block.kind.value} {block.text}" for block in blocks(content, name, **how)]


def zipped(members):
    """Bytes of a zip archive."""
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w") as archive:
        for name, content in members.items():
            archive.writestr(name, content)
    return stream.getvalue()


def docx(body, **parts):
    """Bytes of a DOCX file with a body, and with parts such as numbering="…"."""
    space = f'xmlns:w="{WORD}" xmlns:m="{MATH}"'
    members = {
        "[Content_Types].xml": "<Types/>",
        "word/document.xml": f"<w:document {space}><w:body>{body}</w:body></w:document>",
    }
    for name, content in parts.items():
        members[f"word/{name}.xml"] = f"<w:{name} {space}>{content}</w:{name}>"
    return zipped(members)


def odt(body, styles=""):
    """Bytes of an ODT file with a body, and automatic styles."""
    spaces = " ".join(f'xmlns:{name}="{address}"' for name, address in ODF.items())
    content = (
        f"<office:document-content {spaces}><office:automatic-styles>{styles}"
        f"</office:automatic-styles><office:body><office:text>{body}</office:text></office:body>"
        f"</office:document-content>"
    )
    kind = "application/vnd.oasis.opendocument.text"
    return zipped({"mimetype": kind, "content.xml": content})
