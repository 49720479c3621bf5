"""Settings put to use: a display's style with the values of a profile."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from vbraille.errors import InputError
from vbraille.render.braille.knobs import with_values
from vbraille.settings.chosen import display_name
from vbraille.wording import nearest

if TYPE_CHECKING:
    from vbraille.render import Model
    from vbraille.settings.chosen import Settings


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
    """Sentence on a profile that somebody names and is not there; empty if it is."""
    if profile in settings.profiles:
        return ""
    near = nearest(profile, settings.profiles)
    return f"profile: {profile} is new, and is made when it is saved{near}"
