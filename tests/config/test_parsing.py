"""A settings file is read whole, or refused in one sentence with its line."""

from pathlib import Path

import pytest

from vbraille.config.settings import (
    bindings_said,
    display_name,
    load_settings,
    missing_profile,
    parse_settings,
    settings_said,
    tuning_said,
    with_profile,
)
from vbraille.errors import InputError
from vbraille.files import settings_path
from vbraille.render import STRESS2, VBD

FILE = Path("settings.toml")
TEXT = """# mine
[read]
language = "fr"
profile = "evening"
keep_lines = true

[keys]
LNDN = ["n", "j"]
[buttons]
1 = "LNDN"
"knob 1" = "CONTRAST"

[profile.evening.stress2]
texture = 0.8   # soft
dot_width_mm = 2.4
mapping = "sheared"
[profile.evening.vbd]
dot_row = 2
"""


def test_what_a_file_says_and_where():
    settings = parse_settings(TEXT, FILE)
    assert settings.read == {"language": "fr", "profile": "evening", "keep_lines": True}
    assert settings.profile == "evening"
    assert settings.keys == {"LNDN": ("n", "j")}
    assert settings.buttons == {"1": "LNDN", "knob 1": "CONTRAST"}
    assert settings.where("profile", "evening", "stress2", "texture") == "settings.toml line 14"
    shown = with_profile(settings, "evening", STRESS2)
    assert shown.style == STRESS2.style.replace(
        texture=0.8, dot_width_mm=2.4, mapping=shown.style.mapping
    )
    assert shown.style.mapping.name == "sheared"
    assert with_profile(settings, "evening", VBD).style.mapping.name == "dot-row-2"
    assert with_profile(settings, "other", STRESS2) == STRESS2


def test_each_setting_is_one_line_with_where_it_comes_from():
    settings = parse_settings(TEXT, FILE)
    style = STRESS2.style.replace(texture=0.8, dot_width_mm=2.2, cell_gap_mm=7.0)
    assert list(map(str, tuning_said(settings, "evening", STRESS2, style))) == [
        "texture: 0.8 (profile evening, settings.toml line 14)",
        "contrast: 1 (default)",
        "texture cycles: 7 (default)",
        "dot width: 2.2 mm (option)",
        "dot spacing: 3.7 mm (default)",
        "cell gap: 7 mm (option)",
        "line pitch: 14 mm (default)",
        "mapping: alternate (option)",
    ]
    given = list(map(str, tuning_said(settings, "evening", STRESS2, style, ("texture",))))
    assert given[0] == "texture: 0.8 (option)"
    said = list(map(str, settings_said(settings, {"device": "sim:", "grade": None})))
    assert said[:3] == [
        "device: sim: (option)",
        "language: fr (settings.toml line 3)",
        "grade: what is usual in the language (default)",
    ]
    assert "keep lines: yes (settings.toml line 5)" in said
    assert list(map(str, bindings_said(settings))) == [
        "keys of LNDN: n, j (settings.toml line 8)",
        "button 1: LNDN (settings.toml line 10)",
        "knob 1: CONTRAST (settings.toml line 11)",
    ]


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("\n[raed]", "line 2: [raed] is no table of settings; the nearest is read, and there is "),
        ("read = 1", "line 1: read is 1; it must be a table"),
        ('[read]\nlangauge = "fr"', "line 2: [read] has no key 'langauge'; the nearest is l"),
        ('[read]\nadvance = "ky"', "line 2: [read] advance is 'ky'; the nearest is key"),
        ('[read]\ngrade = "2"', "line 2: [read] grade is '2'; it must be a whole number"),
        ('[read]\ntable = "x"\ngrade = 1', "line 2: [read] table has its language and grade"),
        ('[read]\nprofile = "a/b"', "line 2: [read] profile is 'a/b'; it must be a name"),
        ('profile = "x"', "line 1: profile is no table; write which one is in use under [read]"),
        ("[profile.evening]\nstress2 = 3", "line 2: [profile.evening] stress2 is 3; it must be a"),
        ("[profile.e.vbd]\n\ncontrst = 1", "line 3: [profile.e.vbd] has no key 'contrst'; the "
         "nearest is contrast, and there is "),
        ("[profile.e.vbd]\ndot_width_mm = 50", "line 2: [profile.e.vbd] dot width is 50 mm; it "
         "must be 0.1 to 20 mm"),
        ("[profile.e.vbd]\ntexture_cycles = 4", "line 2: [profile.e.vbd] texture cycles are 4; "),
        ('[profile.e.vbd]\ntexture = "x"', "line 2: [profile.e.vbd] texture is 'x'; it must be a"),
        ('[profile."a/b".vbd]', "line 1: [profile.a/b]: profile is 'a/b'; it must be a name"),
        ('[keys]\nLNDN = "n"', "line 2: [keys] LNDN is 'n'; it must be a list, in brackets"),
        ("[keys]\nLNDN = [3]", "line 2: [keys] LNDN, number 1, is 3; it must be a string"),
        ("[buttons]\n1 = 2", "line 2: [buttons] 1 is 2; it must be a string"),
        ("x", "is not TOML: "),
    ],
)  # fmt: skip
def test_what_no_settings_file_has_is_said_in_one_sentence(text, says):
    with pytest.raises(InputError) as refused:
        parse_settings(text, FILE)
    assert str(refused.value).startswith(f"settings.toml {says}")


@pytest.mark.parametrize(
    ("table", "model", "says"),
    [
        ("stress2]\ndot_width_mm = 12", STRESS2, "line 1: [profile.e.stress2] dot width is 12 mm"),
        ('stress2]\nmapping = "x"', STRESS2, "line 2: [profile.e.stress2] mapping is 'x'; it must"),
        ("stress2]\ndot_row = 2", STRESS2, "line 2: [profile.e.stress2] dot row is not for this"),
        ('vbd]\nmapping = "paired"', VBD, "line 2: [profile.e.vbd] mapping is not for this"),
        ("vbd]\ntexture_cycles = 3", VBD, "line 2: [profile.e.vbd] texture cycles cannot be set"),
    ],
)
def test_what_a_display_cannot_show_is_said_with_its_line(table, model, says):
    settings = parse_settings(f"[profile.e.{table}", FILE)
    with pytest.raises(InputError) as refused:
        with_profile(settings, "e", model)
    assert str(refused.value).startswith(f"settings.toml {says}")


def test_where_the_file_is(tmp_path, monkeypatch):
    monkeypatch.setenv("VBRAILLE_SETTINGS", str(tmp_path / "mine.toml"))
    assert settings_path() == tmp_path / "mine.toml"
    assert load_settings().read == {}  # it need not be there
    assert settings_path("other.toml") == Path("other.toml")
    with pytest.raises(InputError, match="there is no file other"):
        load_settings("other.toml")
    (tmp_path / "mine.toml").write_text("[read]\ngrade = 1\n")
    assert load_settings().read == {"grade": 1}
    monkeypatch.delenv("VBRAILLE_SETTINGS")
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path))
    assert settings_path() == tmp_path / "vbraille" / "settings.toml"


def test_names_of_displays_and_of_profiles_that_are_not_there():
    settings = parse_settings(TEXT, FILE)
    assert display_name(STRESS2) == "stress2"
    assert missing_profile(settings, "evening") == ""
    assert missing_profile(settings, "evning").endswith("saved; the nearest is evening")
