"""Members of a ZIP archive that holds a book, read within bounds."""

from __future__ import annotations

import io
import zipfile
import zlib
from typing import TYPE_CHECKING, Any, BinaryIO

from vbraille.errors import InputError
from vbraille.wording import printable

if TYPE_CHECKING:
    from collections.abc import Iterable

MOST_BYTES = 200_000_000  # of a member, when it is unpacked
_MOST_MARKUP = 20_000_000  # bytes of a member that is read at once
_ENCRYPTED = 0x1
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

    def open(self, member: str) -> Member:
        """Open a member.

        Raises
        ------
        InputError
            If it is not there, locked or too large. So does reading, if the archive is damaged.
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
        if info.file_size > MOST_BYTES:
            raise InputError(
                f"{self.name} has a part {told} of {info.file_size / 1e6:.0f} MB, more than "
                f"{MOST_BYTES / 1e6:.0f} MB; that is no text of a book"
            )
        try:
            return Member(self._zip.open(info), self.name, told)
        except _FAULTS as error:
            raise damaged(self.name, told, error) from None

    def read(self, member: str, most: int = _MOST_MARKUP) -> bytes:
        """Read a whole member that is short.

        Raises
        ------
        InputError
            If it cannot be read, or is longer.
        """
        with self.open(member) as stream:
            found = stream.read(most + 1)
        if len(found) > most:
            raise InputError(
                f"{self.name} has a part {printable(member)} of more than {most / 1e6:.0f} MB; "
                f"get another copy of the book"
            )
        return found

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
            return etree.fromstring(self.read(member), parser)
        except (etree.XMLSyntaxError, ValueError) as error:
            raise InputError(
                f"{self.name} has a damaged part {printable(member)} ({printable(str(error))}); "
                f"get the book again"
            ) from None

    def any_of(self, members: Iterable[str]) -> str | None:
        """Give the first of some members that is there; None if none is."""
        return next((member for member in members if member in self), None)


class Member(io.RawIOBase):
    """A member of an archive that is being read; a damaged one is the user's to get again.

    Parameters
    ----------
    stream
        Bytes of the member.
    name, member
        Names of the book and the member in messages.
    """

    def __init__(self, stream: Any, name: str, member: str) -> None:
        self._stream = stream
        self._name = name
        self._member = member
        self._left = MOST_BYTES

    def readable(self) -> bool:
        """Tell that it can be read."""
        return True

    def read(self, size: int = -1) -> bytes:
        """Read so many bytes, or fewer.

        Raises
        ------
        InputError
            If the archive is damaged, or the member longer than it may be.
        """
        try:
            found = self._stream.read(size)
        except _FAULTS as error:
            raise damaged(self._name, self._member, error) from None
        self._left -= len(found)
        if self._left < 0:
            raise InputError(
                f"{self._name} has a part {self._member} of more than {MOST_BYTES / 1e6:.0f} MB; "
                f"that is no text of a book"
            )
        return found

    def close(self) -> None:
        """Close the member."""
        self._stream.close()
        super().close()


def damaged(name: str, member: str, error: Exception) -> InputError:
    """Error of a member that cannot be unpacked."""
    return InputError(
        f"{name} is damaged in its part {member} ({printable(str(error))}); get it again"
    )
