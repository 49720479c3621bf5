"""The settings file: what an option is where nothing gives it, and where that comes from."""

import json
import tomllib

import h5py
import pytest

from vbraille.cli.settings import save_profile
from vbraille.errors import InputError

TEXT = """# mine
language = "fr"
[render]
rate = 500
texture = 0.2
[profile.default]
contrast = 0.9
[profile.evening]
texture = 0.5
[profile.evening.stress2]
dot-width = 2.4
contrast = 0.5
"""


@pytest.fixture
def settings(tmp_path):
    path = tmp_path / "mine.toml"
    path.write_text(TEXT)
    return path


def rows(done):
    assert (done.code, done.err) == (0, "")
    return {row["name"]: (row["value"], row["from"]) for row in json.loads(done.out)["settings"]}


def test_each_setting_is_printed_with_its_origin(call, settings, monkeypatch):
    monkeypatch.setenv("VBRAILLE_RENDER_CONTRAST", "0.4")
    found = rows(call("settings", "render", "--settings", settings, "--profile=evening", "--json"))
    assert found["language"] == ("fr", "mine.toml line 2")
    assert found["rate"] == (500, "mine.toml line 4")
    assert found["texture"] == (0.5, "mine.toml line 9, profile evening")
    assert found["dot_width"] == (2.4, "mine.toml line 11, profile evening")
    assert found["contrast"] == (0.4, "environment variable VBRAILLE_RENDER_CONTRAST")
    assert found["seed"] == (1, "default")
    monkeypatch.delenv("VBRAILLE_RENDER_CONTRAST")
    found = rows(call("settings", "render", "--settings", settings, "--json", "--model", "vbd"))
    assert found["contrast"] == (0.9, "mine.toml line 7, profile default")
    assert found["dot_width"] == (None, "default")
    lines = call("settings", "render", "--settings", settings).out.splitlines()
    assert lines[:2] == [f"settings file: {settings}", "profile: default"]
    assert "texture: 0.2 (mine.toml line 5)" in lines
    assert call("settings", "--where", "--settings", settings).out == f"{settings}\n"


def test_a_command_has_a_profile_of_its_own(call, settings):
    settings.write_text(f'{TEXT}[read]\nprofile = "evening"\n')
    found = rows(call("settings", "--settings", settings, "--json"))
    assert found["profile"] == ("evening", "mine.toml line 14")
    assert found["texture"] == (0.5, "mine.toml line 9, profile evening")


def rendered(call, out, text, *options):
    done = call("render", text, "--out", out, "--force", "--lines", "1", *options)
    assert done.code == 0, done.err
    with h5py.File(out) as file:
        return json.loads(file.attrs["tuning"]), json.loads(file.attrs["geometry"]), done.err


def test_a_command_takes_them_and_an_option_wins(call, settings, text, tmp_path, monkeypatch):
    out = tmp_path / "out.h5"
    tuning, _, err = rendered(call, out, text, "--settings", settings)
    assert (tuning["texture"], tuning["contrast"]) == (0.2, 0.9)
    assert "French" in err
    monkeypatch.setenv("VBRAILLE_SETTINGS", str(settings))
    monkeypatch.setenv("VBRAILLE_RENDER_PROFILE", "evening")
    tuning, geometry, _ = rendered(call, out, text)
    assert (tuning["texture"], tuning["contrast"], geometry["dot_width_mm"]) == (0.5, 0.5, 2.4)
    tuning, geometry, _ = rendered(call, out, text, "--texture", "1", "--dot-width", "2")
    assert (tuning["texture"], tuning["contrast"], geometry["dot_width_mm"]) == (1, 0.5, 2)
    monkeypatch.setenv("VBRAILLE_RENDER_TEXTURE", "0.7")
    assert rendered(call, out, text)[0]["texture"] == 0.7
    _, geometry, _ = rendered(call, out, text, "--model", "vbd")
    assert geometry["dot_width_mm"] == 2.0  # its own: the profile has it for another display


@pytest.mark.parametrize(
    ("content", "said"),
    [
        ("[raed]\nx = 1", "line 1: unknown table 'raed'; did you mean 'read'?"),
        ("langage = 'fr'", "line 1: unknown option 'langage'; did you mean 'language'?"),
        ("[render]\n\ntextur = 1", "line 3: [render] unknown option 'textur'; did you mean"),
        ("[profile.default]\ndot_widht = 1", "line 2: [profile.default] unknown option"),
        ("[profile.default.vbd]\nlanguage = 'fr'", "line 2: [profile.default.vbd] unknown option"),
        ("[render]\ntexture = 2", "line 2"),
        ("[render]\ntexture = nan", "line 2"),
        ("[render]\ntexture = true", "line 2"),
        ("[render]\nmapping = 'sheard'", "line 2"),
        ("[profile.default.stress2]\ncontrast = -1", "line 2, profile default"),
        ("render = 3", "line 1"),
        ("[render", "is not TOML"),
        ("a = \xff", "not UTF-8"),
    ],
)
def test_what_a_file_cannot_have_is_a_sentence_with_its_line(call, settings, text, content, said):
    settings.write_bytes(content.encode("latin-1"))
    done = call("render", text, "--out", "never.h5", "--settings", settings)
    assert (done.code, done.out) == (2, "")
    assert done.err.count("\n") == 1
    assert "mine.toml" in done.err
    assert said in done.err


def test_a_file_that_is_named_must_be_there_and_the_usual_one_need_not(call, tmp_path):
    missing = tmp_path / "none.toml"
    assert "none.toml" in call("settings", "render", "--settings", missing).err
    assert call("settings", "render").code == 0
    assert call("settings", "render", "--settings", "/dev/null").code == 0


def test_a_saved_profile_leaves_all_else_and_is_read_again(call, settings):
    save_profile(settings, "evening", "stress2", {"contrast": 0.25, "mapping": "sheared"})
    save_profile(settings, "noon", "vbd", {"dot_row": 2})
    text = settings.read_text()
    assert text.startswith("# mine\n")
    tree = tomllib.loads(text)
    assert tree["render"] == {"rate": 500, "texture": 0.2}
    assert tree["profile"]["evening"]["texture"] == 0.5
    wanted = {"dot-width": 2.4, "contrast": 0.25, "mapping": "sheared"}
    assert tree["profile"]["evening"]["stress2"] == wanted
    assert tree["profile"]["noon"] == {"vbd": {"dot_row": 2}}
    found = rows(call("settings", "render", "--settings", settings, "--profile=evening", "--json"))
    assert found["mapping"][0] == "sheared"


def test_a_profile_that_cannot_be_saved_is_a_sentence(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(InputError, match="cannot be made"):
        save_profile(tmp_path / "file" / "mine.toml", "evening", "vbd", {"dot_row": 2})
    new = tmp_path / "new" / "mine.toml"
    save_profile(new, "evening", "vbd", {"dot_row": 2})
    assert tomllib.loads(new.read_text()) == {"profile": {"evening": {"vbd": {"dot_row": 2}}}}
