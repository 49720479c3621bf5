"""Writing of a profile into the settings file, which keeps its comments and its order."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from vbraille.errors import InputError, VbrailleError
from vbraille.files import write_file
from vbraille.render.braille.knobs import kept_values
from vbraille.settings.tables import check_name, parse_settings
from vbraille.settings.values import display_name
from vbraille.toml.textfile import read_text

if TYPE_CHECKING:
    from collections.abc import MutableMapping
    from pathlib import Path

    from vbraille.render import Model


def save_profile(path: Path, profile: str, model: Model) -> str:
    """Save how braille is shown on a display, in a profile of a settings file.

    The file is written whole or not at all, and made if it is not there. What else stands in it,
    comments too, stays.

    Parameters
    ----------
    path
        Path of the settings file.
    profile
        Name of the profile, which need not be there yet.
    model
        Display, and the style that is saved.

    Returns
    -------
    str
        Sentence on what was saved.

    Raises
    ------
    InputError
        If the file is there and cannot be read, or no file can be made.
    VbrailleError
        If the disk cannot take it.
    """
    import tomlkit  # takes 30 ms to load

    try:
        check_name(profile)
    except ValueError as error:
        raise InputError(str(error)) from None
    path = path.resolve()  # a link to the file stays one
    before = read_text(path, "settings file") if path.exists() else ""
    known = parse_settings(before, path)
    tree = tomlkit.parse(before)
    table: MutableMapping[str, Any] = tree
    steps = ("profile", profile, display_name(model))
    for step in steps:
        if step not in table:
            table[step] = tomlkit.table(is_super_table=step != steps[-1])
        table = table[step]
    values = kept_values(model.style)
    table.update(values)
    after = tomlkit.dumps(tree)
    written = parse_settings(after, path)
    saved = written.tuning(profile, model)
    if (written.read, written.keys) != (known.read, known.keys) or not (
        values.items() <= saved.items()
    ):
        raise VbrailleError(f"{path} was left as it is; write [{'.'.join(steps)}] into it by hand")
    _make(path.parent)
    write_file(path, after.encode(), replace=True, durable=True)
    return f"saved: profile {profile} for the {model.title}"


def _make(folder: Path) -> None:
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(f"{folder} cannot be made: {error.strerror}") from None
