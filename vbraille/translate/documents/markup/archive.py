"""Members of a ZIP archive that holds a book, read within bounds."""

from __future__ import annotations

import zipfile
import zlib
from typing import TYPE_CHECKING, Any, BinaryIO

from vbraille.errors import InputError
from vbraille.wording import printable

if TYPE_CHECKING:
    from collections.abc import Iterable

MOST_BYTES = 200_000_000  # of a member, when it is unpacked
MOST_MARKUP = 100_000_000  # bytes of a member that is parsed
_ENCRYPTED = 0x1
_ENCRYPTION = "META-INF/encryption.xml"
# Fonts are garbled in books that are open otherwise; no text is.
_FONTS = frozenset(
    (
        "http://www.idpf.org/2008/embedding",
        "http://ns.adobe.com/pdf/enc#RC",
        "http://ns.adobe.com/pdf/enc#rc",
    )
)
_LCP = "META-INF/license.lcpl"
_ADOBE = "META-INF/rights.xml"
_APPLE = "META-INF/sinf.xml"
_FAULTS = (zipfile.BadZipFile, zlib.error, EOFError, NotImplementedError, RuntimeError, OSError)
_FAULTS = (*_FAULTS, ValueError)  # of a name or a place that cannot be


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
        If it is no ZIP archive, or damaged.
    """

    def __init__(self, stream: BinaryIO, name: str) -> None:
        self.name = name
        try:
            self._zip = zipfile.ZipFile(stream)
        except _FAULTS as error:
            raise InputError(
                f"{name} is not a whole ZIP archive, as a book is ({error}); get it again"
            ) from None

    def __contains__(self, member: str) -> bool:
        return member in self._zip.NameToInfo

    def size(self, member: str) -> int:
        """Tell how many bytes a member has; 0 if it is not there."""
        info = self._zip.NameToInfo.get(member)
        return info.file_size if info is not None else 0

    def read(self, member: str, most: int = MOST_BYTES) -> bytes:
        """Read a member.

        Raises
        ------
        InputError
            If it is not there, locked, damaged or too large.
        """
        info = self._zip.NameToInfo.get(member)
        told = printable(member)
        if info is None:
            raise InputError(f"{self.name} lacks its part {told}; get the book again")
        if info.flag_bits & _ENCRYPTED:
            raise InputError(
                f"{self.name} is locked by a password of the ZIP archive; unpack it with the "
                f"password and pack it again without one"
            )
        if info.file_size > most:
            raise InputError(
                f"{self.name} has a part {told} of {info.file_size / 1e6:.0f} MB, more than "
                f"{most / 1e6:.0f} MB; that is no text of a book"
            )
        try:
            with self._zip.open(info) as stream:  # which gives no more than it says it has
                return stream.read(most)
        except _FAULTS as error:
            raise InputError(
                f"{self.name} is damaged in its part {told} ({printable(str(error))}); get it again"
            ) from None

    def read_if(self, member: str) -> bytes:
        """Read a member that need not be there; without it, nothing."""
        return self.read(member) if member in self else b""

    def xml(self, member: str) -> Any:
        """Parse a short member as XML, and give its root.

        Raises
        ------
        InputError
            If it cannot be read or is not XML.
        """
        from lxml import etree

        parser = etree.XMLParser(
            resolve_entities=False, no_network=True, load_dtd=False, huge_tree=False
        )
        try:
            return etree.fromstring(self.read(member, MOST_MARKUP), parser)
        except (etree.XMLSyntaxError, ValueError) as error:
            raise InputError(
                f"{self.name} has a damaged part {printable(member)} ({printable(str(error))}); "
                f"get the book again"
            ) from None

    def plain(self, member: str, *, needed: bool = True) -> Any:
        """Parse a member as XML whose names are told apart without their namespaces.

        Parameters
        ----------
        member
            Name of the member.
        needed
            Whether it must be there; otherwise an element with nothing in it stands for it.

        Returns
        -------
        Element
            Root of the tree, with no comments and no entities; no name has a namespace.

        Raises
        ------
        InputError
            If it cannot be read or is not XML.
        """
        from lxml import etree

        if not needed and member not in self:
            return etree.Element("missing")
        root = self.xml(member)
        etree.strip_tags(root, etree.Comment, etree.PI, etree.Entity)
        for element in root.iter():
            element.tag = element.tag.rpartition("}")[2]
            for name in [name for name in element.attrib if name.startswith("{")]:
                element.set(name.rpartition("}")[2], element.attrib.pop(name))
        return root

    def any_of(self, members: Iterable[str]) -> str | None:
        """Give the first of some members that is there; None if none is."""
        return next((member for member in members if member in self), None)

    def check_unlocked(self) -> None:
        """Check that a book is not locked.

        Raises
        ------
        InputError
            If it is; the message says by whose lock.
        """
        if _ENCRYPTION in self:
            methods = [
                method.get("Algorithm", "")
                for element in self.xml(_ENCRYPTION).iter("{*}EncryptedData")
                for method in element.iterchildren("{*}EncryptionMethod")
            ]
            locked = any(method not in _FONTS for method in methods)
        else:
            # What Adobe calls its file, others call what tells who owns a book.
            adobe = _ADOBE in self and b"adept" in self.read(_ADOBE)
            locked = _LCP in self or _APPLE in self or adobe
        if not locked:
            return
        if _LCP in self:
            lock, program = "Readium LCP", "such as Thorium Reader, with its passphrase"
        elif _APPLE in self:
            lock, program = "Apple FairPlay", "Apple Books"
        elif _ADOBE in self:
            lock, program = "Adobe ADEPT", "such as Adobe Digital Editions"
        else:
            lock, program = "a lock that it does not name", "of its seller"
        raise InputError(
            f"{self.name} is locked by {lock}, so that only a program {program} can read it; ask "
            f"the seller or your library for a copy without a lock"
        )
