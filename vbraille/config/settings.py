"""Settings: read from their file, put to use in options and styles, and said with their origins.

An option of the command line comes first, then the settings file, then what the schema has.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, NamedTuple

from vbraille.braille.cells import DOT_ROWS
from vbraille.config.option import FILE, PROFILE
from vbraille.config.options import CHOICE_OF_TABLE, held_in, knobs
from vbraille.errors import InputError, VbrailleError
from vbraille.files import read_text, settings_path, write_file
from vbraille.logs import want_tracebacks
from vbraille.render.braille.mappings import MAPPINGS, single_row
from vbraille.render.braille.style import Profile
from vbraille.wording import nearest

if TYPE_CHECKING:
    import argparse
    from collections.abc import Collection, Iterator, Mapping, MutableMapping
    from pathlib import Path

    from vbraille.braille.geometry import Geometry
    from vbraille.config.option import StyleKnob
    from vbraille.display import Display
    from vbraille.render import BrailleStyle, Model
    from vbraille.render.braille.mappings import Mapping as DotMapping

    Values = dict[str, float | int | str]


_CELL = ("dot_width_mm", "dot_spacing_mm", "cell_gap_mm")
_SHOWN_ROWS = DOT_ROWS - 1  # the row of dots 7 and 8 is not shown alone
KNOBS = {knob.key: knob for knob in knobs()}
OPTIONS_BY_KEY = {option.key: option for option in held_in(PROFILE)}


def fixed(knob: StyleKnob, style: BrailleStyle) -> str:
    """Reason why a knob turns nothing in a style; empty if it does."""
    if knob.field == "cycles" and style.profile is Profile.HALF_SINE:
        return "the texture of this display has a fixed wavelength"
    return ""


def obstacle(knob: StyleKnob, geometry: Geometry, display: Display, value: float) -> str:
    """Reason why a knob cannot have a value beside the distances that there are; empty if it can.

    Parameters
    ----------
    geometry
        Distances as they are.
    display
        Display whose carriage must have room for a cell.
    """
    width_mm, spacing_mm, gap_mm = (
        value if name == knob.field else getattr(geometry, name) for name in _CELL
    )
    if width_mm > spacing_mm + gap_mm + 1e-9:
        return "a dot must not be wider than the cell pitch"
    if width_mm + spacing_mm + display.span_mm > geometry.travel_mm:
        return "the carriage would have no room for a cell"
    return ""


def mappings_for(style: BrailleStyle, display: Display) -> list[DotMapping]:
    """Mappings that can take the place of a style's own on a display, which is one of them.

    A style that shows one row of dots has one for each row; on another display they are those of
    as few rows as it has, or fewer.
    """
    if style.mapping.rows == 1:
        return [single_row(row) for row in range(1, _SHOWN_ROWS + 1)]
    rows = display.rows - (style.first_row or 0)
    return [mapping for mapping in MAPPINGS.values() if mapping.rows <= rows]


def next_mapping(style: BrailleStyle, display: Display) -> DotMapping:
    """Mapping after a style's own, in turn, of those that the display can show."""
    mappings = mappings_for(style, display)
    names = [mapping.name for mapping in mappings]
    at = names.index(style.mapping.name) if style.mapping.name in names else -1
    return mappings[(at + 1) % len(mappings)]


def say_mapping(mapping: DotMapping) -> str:
    """Words for a mapping: "mapping: sheared", or "dot row: 2" where it shows one row of dots."""
    if mapping.rows == 1:
        return f"dot row: {mapping.left[0] + 1}"
    return f"mapping: {mapping.name}"


def kept_values(style: BrailleStyle) -> dict[str, float | int | str]:
    """Values of all that can be turned in a style, by the names of a settings file."""
    values: dict[str, float | int | str] = {
        name: knob.value(style) for name, knob in KNOBS.items() if not fixed(knob, style)
    }
    if style.mapping.rows == 1:
        values["dot_row"] = style.mapping.left[0] + 1
    else:
        values["mapping"] = style.mapping.name
    return values


def with_values(
    style: BrailleStyle, display: Display, values: dict[str, float | int | str]
) -> BrailleStyle:
    """Make a style that has the values of a settings file.

    Parameters
    ----------
    style
        Style whose other values stay.
    display
        Display that must be able to show it.
    values
        Values by the names that `kept_values` gives.

    Raises
    ------
    InputError
        If a value is out of range, or not for this display. The message begins with the name of
        the value, with blanks for underscores and without its unit, where one value is at fault.
    """
    changes: dict[str, Any] = {}
    for name, value in values.items():
        if name in KNOBS:
            knob = KNOBS[name]
            if reason := fixed(knob, style):
                raise InputError(f"{knob.label} cannot be set: {reason}")
            changes[knob.field] = value
        else:
            changes["mapping"] = _mapping(style, display, name, value)
    return style.replace(**changes)


