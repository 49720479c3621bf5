"""RTF, by LibreOffice where it is installed, else its text alone."""

from __future__ import annotations

import io
import subprocess
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

from vbraille.errors import InputError
from vbraille.translate.docx import read_docx
from vbraille.translate.plain import text_blocks

if TYPE_CHECKING:
    from collections.abc import Iterator

    from vbraille.translate.blocks import Block
    from vbraille.translate.source import Source

_MOST_S = 60.0


def read_rtf(source: Source) -> Iterator[Block]:
    """Read an RTF file.

    Raises
    ------
    InputError
        If it is damaged, or LibreOffice cannot read it.
    """
    content = source.stream.read()
    made = _converted(content)
    if made:
        return read_docx(source, io.BytesIO(made))
    from striprtf.striprtf import rtf_to_text

    try:
        text = rtf_to_text(content.decode("cp1252", "replace"), errors="replace")
    except (ValueError, LookupError, IndexError, RecursionError):
        raise InputError(
            f"{source.name} is a damaged RTF file; save it again, or as DOCX"
        ) from None
    source.note(
        f"{source.name} is read as plain text, without headings and notes, for LibreOffice "
        f"(soffice) is not installed or cannot read it"
    )
    # Lone surrogates are halves of what RTF writes in two.
    text = text.encode("utf-16-le", "surrogatepass").decode("utf-16-le", "replace")
    return text_blocks(source, text.replace("\n", "\n\n"))


def _converted(content: bytes) -> bytes:
    """The file as DOCX; nothing if LibreOffice cannot make it."""
    with TemporaryDirectory() as folder:
        book = Path(folder, "book.rtf")
        book.write_bytes(content)
        profile = f"-env:UserInstallation={Path(folder, 'profile').as_uri()}"
        command = ["soffice", profile, "--headless", "--convert-to", "docx", "--outdir", folder]
        try:
            subprocess.run([*command, str(book)], capture_output=True, timeout=_MOST_S, check=False)
            return book.with_suffix(".docx").read_bytes()
        except (OSError, subprocess.TimeoutExpired):
            return b""
