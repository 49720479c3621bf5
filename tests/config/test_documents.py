"""The page on settings: its file can be read, and what it says of it comes out."""

import re
from pathlib import Path

import pytest

from vbraille.config import options
from vbraille.config.options import OPTIONS, PROFILE, held_in, knobs
from vbraille.config.settings import (
    kept_values,
    parse_settings,
    settings_said,
    tuning_said,
    with_profile,
)
from vbraille.config.settingsfile import ProfileTable, ReadTable
from vbraille.errors import InputError
from vbraille.render import STRESS2, VBD, Straying

PAGE = (Path(__file__).parents[2] / "docs/settings.md").read_text(encoding="utf-8")
FILE = Path("settings.toml")
(TOML,) = re.findall(r"^```toml\n(.*?)^```$", PAGE, re.MULTILINE | re.DOTALL)


def test_the_file_of_the_page_is_read_as_the_page_says():
    settings = parse_settings(TOML, FILE)
    model = with_profile(settings, settings.profile, STRESS2)
    said = [
        *tuning_said(settings, settings.profile, STRESS2, model.style),
        *settings_said(settings, {}),
    ]
    shown, faulty = re.findall(r"^```text\n(.*?)^```$", PAGE, re.MULTILINE | re.DOTALL)
    for line in shown.splitlines():
        assert line in map(str, said)
    with pytest.raises(InputError) as refused:
        parse_settings(TOML.replace("\ncontrast = 1.0", "\ncontrst = 1.0"), FILE)
    assert str(refused.value).startswith(faulty.removeprefix("vbraille: ").rstrip("…\n"))


def test_the_file_has_the_options_of_the_schema_with_their_bounds():
    assert set(ReadTable.__struct_fields__) == {option.key for option in held_in(options.FILE)}
    kept = {*kept_values(STRESS2.style), *kept_values(VBD.style)}
    assert kept == set(ProfileTable.__struct_fields__) == {each.key for each in held_in(PROFILE)}
    for option in (*knobs(), OPTIONS["band"]):
        for value in (option.low, option.high):
            assert STRESS2.style.replace(**_changed(option, value))
        for value in (option.low - 0.01, option.high + 1):
            with pytest.raises((InputError, ValueError)):
                STRESS2.style.replace(**_changed(option, value))


def _changed(option, value):
    """A change of the style, with room for the widest of dots and for the largest of cells."""
    if option.name == "band":
        return {"straying": Straying(band=value)}
    room = {"dot_width_mm": 0.1, "dot_spacing_mm": 20.0, "cell_gap_mm": 20.0}
    return {**room, option.field: value}
