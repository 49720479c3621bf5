"""The settings file: values of options that the command line does not give.

Options at the top of the file hold for all commands, those of ``[read]`` for ``vbraille read``,
those of ``[profile.evening]`` for all commands with that profile, and those of
``[profile.evening.stress2]`` on that display alone. Each comes before those named so far.
"""

from __future__ import annotations

import os
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any

import click
from click.core import ParameterSource

from vbraille.errors import InputError
from vbraille.files import settings_path

if TYPE_CHECKING:
    from collections.abc import Collection
    from pathlib import Path

SHARED: set[str] = set()  # names of the options that a settings file may have
# Options of which a display may have values of its own.
STYLE = (
    *("texture", "contrast", "texture_cycles", "dot_width", "dot_spacing", "cell_gap"),
    *("line_pitch", "mapping", "dot_row"),
)


@dataclass(slots=True)
class Settings:
    """A settings file that was read.

    Parameters
    ----------
    path
        Path of the file, which need not be there.
    tree
        All of its tables.
    lines
        Number of the line of each value, by the keys that lead to it.
    profile
        Name of the profile in use.
    values
        Value of each option of the command, and its place in the file.
    """

    path: Path
    tree: dict[str, Any] = field(default_factory=dict)
    lines: dict[tuple[str | int, ...], int] = field(default_factory=dict)
    profile: str = "default"
    values: dict[str, tuple[Any, str]] = field(default_factory=dict)

    def where(self, *keys: str) -> str:
        """File and line of a value, such as "settings.toml line 12"."""
        return self.path.name + (f" line {self.lines[keys]}" if keys in self.lines else "")

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
                place = self.where(*keys[:depth])
                raise InputError(f"{place}: {key} is not a table; write [{'.'.join(keys)}]")
        return found

    def options(self, known: Collection[str], *keys: str) -> dict[str, tuple[Any, str]]:
        """Options of a table of the file by their names: the value of each, and its place.

        Raises
        ------
        InputError
            If one is not known; the sentence names what comes near.
        """
        found = {}
        profile = f", profile {keys[1]}" if keys[:1] == ("profile",) else ""
        for key, value in self.table(*keys).items():
            if not isinstance(value, dict):
                self.check((*keys, key), known, "option")
                found[_named(key)] = value, self.where(*keys, key) + profile
        return found

    def check(self, keys: tuple[str, ...], known: Collection[str], what: str) -> None:
        """Raise InputError if the last of some keys is not known."""
        if _named(keys[-1]) in known:
            return
        from difflib import get_close_matches

        near = get_close_matches(_named(keys[-1]), known, 1)
        hint = f"; did you mean {near[0]!r}?" if near else ""
        table = f"[{'.'.join(keys[:-1])}] " if keys[:-1] else ""
        raise InputError(f"{self.where(*keys)}: {table}unknown {what} {keys[-1]!r}{hint}")


class Context(click.Context):
    """The context of a command, whose options the settings file has where they are not given."""

    shows_all = False  # whether the settings are printed, and no command runs

    @cached_property
    def settings(self) -> Settings:
        """The settings file, as ``--settings`` and ``--profile`` choose.

        Raises
        ------
        InputError
            If it cannot be read, or has an unknown name.
        """
        # An option that is not given is a mark of click's own until all are read.
        path, profile = (
            value if isinstance(value, str) else None
            for value in (self.params.get("settings"), self.params.get("profile"))
        )
        found = _read(path)
        command, root = self.info_name or "", self.find_root().command
        commands = root.list_commands(self) if isinstance(root, click.Group) else ()
        for key, value in found.tree.items():
            if isinstance(value, dict):
                found.check((key,), ["profile", "keys", "buttons", *commands], "table")
        values = found.options(SHARED)
        values |= found.options({param.name or "" for param in self.command.params}, command)
        profile = profile or values.get("profile", (None, ""))[0]
        if profile and profile not in found.table("profile"):
            click.echo(f"profile {profile}: not saved yet", err=True)
        found.profile = str(profile or "default")
        values |= found.options(SHARED, "profile", found.profile)
        for display, value in found.table("profile", found.profile).items():
            if isinstance(value, dict):
                found.options(STYLE, "profile", found.profile, display)
        found.values = values
        return found

    def lookup_default(self, name: str, call: bool = True) -> Any:
        """Value of an option in the settings file; None if it has none."""
        # The profile is chosen before the file is read, unless the file itself is asked about.
        unread = "settings" not in self.params or (name == "profile" and not self.shows_all)
        if not call or unread or name in ("help_all", "log") or self.resilient_parsing:
            return None
        value, _ = self.settings.values.get(name, (None, ""))
        return value


def settings_of(ctx: click.Context) -> Settings:
    """Settings of a command with ``--settings``."""
    assert isinstance(ctx, Context)
    return ctx.settings


def _read(path: str | None) -> Settings:
    """Read a settings file; the usual one need not be there, and the null device is none."""
    found = settings_path(path)
    if str(found) == os.devnull or (path is None and not found.exists()):
        return Settings(found)
    import tomllib

    from vbraille.files import read_text
    from vbraille.toml import lines_of

    text = read_text(found, "settings file")
    try:
        return Settings(found, tomllib.loads(text), lines_of(text))
    except (tomllib.TOMLDecodeError, RecursionError) as error:
        raise InputError(f"{found.name} is not TOML: {error}") from None


def origin(ctx: click.Context, param: click.Parameter) -> str:
    """Origin of the value of an option, in words; empty for the command line and for defaults."""
    name = param.name or ""
    source = ctx.get_parameter_source(name)
    if source is ParameterSource.ENVIRONMENT:
        return f"environment variable {param.envvar or f'{ctx.auto_envvar_prefix}_{name.upper()}'}"
    if source is ParameterSource.DEFAULT_MAP:
        return settings_of(ctx).values[name][1]
    return ""


def given(ctx: click.Context) -> set[str]:
    """Names of the options that the command line or the environment gives."""
    sources = (ParameterSource.COMMANDLINE, ParameterSource.ENVIRONMENT)
    names = [param.name or "" for param in ctx.command.params]
    return {name for name in names if ctx.get_parameter_source(name) in sources}


def is_default(ctx: click.Context, name: str) -> bool:
    """Tell whether nothing gives an option a value."""
    return ctx.get_parameter_source(name) is ParameterSource.DEFAULT


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
    InputError
        If the profile has a value for the display that the option cannot have.
    """
    settings, asked = settings_of(ctx), given(ctx)
    own = settings.options(STYLE, "profile", settings.profile, display)
    found: dict[str, tuple[Any, str]] = {}
    for param in ctx.command.params:
        name = param.name or ""
        if name not in STYLE:
            continue
        if name in own and name not in asked:
            value, place = own[name]
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
    table: Any = tomlkit.parse(read_text(path, "settings file") if path.exists() else "")
    tree = table
    for step in ("profile", profile, display):
        table = table.setdefault(step, tomlkit.table(is_super_table=step != display))
    table.update(values)
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(f"{path.parent} cannot be made: {error.strerror}") from None
    write_file(path, tomlkit.dumps(tree).encode(), replace=True, durable=True)


def _named(key: str) -> str:
    return key.replace("-", "_")
