"""Files that are written whole or not at all, texts that are read whole, and the settings' place.

What is being written stands under another name beside its own, which it gets once it is whole.
Whatever ends the writing early, a signal or a full disk, leaves nothing of it behind.
"""

from __future__ import annotations

import errno
import os
import shutil
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING

from vbraille.errors import InputError, VbrailleError, only_linux
from vbraille.wording import setting

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

    Content = bytes | Iterable[bytes]

_MOST_TEXT_BYTES = 1_000_000
SETTINGS_VARIABLE = "VBRAILLE_SETTINGS"  # of the environment, with the path of the settings file


@contextmanager
def whole_file(path: Path, *, replace: bool = False) -> Iterator[Path]:
    """Give a path to write a file to, which gets its own name once the block is done.

    Parameters
    ----------
    path
        File to make.
    replace
        Whether an existing file may be replaced; it stays as it is until then.

    Raises
    ------
    InputError
        If a file exists that may not be replaced.
    OSError
        If the file cannot have its name for another reason.
    """
    partial = path.with_name(f".{path.name}.partial")
    try:
        yield partial
        if replace:
            partial.replace(path)
        else:
            _name(partial, path)
    finally:
        with suppress(OSError):
            partial.unlink(missing_ok=True)


def write_file(
    path: Path, content: Content, *, replace: bool = False, durable: bool = False
) -> None:
    """Write a file: whole, or not at all.

    Parameters
    ----------
    path, content
        Path of the file, and its content, whole or in parts that are made while they are asked for.
    replace
        Whether an existing file may be replaced.
    durable
        Whether it must be on the disk when this returns, and not in the system's memory alone.

    Raises
    ------
    InputError
        If the file exists and may not be replaced, or cannot be made.
    VbrailleError
        If the disk cannot take the file.
    """
    write_files([(path, content)], replace=replace, durable=durable)


def write_files(
    files: Iterable[tuple[Path, Content]], *, replace: bool = False, durable: bool = False
) -> None:
    """Write several files; none gets its name before all are written.

    The parameters and errors are those of `write_file`.
    """
    path = Path()
    with ExitStack() as named:
        for path, content in files:
            check_unused(path, replace=replace)
            try:
                named.enter_context(_reporting(path))
                partial = named.enter_context(whole_file(path, replace=replace))
                file = partial.open("wb")
            except OSError as error:
                raise InputError(f"{path} cannot be written: {error.strerror}") from None
            with file:
                file.writelines([content] if isinstance(content, bytes) else content)
                if durable:
                    file.flush()
                    os.fsync(file.fileno())
    if durable:
        sync_names(path.parent)


@contextmanager
def _reporting(path: Path) -> Iterator[None]:
    """Raise VbrailleError for a disk that cannot take a file."""
    try:
        yield
    except OSError as error:
        raise VbrailleError(f"{path} could not be written: {error.strerror}") from None


def check_unused(path: Path, *, replace: bool) -> None:
    """Check that a file can have this name, before long work is done for it.

    Raises
    ------
    InputError
        If something exists at the path that may not be replaced, or no file can be made there.
    """
    if path.is_dir():
        raise InputError(f"{path} is a directory; give the name of a file in it")
    if not path.parent.is_dir():
        raise InputError(f"there is no directory {path.parent}; make it, or use another")
    if not replace and os.path.lexists(path):
        raise InputError(f"{path} already exists; choose another name, or add {setting('force')}")


def _name(partial: Path, path: Path) -> None:
    """Give a file its name, unless another has it."""
    try:
        os.link(partial, path)
    except FileExistsError:
        check_unused(path, replace=False)
    except OSError as error:
        if error.errno not in (errno.EPERM, errno.EOPNOTSUPP):
            raise
        check_unused(path, replace=False)  # a disk without hard links, such as a memory stick
        partial.rename(path)


def sync_names(folder: Path) -> None:
    """Have the names in a directory on the disk, so that new files outlast a loss of power."""
    descriptor = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)


def settings_path(given: str | None = None) -> Path:
    """Path of the settings file: an option's, the environment's, or the platform's."""
    chosen = given or os.environ.get(SETTINGS_VARIABLE)
    if chosen:
        return Path(chosen).expanduser()
    from platformdirs import user_config_path  # takes 20 ms to load

    return user_config_path("vbraille") / "settings.toml"


