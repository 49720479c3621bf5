"""``vbraille settings``, and what a settings file does to reading."""

import tomllib

import pytest

from tests.cli import program
from tests.tiers import TIER, Tier

TEXT = """# mine
[read]
grade = 1
echo = "text"
profile = "evening"

[profile.evening.stress2]
contrast = 0.5
dot_spacing_mm = 3.0
"""
FAST = ("--hand", "sweep:1000")


@pytest.fixture
def settings(tmp_path):
    path = tmp_path / "mine.toml"
    path.write_text(TEXT)
    return path


def test_each_setting_is_said_with_where_it_comes_from(call, settings):
    said = call("settings", "--settings", settings, "--texture", "1", "--language", "fr")
    assert (said.code, said.err) == (0, "")
    lines = said.out.splitlines()
    assert lines[:4] == [
        f"settings file: {settings}",
        "profile: evening (mine.toml line 5)",
        "display: STReSS² (default)",
        "texture: 1 (option)",
    ]
    for line in (
        "contrast: 0.5 (profile evening, mine.toml line 8)",
        "cell gap: 7.4 mm (default)",
        "language: fr (option)",
        "grade: 1 (mine.toml line 3)",
        "advance: return (default)",
        "foreign: switch (default)",
        "undefined: mark (default)",
    ):
        assert line in lines
    said = call("settings", "--profile", "noon", "--settings", settings)
    assert (
        said.err == "profile: noon is new, and is made when it is saved; the nearest is evening\n"
    )
    assert "profile: noon (option)\n" in said.out
    assert "contrast: 1 (default)\n" in said.out


def test_the_path_is_said_even_of_a_file_that_cannot_be_used(call, settings):
    settings.write_text("[raed]\n")
    said = call("settings", "--settings", settings, "--path")
    assert (said.code, said.out, said.err) == (0, f"{settings}\n", "")
    for command in (("settings",), ("read", "none.txt"), ("page", "none.txt"), ("tune",)):
        said = call(*command, "--settings", settings)
        assert (said.code, said.out) == (2, "")
        assert said.err == (
            "vbraille: mine.toml line 1: [raed] is no table of settings; "
            "the nearest is read, and there is buttons, keys, profile, read\n"
        )


def test_reading_goes_by_the_file_unless_an_option_says_otherwise(call, text, settings):
    command = ("read", text, *FAST, "--lines", "1", "--settings", settings)
    said = program.run(*command)
    assert said.returncode == 0
    # Dots that stand closer leave room for more cells; grade and echo are the file's.
    assert said.stderr == "line width: 28 cells, table en-ueb-g1.ctb\n"
    assert said.stdout.startswith("line: 1\ntext: one two three\n")
    options = ("--table", "fr-bfu-comp6.utb", "--dot-spacing", "3.7", "--echo", "none")
    # An option goes before the file in every command; a page needs no process.
    page = call("page", text, "--settings", settings, *options[:-2])
    assert page.err == "line width: 26 cells, table fr-bfu-comp6.utb\n"
    if TIER is Tier.TEST:
        return
    said = program.run(*command, *options)
    assert said.stderr == "line width: 26 cells, table fr-bfu-comp6.utb\n"
    assert not said.stdout.startswith("line")


def test_a_page_takes_language_grade_and_table_and_braille_stays_braille(call, text, settings):
    assert call("page", text, "--settings", settings).err.endswith("table en-ueb-g1.ctb\n")
    braille = text.with_suffix(".brf")
    braille.write_text("ABC\n")
    said = call("page", braille, "--settings", settings, "--format", "brf")
    assert (said.code, said.out.strip()) == (0, "ABC")
    said = call("page", braille, "--grade", "1")
    assert said.code == 2


def test_a_turn_at_a_terminal_is_saved_and_undone(tmp_path, text, settings):
    hand = tmp_path / "hand.csv"
    hand.write_text("0,64.2\n0.1,64.2\n")
    arguments = ("read", text, "--hand", f"recorded:{hand}", "--settings", settings)
    with program.Terminal(*arguments) as terminal:
        terminal.until("h says the keys\r\n")
        for key, said in (
            ("c", "contrast: 0.6"),
            ("s", "dot spacing: 3.2 mm"),
            ("U", "undo: dot spacing 3 mm"),
            ("P", "saved: profile evening for the STReSS²"),
        ):
            terminal.type(key)
            terminal.until(rf"(^|\n){said}\r\n")
        terminal.type("q")
        assert terminal.end() == 0
    saved = tomllib.loads(settings.read_text())["profile"]["evening"]["stress2"]
    assert (saved["contrast"], saved["dot_spacing_mm"]) == (0.6, 3.0)
    assert settings.read_text().startswith("# mine\n")
