"""The page on settings: its file can be read, and what it says of it comes out."""

import re
from pathlib import Path

import pytest

from vbraille.cli.parser import parse
from vbraille.errors import InputError
from vbraille.render import STRESS2, VBD
from vbraille.render.braille.knobs import kept_values
from vbraille.settings.origins import USUAL, say_settings, say_tuning
from vbraille.settings.tables import ProfileTable, ReadTable, parse_settings
from vbraille.settings.values import with_profile

PAGE = (Path(__file__).parents[2] / "docs/settings.md").read_text(encoding="utf-8")
FILE = Path("settings.toml")
OPTIONS = parse(["settings"]).usual
(TOML,) = re.findall(r"^```toml\n(.*?)^```$", PAGE, re.MULTILINE | re.DOTALL)


def test_the_file_of_the_page_is_read_as_the_page_says():
    settings = parse_settings(TOML, FILE)
    model = with_profile(settings, settings.profile, STRESS2)
    said = [
        *say_tuning(settings, settings.profile, STRESS2, model.style),
        *say_settings(settings, {}, OPTIONS),
    ]
    shown, faulty = re.findall(r"^```text\n(.*?)^```$", PAGE, re.MULTILINE | re.DOTALL)
    for line in shown.splitlines():
        assert line in said
    with pytest.raises(InputError) as refused:
        parse_settings(TOML.replace("\ncontrast = 1.0", "\ncontrst = 1.0"), FILE)
    assert str(refused.value).startswith(faulty.removeprefix("vbraille: ").rstrip("…\n"))


def test_the_tables_of_the_page_have_all_keys():
    rows = dict(re.findall(r"^\| `\[([a-z]+)[^|]*\| (.*) \|$", PAGE, re.MULTILINE))
    assert set(re.findall(r"`([a-z_]+)`", rows["read"])) == set(ReadTable.__struct_fields__)
    assert set(re.findall(r"`([a-z_]+)`", rows["profile"])) == set(ProfileTable.__struct_fields__)
    kept = {*kept_values(STRESS2.style), *kept_values(VBD.style)}
    assert kept == set(ProfileTable.__struct_fields__)
    assert set(OPTIONS) == set(ReadTable.__struct_fields__) - {"profile"}
    assert set(USUAL) == {name for name, value in OPTIONS.items() if value is None}
