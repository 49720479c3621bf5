"""Locks of books: by whom a book is encrypted so that only certain programs can read it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from vbraille.errors import InputError

if TYPE_CHECKING:
    from vbraille.translate.documents.markup.archive import Archive

ENCRYPTION = "META-INF/encryption.xml"
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


def check_unlocked(archive: Archive) -> None:
    """Check that a book is not locked.

    Raises
    ------
    InputError
        If it is; the message says by whose lock.
    """
    if ENCRYPTION in archive:
        methods = [
            method.get("Algorithm", "")
            for element in archive.xml(ENCRYPTION).iter("{*}EncryptedData")
            for method in element.iterchildren("{*}EncryptionMethod")
        ]
        locked = any(method not in _FONTS for method in methods)
    else:
        # What Adobe calls its file, others call what tells who owns a book.
        adobe = _ADOBE in archive and b"adept" in archive.read(_ADOBE)
        locked = _LCP in archive or _APPLE in archive or adobe
    if not locked:
        return
    if _LCP in archive:
        lock, program = "Readium LCP", "such as Thorium Reader, with its passphrase"
    elif _APPLE in archive:
        lock, program = "Apple FairPlay", "Apple Books"
    elif _ADOBE in archive:
        lock, program = "Adobe ADEPT", "such as Adobe Digital Editions"
    else:
        lock, program = "a lock that it does not name", "of whoever sold it"
    raise InputError(
        f"{archive.name} is locked by {lock}, so that only a program {program} can read it; ask "
        f"the seller or your library for a copy without a lock"
    )