def _mapping(style: BrailleStyle, display: Display, name: str, value: object) -> DotMapping:
    """Mapping that a settings file names; InputError if the display cannot show it."""
    allowed: dict[object, DotMapping] = {
        (m.left[0] + 1 if m.rows == 1 else m.name): m for m in mappings_for(style, display)
    }
    own = "dot_row" if style.mapping.rows == 1 else "mapping"
    if name != own:
        raise InputError(
            f"{name.replace('_', ' ')} is not for this display; {own} chooses which dots it shows"
        )
    if value not in allowed:
        names = ", ".join(map(str, allowed))
        raise InputError(f"{name.replace('_', ' ')} is {value!r}; it must be one of {names}")
    return allowed[value]


DEFAULT_PROFILE = "default"


@dataclass(frozen=True, slots=True)
class Settings:
    """Content of a settings file.

    Parameters
    ----------
    path
        Path of the file, which need not be there.
    read
        Values of the table ``[read]``: only those that the file has.
    keys
        Keys of commands, by the command's name.
    buttons
        Names of commands, by the button of the device.
    profiles
        Values of each profile for each display, by their names.
    lines
        Line of the file for each value, by the keys that lead to it.
    """

    path: Path
    read: Mapping[str, Any] = field(default_factory=dict[str, Any])
    keys: Mapping[str, tuple[str, ...]] = field(default_factory=dict[str, tuple[str, ...]])
    buttons: Mapping[str, str] = field(default_factory=dict[str, str])
    profiles: Mapping[str, Mapping[str, Values]] = field(
        default_factory=dict[str, "Mapping[str, Values]"]
    )
    lines: Mapping[tuple[str | int, ...], int] = field(
        default_factory=dict[tuple[str | int, ...], int]
    )

    @property
    def profile(self) -> str:
        """Name of the profile in use unless an option names another."""
        return self.read.get("profile", DEFAULT_PROFILE)

    def where(self, *keys: str) -> str:
        """File and line of a value, such as "settings.toml line 12"."""
        line = self.lines.get(keys)
        return self.path.name if line is None else f"{self.path.name} line {line}"

    def tuning(self, profile: str, model: Model) -> Values:
        """Values of a profile for a display; none if it has none."""
        return dict(self.profiles.get(profile, {}).get(display_name(model), {}))


def load_settings(given: str | None = None) -> Settings:
    """Read the settings file; without one there are no settings.

    Parameters
    ----------
    given
        Path that an option gives, at which there must be a file; None for the usual place.

    Raises
    ------
    InputError
        If the file cannot be read, or has something that no settings file can have. One sentence
        says the line, the key, and the nearest name.
    """
    path = settings_path(given)
    if given is None and not path.exists():
        return Settings(path)
    return parse_settings(read_text(path, "settings file"), path)


def parse_settings(text: str, path: Path) -> Settings:
    """Make settings of the text of their file.

    Raises
    ------
    InputError
        If the text has something that no settings file can have.
    """
    # Imported here, since most have no such file, and need not wait for what reads it.
    from vbraille.config.settingsfile import parse_tables

    return Settings(path, *parse_tables(text, path.name))


def settle(arguments: argparse.Namespace, names: Collection[str] | None = None) -> Settings:
    """Fill in options that were not given; afterwards `settled` names those from the file.

    Parameters
    ----------
    arguments
        Parsed options, in which None stands for what was not given.
    names
        Options that the settings file may say; None for all.

    Raises
    ------
    InputError
        If the settings file cannot be used.
    """
    settings = load_settings(arguments.settings)
    # A table of the command line's own stands for its language, and the other way round.
    given = {name for name in CHOICE_OF_TABLE if getattr(arguments, name) is not None}
    passed_over: set[str] = (
        {"language", "grade"} if "table" in given else {"table"} if given else set()
    )
    settled: set[str] = set()
    for option in held_in(FILE):
        name = option.name
        if name == "profile" or (names is not None and name not in names):
            continue
        if getattr(arguments, name, None) is None:
            if name in settings.read and name not in passed_over:
                settled.add(name)
                setattr(arguments, name, settings.read[name])
            else:
                setattr(arguments, name, option.default)
    arguments.settled = frozenset(settled)
    if arguments.verbose:
        want_tracebacks()
    return settings