def read_bytes(path: str | Path, what: str, most_bytes: int) -> bytes:
    """Content of a file.

    Parameters
    ----------
    path
        Path of the file.
    what
        Noun for the file, such as "picture".
    most_bytes
        Size of the largest file that is read.

    Raises
    ------
    InputError
        If it is not there, is no ordinary file, is too large, or cannot be read.
    """
    path = Path(path)
    try:
        if path.exists() and not (path.is_file() or path.is_dir()):
            raise InputError(f"{path} is no ordinary file; give one that is")
        with path.open("rb") as file:
            content = file.read(most_bytes + 1)
    except FileNotFoundError:
        raise InputError(f"there is no file {path}; check the name") from None
    except IsADirectoryError:
        raise InputError(f"{path} is a directory; give a {what} in it") from None
    except (OSError, ValueError) as error:  # ValueError: a name that no file can have
        reason = getattr(error, "strerror", None) or error
        raise InputError(f"{path} cannot be read: {reason}") from None
    if len(content) > most_bytes:
        raise InputError(f"{path} is too large for a {what}; at most {most_bytes / 1e6:g} MB")
    return content


def read_text(path: str | Path, what: str, most_bytes: int = _MOST_TEXT_BYTES) -> str:
    """Text of a file, without a byte-order mark; see `read_bytes`.

    Raises
    ------
    InputError
        If the file cannot be read, is far too large or is not UTF-8.
    """
    content = read_bytes(path, what, most_bytes)
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = content.count(b"\n", 0, error.start) + 1
        raise InputError(f"{path} is not UTF-8 in line {line}; save it as UTF-8") from None


def write_folder(folder: Path, files: Mapping[str, bytes]) -> None:
    """Make a directory with files: all of it, or nothing.

    Parameters
    ----------
    folder
        Directory that does not exist yet, or is empty.
    files
        Content of each file, by its path in the directory.

    Raises
    ------
    InputError
        If something exists at the path, or no directory can be made there.
    VbrailleError
        If the disk cannot take the directory.
    """
    check_free(folder)
    partial = folder.absolute().with_name(f".{folder.absolute().name}.partial")
    try:
        shutil.rmtree(partial, ignore_errors=True)
        partial.mkdir(parents=True)
    except OSError as error:
        raise InputError(f"{folder} cannot be made: {error.strerror}") from None
    try:
        for name, content in files.items():
            path = partial / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(content)
        partial.rename(folder)
    except OSError as error:
        raise VbrailleError(f"{folder} cannot be written: {error.strerror}") from None
    finally:
        shutil.rmtree(partial, ignore_errors=True)


def open_memory(name: str, size: int) -> int:
    """Open a file in memory, which processes share by its descriptor.

    Raises
    ------
    VbrailleError
        If the system has no such files.
    """
    if not hasattr(os, "memfd_create"):
        raise VbrailleError(only_linux("memfd_create"))
    descriptor = os.memfd_create(name)
    os.ftruncate(descriptor, size)
    return descriptor


def check_free(folder: Path) -> None:
    """Check that a new directory can have this name.

    Raises
    ------
    InputError
        If there is something else than an empty directory.
    """
    try:
        taken = folder.exists() and (not folder.is_dir() or any(folder.iterdir()))
    except OSError as error:
        raise InputError(f"{folder} cannot be written: {error.strerror}") from None
    if taken:
        raise InputError(f"{folder} already exists; give a new directory with {setting('out')}")


def no_formula(text: str) -> str:
    """Text for a cell of a CSV that no spreadsheet takes for a formula; `cell_text` undoes it.

    An apostrophe stands before what begins like a formula and is no number.

    >>> no_formula("=HYPERLINK(1)"), no_formula("-2.5"), no_formula("?")
    ("'=HYPERLINK(1)", '-2.5', '?')
    """
    return f"'{text}" if _is_formula(text) else text


def cell_text(cell: str) -> str:
    """Text that `no_formula` made a cell of.

    >>> cell_text("'=HYPERLINK(1)"), cell_text("'tis")
    ('=HYPERLINK(1)', "'tis")
    """
    return cell[1:] if cell.startswith("'") and _is_formula(cell[1:]) else cell


def _is_formula(text: str) -> bool:
    begun = text.lstrip("'")
    if len(begun) < 2 or begun[0] not in "=+-@\t\r":
        return False
    try:
        float(text)
    except ValueError:
        return True
    return False
