"""The settings file: values of options that the command line does not give.

Options at the top of the file hold for all commands, those of ``[read]`` for ``vbraille read``,
those of ``[profile.evening]`` for all commands with that profile, and those of
``[profile.evening.stress2]`` on that display alone. Each comes before those named so far.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import click
from click.core import ParameterSource

from vbraille.errors import InputError
from vbraille.files import settings_path

if TYPE_CHECKING:
    from collections.abc import Collection
    from pathlib import Path

_META = "vbraille.settings"
_TABLES = ("profile", "keys", "buttons")
# Options of which a display may have values of its own.
STYLE = (
    *("texture", "contrast", "texture_cycles", "dot_width", "dot_spacing", "cell_gap"),
    *("line_pitch", "mapping", "dot_row"),
)


@dataclass(frozen=True, slots=True)
class Settings:
    """A settings file that was read.

    Parameters
    ----------
    path
        Path of the file, which need not be there.
    profile
        Name of the profile in use.
    tree
        All of its tables.
    lines
        Number of the line of each value, by the keys that lead to it.
    origins
        Keys that lead to the value of each option of the command.
    """

    path: Path
    profile: str = "default"
    tree: dict[str, Any] = field(default_factory=dict)
    lines: dict[tuple[str | int, ...], int] = field(default_factory=dict)
    origins: dict[str, tuple[str, ...]] = field(default_factory=dict)

    def where(self, *keys: str) -> str:
        """File and line of a value, such as "settings.toml line 12"."""
        line = self.lines.get(keys)
        return self.path.name if line is None else f"{self.path.name} line {line}"

    def table(self, *keys: str) -> dict[str, Any]:
        """A table of the file; empty if it is not there.

        Raises
        ------
        InputError
            If it is no table.
        """
        found: Any = self.tree
        for depth, key in enumerate(keys, 1):
            found = found.get(key, {})
            if not isinstance(found, dict):
                raise InputError(
                    f"{self.where(*keys[:depth])}: {key} is not a table; write [{'.'.join(keys)}]"
                )
        return found


def use_settings(
    ctx: click.Context,
    path: str | None,
    profile: str | None,
    commands: Collection[str],
    known: Collection[str],
) -> None:
    """Have a command take options that are not given from the settings file.

    Parameters
    ----------
    ctx
        Context of the command, before its options are parsed.
    path
        Value of ``--settings``; None for the usual file.
    profile
        Value of ``--profile``; None for that of the file, or "default".
    commands
        Names of all commands.
    known
        Names of all options that commands share.

    Raises
    ------
    InputError
        If the file cannot be read, or has an unknown name.
    """
    settings = read_settings(path)
    command = (ctx.command_path.split() or ["", ""])[1]
    own = {param.name or "" for param in ctx.command.params}
    origins: dict[str, tuple[str, ...]] = {}
    for name, value in settings.tree.items():
        if isinstance(value, dict):
            _check_name(settings, (name,), [*_TABLES, *commands], "table")
        else:
            _check_name(settings, (name,), known, "option")
            origins[_named(name)] = (name,)
    for key in settings.table(command):
        _check_name(settings, (command, key), own, "option")
        origins[_named(key)] = (command, key)
    wanted = profile or settings.table(command).get("profile")
    profile = str(wanted or "default")
    if wanted is not None and wanted not in settings.table("profile") and _META not in ctx.meta:
        click.echo(f"profile {wanted}: not saved yet", err=True)
    for key, value in settings.table("profile", profile).items():
        if isinstance(value, dict):
            for each in value:
                _check_name(settings, ("profile", profile, key, each), STYLE, "option")
        else:
            _check_name(settings, ("profile", profile, key), known, "option")
            origins[_named(key)] = ("profile", profile, key)
    ctx.default_map = {name: _value(settings, keys) for name, keys in origins.items()}
    ctx.meta[_META] = Settings(settings.path, profile, settings.tree, settings.lines, origins)


def read_settings(path: str | None) -> Settings:
    """Read a settings file; the usual one need not be there.

    Raises
    ------
    InputError
        If it cannot be read, or is not TOML.
    """
    found = settings_path(path)
    if path is None and not found.exists():
        return Settings(found)
    import tomllib

    from vbraille.files import read_text
    from vbraille.toml import lines_of

    text = read_text(found, "settings file")
    try:
        tree = tomllib.loads(text)
    except (tomllib.TOMLDecodeError, RecursionError) as error:
        raise InputError(f"{found.name} is not TOML: {error}") from None
    return Settings(found, tree=tree, lines=lines_of(text))


def settings_of(ctx: click.Context) -> Settings:
    """Settings that a command with ``--settings`` was given."""
    return ctx.meta[_META]


def origin(ctx: click.Context, param: click.Parameter) -> str:
    """Origin of the value of an option, in words; empty for the command line and for defaults."""
    source = ctx.get_parameter_source(param.name or "")
    if source is ParameterSource.ENVIRONMENT:
        return f"environment variable {param.envvar or _variable(ctx, param)}"
    if source is ParameterSource.DEFAULT_MAP and _META in ctx.meta:
        settings: Settings = ctx.meta[_META]
        return _said(settings, settings.origins[param.name or ""])
    return ""


def given(ctx: click.Context) -> set[str]:
    """Names of the options that the command line or the environment gives."""
    sources = (ParameterSource.COMMANDLINE, ParameterSource.ENVIRONMENT)
    names = [param.name or "" for param in ctx.command.params]
    return {name for name in names if ctx.get_parameter_source(name) in sources}


def style_options(ctx: click.Context, display: str) -> dict[str, tuple[Any, str]]:
    """Options on how braille feels on a display: the value of each, and its origin.

    Parameters
    ----------
    ctx
        Context of the command.
    display
        Name of the display in profiles, such as "stress2".

    Raises
    ------
    click.BadParameter
        If the profile has a value for the display that the option cannot have.
    """
    settings = settings_of(ctx)
    own = settings.table("profile", settings.profile, display)
    values = {_named(key): (key, value) for key, value in own.items()}
    found: dict[str, tuple[Any, str]] = {}
    for param in ctx.command.params:
        name = param.name or ""
        if name not in STYLE:
            continue
        if name in values and name not in given(ctx):
            key, value = values[name]
            place = _said(settings, ("profile", settings.profile, display, key))
            try:
                found[name] = param.type.convert(value, param, ctx), place
            except click.BadParameter as error:
                raise InputError(f"{place}: {name.replace('_', ' ')}: {error.message}") from None
        elif ctx.params.get(name) is not None:
            found[name] = ctx.params[name], origin(ctx, param) or "option"
    return found


def save_profile(path: Path, profile: str, display: str, values: dict[str, Any]) -> None:
    """Save values in ``[profile.NAME.DISPLAY]`` of a settings file; all else in it stays.

    Parameters
    ----------
    path
        Path of the file, which is made if it is not there.
    profile, display
        Names of the profile and the display.
    values
        Values by the names of their options.

    Raises
    ------
    InputError
        If the file is there and cannot be read, or no file can be made.
    VbrailleError
        If the disk cannot take it.
    """
    import tomlkit  # takes 30 ms to load

    from vbraille.files import read_text, write_file

    path = path.resolve()  # a link to the file stays one
    tree: Any = tomlkit.parse(read_text(path, "settings file") if path.exists() else "")
    table = tree
    for step in ("profile", profile, display):
        if step not in table:
            table[step] = tomlkit.table(is_super_table=step != display)
        table = table[step]
    table.update(values)
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(f"{path.parent} cannot be made: {error.strerror}") from None
    write_file(path, tomlkit.dumps(tree).encode(), replace=True, durable=True)


def _said(settings: Settings, keys: tuple[str, ...]) -> str:
    """Words for a place in the file, such as "settings.toml line 4, profile evening"."""
    profile = f", profile {keys[1]}" if keys[0] == "profile" and len(keys) > 1 else ""
    return f"{settings.where(*keys)}{profile}"


def _value(settings: Settings, keys: tuple[str, ...]) -> Any:
    return settings.table(*keys[:-1])[keys[-1]]


def _named(key: str) -> str:
    return key.replace("-", "_")


def _variable(ctx: click.Context, param: click.Parameter) -> str:
    return f"{ctx.auto_envvar_prefix}_{(param.name or '').upper()}"


def _check_name(
    settings: Settings, keys: tuple[str, ...], known: Collection[str], what: str
) -> None:
    """Check that a key of the file is known.

    Raises
    ------
    InputError
        If it is not; the sentence names what comes near.
    """
    if _named(keys[-1]) in known:
        return
    from difflib import get_close_matches

    near = get_close_matches(_named(keys[-1]), known, 1)
    hint = f"; did you mean {near[0]!r}?" if near else ""
    table = f"[{'.'.join(keys[:-1])}] " if keys[:-1] else ""
    raise InputError(f"{settings.where(*keys)}: {table}unknown {what} {keys[-1]!r}{hint}")
