"""Codes in place of pseudonyms, drawn once and kept in a key file apart from what is given away."""

from __future__ import annotations

import csv
import io
import secrets
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from msgspec import structs

from vbraille.errors import InputError
from vbraille.files import write_file
from vbraille.wording import setting

if TYPE_CHECKING:
    from pathlib import Path

    from vbraille.sessions.record.folder import Record

_SIGNS = "23456789bcdfghjkmnpqrstvwxz"  # none that is taken for another, and no vowels for words
_LENGTH = 6
_HEAD = ["participant", "code"]


@dataclass(frozen=True, slots=True)
class KeyFile:
    """Codes of participants.

    Parameters
    ----------
    path
        The file: CSV with the columns ``participant`` and ``code``.
    codes
        Code of each participant.
    """

    path: Path
    codes: dict[str, str]

    @classmethod
    def read(cls, path: Path, out: Path | None = None) -> KeyFile:
        """Read a key file; one that is not there is begun.

        Parameters
        ----------
        path
            The file.
        out
            Directory of what is given away, in which the key must not be.

        Raises
        ------
        InputError
            If the file is in that directory, or is no key file.
        """
        if out is not None and path.resolve().is_relative_to(out.resolve()):
            raise InputError(
                f"the key {path} would be in {out}, which is given away; keep it elsewhere with "
                f"{setting('key')}"
            )
        try:
            rows = list(csv.reader(io.StringIO(path.read_text("utf-8"))))
        except FileNotFoundError:
            return cls(path, {})
        except (OSError, ValueError, csv.Error) as error:
            no = "table" if isinstance(error, csv.Error) else "text"
            reason = getattr(error, "strerror", None) or f"it is no {no}"
            raise InputError(f"the key {path} cannot be read: {reason}") from None
        codes = {row[0]: row[1] for row in rows[1:] if len(row) == 2 and all(row)}
        if not rows or rows[0] != _HEAD or len(codes) != len(rows) - 1:
            raise InputError(
                f"{path} is no key: it must have the columns participant and code, and each "
                f"participant once"
            )
        if len(set(codes.values())) < len(codes):
            raise InputError(f"{path} has one code for two participants; mend it")
        return cls(path, codes)

    def with_codes(self, participants: list[str]) -> KeyFile:
        """Key that has a code for all of these; codes that there are stay.

        Codes are drawn by the system's source of chance, and new ones are kept in their own order,
        so that neither a code nor its place tells who came first.
        """
        codes = dict(self.codes)
        for name in participants:
            while name not in codes:
                code = "".join(secrets.choice(_SIGNS) for _ in range(_LENGTH))
                if code not in codes.values():
                    codes[name] = code
        return replace(self, codes=dict(sorted(codes.items(), key=lambda pair: pair[1])))

    def write(self) -> None:
        """Put the key on the disk, where only its owner can read it.

        Raises
        ------
        InputError, VbrailleError
            If it cannot be written.
        """
        text = io.StringIO()
        writer = csv.writer(text, lineterminator="\n")
        writer.writerow(_HEAD)
        writer.writerows(self.codes.items())
        content = text.getvalue().encode()
        write_file(self.path, content, replace=True, durable=True, private=True)


def renamed(record: Record, name: str) -> Record:
    """Session under another participant's name, as it is exported."""
    return replace(record, plan=structs.replace(record.plan, participant=name))