def display_name(model: Model) -> str:
    """Name of a display in a settings file: its model's, or its own in small letters."""
    return model.name or re.sub(r"[^a-z0-9]+", "-", model.title.lower()).strip("-") or "display"


def with_profile(settings: Settings, profile: str, model: Model) -> Model:
    """Display with the style that a profile has for it.

    Parameters
    ----------
    settings
        Settings with the profile; without it the style stays as it is.
    profile
        Name of the profile.
    model
        Display, and the style whose other values stay.

    Raises
    ------
    InputError
        If the display cannot be read like this; the message says the line of the file.
    """
    style = model.style
    values = settings.tuning(profile, model)
    place = ("profile", profile, display_name(model))
    # One after the other, so that the fault has a line; lengths bound each other, and go together.
    lengths = {name: values.pop(name) for name in list(values) if name.endswith("_mm")}
    for part, at in [(lengths, place), *(({n: v}, (*place, n)) for n, v in values.items())]:
        try:
            style = with_values(style, model.display, part)
            style.geometry.cells_per_line(model.display.span_mm)
        except (InputError, ValueError) as error:
            raise InputError(f"{settings.where(*at)}: [{'.'.join(place)}] {error}") from None
    return replace(model, style=style)


def missing_profile(settings: Settings, profile: str) -> str:
    """Sentence on a profile that the user names and is not there; empty if it is."""
    if profile in settings.profiles:
        return ""
    near = nearest(profile, settings.profiles)
    return f"profile: {profile} is new, and is made when it is saved{near}"


class Setting(NamedTuple):
    """A setting of reading, and where its value comes from.

    Parameters
    ----------
    name, value, origin
        The setting's name, its value, and the option, line of the file or default that gives it.
    unit
        Unit of a length.
    """

    name: str
    value: object
    origin: str
    unit: str = ""

    def __str__(self) -> str:
        """Line on it, such as "dot width: 2.2 mm (default)"."""
        value = self.value
        if isinstance(value, bool):
            value = "yes" if value else "no"
        elif isinstance(value, float):
            value = f"{value:g}"
        return f"{self.name}: {f'{value} {self.unit}'.rstrip()} ({self.origin})"


def settings_said(settings: Settings, options: Mapping[str, Any]) -> Iterator[Setting]:
    """Give each option of reading with its value.

    Parameters
    ----------
    settings
        Settings of the file.
    options
        Values that options give, by the option's name; None for none.
    """
    for option in held_in(FILE):
        name = option.name
        if name == "profile":
            continue
        if options.get(name) is not None:
            yield Setting(option.label, options[name], "option")
        elif name in settings.read:
            origin = settings.where("read", name)
            yield Setting(option.label, settings.read[name], origin)
        else:
            yield Setting(option.label, option.usual or option.default, "default")


def tuning_said(
    settings: Settings,
    profile: str,
    model: Model,
    style: BrailleStyle,
    given: Collection[str] = (),
) -> Iterator[Setting]:
    """Give what can be turned for a display, with its value.

    Parameters
    ----------
    settings
        Settings of the file.
    profile
        Name of the profile in use.
    model
        Display, and the style in which it is read unless told otherwise.
    style
        Style that comes out of it all; what differs from the rest was said by an option.
    given
        Names of the values that options give.

    Raises
    ------
    InputError
        If the profile cannot be used on the display.
    """
    chosen = kept_values(with_profile(settings, profile, model).style)
    saved = settings.tuning(profile, model)
    for name, value in kept_values(style).items():
        if name in given or value != chosen[name]:
            origin = "option"
        elif name in saved:
            line = settings.where("profile", profile, display_name(model), name)
            origin = f"profile {profile}, {line}"
        else:
            origin = "default"
        yield Setting(OPTIONS_BY_KEY[name].label, value, origin, OPTIONS_BY_KEY[name].unit)


def bindings_said(settings: Settings) -> Iterator[Setting]:
    """Give the keys and buttons that the file binds."""
    for command, keys in settings.keys.items():
        pressed = ", ".join(keys) or "none"
        yield Setting(f"keys of {command}", pressed, settings.where("keys", command))
    for button, command in settings.buttons.items():
        name = f"button {button}" if button.isdecimal() else button
        yield Setting(name, command, settings.where("buttons", button))


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

    from vbraille.config.settingsfile import check_name

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
    for name, value in values.items():
        table[name] = value
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
