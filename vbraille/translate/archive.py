"""Members of a ZIP archive that holds a book, read within bounds."""

from __future__ import annotations

import unicodedata
import zipfile
import zlib
from typing import BinaryIO

from vbraille.errors import InputError
from vbraille.translate.trees import Element, parse_xml
from vbraille.wording import printable

MOST_BYTES = 100_000_000  # of a file, or of a member when it is unpacked
# Fonts are garbled in books that are open otherwise; no text is.
_FONTS = (
    "http://www.idpf.org/2008/embedding",
    "http://ns.adobe.com/pdf/enc#RC",
    "http://ns.adobe.com/pdf/enc#rc",
)
# Files of locks, and what is in them; Adobe's has the name of one that tells who owns a book.
# OpenDocument lists its parts with their encryption.
_LOCKS = (
    ("META-INF/license.lcpl", b"{", "Readium LCP"),
    ("META-INF/sinf.xml", b"<", "Apple FairPlay"),
    ("META-INF/rights.xml", b"adept", "Adobe ADEPT"),
    ("META-INF/manifest.xml", b"encryption-data", "a password"),
)
_FAULTS = (
    zipfile.BadZipFile, zlib.error, EOFError, RuntimeError, OSError, ValueError
)  # fmt: skip


class Archive:
    """A ZIP archive that holds a book.

    Parameters
    ----------
    stream
        Bytes of the archive; the stream must be able to seek.
    name
        Name of the book in messages.

    Raises
    ------
    InputError
        If it is no ZIP archive, or damaged, or the book is locked.
    """

    def __init__(self, stream: BinaryIO, name: str) -> None:
        self.name = name
        try:
            self._zip = zipfile.ZipFile(stream)
        except _FAULTS:
            raise InputError(
                f"{name} is a zip archive that is damaged or cut short, as a book can be; "
                f"get it again"
            ) from None
        self.members = self._zip.namelist()
        self._alike: dict[str, list[zipfile.ZipInfo]] = {}
        for info in self._zip.infolist():
            self._alike.setdefault(_plain(info.filename), []).append(info)
        locks = [lock for member, sign, lock in _LOCKS if sign in self.read_if(member)]
        listed = self.xml("META-INF/encryption.xml", needed=False)
        ways = {method.get("algorithm") for method in listed.iter("encryptionmethod")}
        if ways.difference(_FONTS) or (locks and listed.name == "missing"):
            lock = [*locks, "a lock that it does not name"][0]
            raise InputError(f"{name} is locked by {lock}; get a copy of it without a lock")

    def find(self, name: str) -> zipfile.ZipInfo | None:
        """Member of a name, or the only one that differs from it in case or accents alone."""
        alike = self._alike.get(_plain(name), [])
        exact = [info for info in alike if info.filename == name]
        return exact[-1] if exact else alike[0] if len(alike) == 1 else None

    def read(self, name: str) -> bytes:
        """Read a member.

        Raises
        ------
        InputError
            If it is not there, locked, damaged or too large.
        """
        info, told = self.find(name), printable(name)
        if info is None:
            raise InputError(f"{self.name} lacks its part {told}; get the book again")
        if info.file_size > MOST_BYTES:
            raise InputError(
                f"{self.name} has a part {told} of {info.file_size / 1e6:.0f} MB, more than "
                f"{MOST_BYTES / 1e6:.0f} MB; that is no text of a book"
            )
        try:
            with self._zip.open(info) as stream:  # which gives no more than it says it has
                return stream.read(MOST_BYTES)
        except _FAULTS as error:
            raise InputError(
                f"the part {told} of {self.name} cannot be read ({printable(str(error))}); "
                f"get it again, or without its password"
            ) from None

    def read_if(self, name: str) -> bytes:
        """Read a member that need not be there; without it, nothing."""
        return b"" if self.find(name) is None else self.read(name)

    def xml(self, name: str, *, needed: bool = True) -> Element:
        """Root of a member in XML, without namespaces.

        Parameters
        ----------
        name
            Name of the member.
        needed
            Whether it must be there; otherwise an element with nothing in it stands for it.

        Raises
        ------
        InputError
            If it cannot be read or is not XML.
        """
        if not needed and self.find(name) is None:
            return Element("missing")
        return parse_xml(self.read(name), f"{self.name} ({printable(name)})")


def _plain(name: str) -> str:
    return unicodedata.normalize("NFC", name).casefold()
