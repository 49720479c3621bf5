"""A profile is written into the settings file, and nothing else in it changes."""

from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from vbraille.config.settings import load_settings, parse_settings, save_profile, with_profile
from vbraille.errors import InputError, VbrailleError
from vbraille.render import STRESS2, VBD, model_of

TEXT = """# mine
[read]
language = "fr"   # at home

[profile.evening.stress2]
# after a long day
texture = 0.8   # soft
[keys]
LNDN = ["n"]"""


def tuned(model, **changes):
    return replace(model, style=model.style.replace(**changes))


def test_a_profile_is_made_and_changed_and_comments_stay(tmp_path):
    path = tmp_path / "new" / "settings.toml"
    said = save_profile(path, "evening", tuned(STRESS2, texture=0.5, dot_width_mm=2.2))
    assert said == "saved: profile evening for the STReSS²"
    settings = load_settings(str(path))
    assert settings.profiles["evening"]["stress2"]["dot_width_mm"] == 2.2
    assert with_profile(settings, "evening", STRESS2).style.tuning.texture == 0.5
    path.write_text(TEXT)
    save_profile(path, "evening", tuned(STRESS2, texture=0.5))
    save_profile(path, "my day", VBD)
    after = path.read_text()
    for kept in (
        "# mine\n",
        '"fr"   # at home\n',
        "# after a long day\n",
        "texture = 0.5   # soft\n",
    ):
        assert kept in after
    assert after.startswith(TEXT.split("texture", maxsplit=1)[0])
    settings = load_settings(str(path))
    assert settings.keys == {"LNDN": ("n",)}
    assert set(settings.profiles) == {"evening", "my day"}
    assert settings.profiles["my day"]["vbd"]["dot_row"] == 1
    assert [each.name for each in path.parent.iterdir()] == ["settings.toml"]


def test_a_link_to_the_file_stays_one(tmp_path):
    (tmp_path / "real.toml").write_text("")
    link = tmp_path / "settings.toml"
    link.symlink_to("real.toml")
    save_profile(link, "default", STRESS2)
    assert link.is_symlink()
    assert "[profile.default.stress2]" in (tmp_path / "real.toml").read_text()


def test_a_display_of_another_kind_has_its_name(tmp_path):
    path = tmp_path / "settings.toml"
    mine = model_of(replace(STRESS2.display, name="My Bench 3!", rows=8, columns=8))
    save_profile(path, "default", mine)
    assert "[profile.default.my-bench-3]" in path.read_text()
    assert with_profile(load_settings(str(path)), "default", mine) == mine


def test_what_cannot_be_written_leaves_the_file_as_it_is(tmp_path):
    path = tmp_path / "settings.toml"
    path.write_text("[raed]\n")
    with pytest.raises(InputError, match=r"settings.toml line 1: \[raed\]"):
        save_profile(path, "evening", STRESS2)
    assert path.read_text() == "[raed]\n"
    with pytest.raises(InputError, match="profile is ' '; it must be a name"):
        save_profile(tmp_path / "x.toml", " ", STRESS2)
    (tmp_path / "file").write_text("")
    with pytest.raises(VbrailleError, match="Not a directory"):
        save_profile(tmp_path / "file" / "sub" / "settings.toml", "evening", STRESS2)


@given(
    texture=st.integers(0, 10),
    width=st.integers(5, 40),
    name=st.text("abc -_.9é", min_size=1).filter(str.strip),
)
def test_what_is_saved_is_read_again(tmp_path_factory, texture, width, name):
    path = tmp_path_factory.mktemp("saved") / "settings.toml"
    path.write_text(TEXT)
    model = tuned(STRESS2, texture=texture / 10, dot_width_mm=width / 10)
    save_profile(path, name, model)
    assert with_profile(parse_settings(path.read_text(), path), name, STRESS2) == model
