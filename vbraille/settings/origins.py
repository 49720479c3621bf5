"""Where each setting comes from: an option, a profile, the settings file, or nobody."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from vbraille.render.braille.knobs import KNOBS, kept_values
from vbraille.render.braille.straying import BAND
from vbraille.settings.values import display_name, with_profile

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator, Mapping

    from vbraille.render import BrailleStyle, Model
    from vbraille.settings.values import Settings

# Words for what is usual where the options of reading have no value that says it.
USUAL = {
    "language": "en",
    "grade": "what is usual in the language",
    "table": "by language",
    "encoding": "what the bytes of a file say",
    "echo": "none at a terminal, otherwise both",
    "cues": "none",
    "also": "none",
    "straying": "line",
    "band": f"{BAND:g}",
}


def say_settings(
    settings: Settings, options: Mapping[str, Any], usual: Mapping[str, Any]
) -> Iterator[str]:
    """Lines on the options of reading, one for each, with where it comes from.

    Parameters
    ----------
    settings
        Settings of the file.
    options
        Values that options give, by the option's name.
    usual
        Values that are usual, by the option's name, in the order of the lines; None for none.
    """
    for name, value in usual.items():
        label = name.replace("_", " ")
        if options.get(name) is not None:
            yield f"{label}: {said(options[name])} (option)"
        elif name in settings.read:
            yield f"{label}: {said(settings.read[name])} ({settings.where('read', name)})"
        else:
            yield f"{label}: {USUAL[name] if value is None else said(value)} (default)"


def say_tuning(
    settings: Settings,
    profile: str,
    model: Model,
    style: BrailleStyle,
    given: Collection[str] = (),
) -> Iterator[str]:
    """Lines on what can be turned for a display, one for each, with where it comes from.

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
        what = KNOBS[name].said(float(value)) if name in KNOBS else f"{_label(name)}: {value}"
        yield f"{what} ({origin})"


def say_bindings(settings: Settings) -> Iterator[str]:
    """Lines on the keys and buttons that the file binds."""
    for command, keys in settings.keys.items():
        yield f"keys of {command}: {', '.join(keys) or 'none'} ({settings.where('keys', command)})"
    for button, command in settings.buttons.items():
        name = f"button {button}" if button.isdecimal() else button
        yield f"{name}: {command} ({settings.where('buttons', button)})"


def _label(name: str) -> str:
    return name.replace("_", " ")


def said(value: object) -> str:
    """Words for the value of an option."""
    return {True: "yes", False: "no"}[value] if isinstance(value, bool) else str(value)
