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
    assert said.err == "profile: noon is new, and is made when it is saved\n"
    assert "profile: noon (option)\n" in said.out
    assert "contrast: 1 (default)\n" in said.out


def test_the_path_is_said_even_of_a_file_that_cannot_be_used(call, settings):
    settings.write_text("[raed]\n")
    said = call("settings", "--settings", settings, "--where")
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
    said = call(*command)
    assert said.code == 0
    # Dots that stand closer leave room for more cells; grade and echo are the file's.
    assert said.err == program.line_width(28, program.UNCONTRACTED)
    assert said.out.startswith("line: 1\ntext: one two three\n")
    options = ("--table", "fr-bfu-comp6.utb", "--dot-spacing", "3.7", "--echo", "none")
    # An option goes before the file in every command; a page needs no process.
    page = call("page", text, "--settings", settings, *options[:-2])
    assert page.err == program.line_width(26, "French uncontracted braille")
    if TIER is Tier.TEST:
        return
    said = call(*command, *options)
    assert said.err == program.line_width(26, "French uncontracted braille")
    assert not said.out.startswith("line")


def test_a_page_takes_language_grade_and_table_and_braille_stays_braille(call, text, settings):
    said = call("page", text, "--settings", settings)
    assert said.err == program.line_width(26, program.UNCONTRACTED)
    braille = text.with_suffix(".brf")
    braille.write_text("ABC\n")
    said = call("page", braille, "--settings", settings, "--format", "brf")
    assert (said.code, said.out.strip()) == (0, "ABC")
    said = call("page", braille, "--grade", "1")
    assert said.code == 2


@pytest.mark.parametrize(
    ("table", "said"),
    [
        ('[keys]\nLNDN = ["crtl-n"]', "line 2: there is no key 'crtl-n'; the nearest is ctrl-n"),
        ('[keys]\nLNDN = ["xyzzy"]', "line 2: there is no key 'xyzzy'; write a character"),
        ('[buttons]\n1 = "LNDNN"', "line 2: there is no command 'LNDNN'; the nearest is LNDN"),
        ('[read]\nmodel = "vbd"', "line 2: [read] has no key 'model'; there is advance, "),
    ],
)
def test_what_reading_refuses_is_refused_where_settings_are_listed(
    call, text, settings, table, said
):
    settings.write_text(table)
    listed, read = (call(*c, "--settings", settings) for c in (("settings",), ("read", text)))
    assert (listed.code, listed.out) == (read.code, read.out) == (2, "")
    assert listed.err == read.err
    assert said in listed.err


def test_a_setting_is_a_wish_and_an_option_is_not(call, tmp_path, text, settings):
    settings.write_text('[read]\nkeep_lines = true\nencoding = "latin-1"\n')
    book = tmp_path / "book.html"
    book.write_text("<p>one two three", "utf-8")
    braille = text.with_suffix(".brf")
    braille.write_text("ABC\n")
    for file in (book, braille):
        with program.Terminal("read", file, "--settings", settings, "--advance=key") as terminal:
            terminal.until("h says the keys\r\n")
            terminal.type("/c\n")  # another process opens the book, too
            terminal.until("text: c\r\n(line|not found)")
            terminal.type("q")
            assert terminal.end() == 0
    text.write_bytes("caf\xe9\n".encode("latin-1"))
    said = call("read", text, *FAST, "--settings", settings)
    assert (said.code, "text: café" in said.out) == (0, True)
    said = call("read", book, *FAST, "--settings", settings, "--keep-lines")
    assert (said.code, said.out) == (2, "")
    assert "--keep-lines" in said.err


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


def test_a_ready_set_of_keys_is_chosen_by_the_file_or_an_option(call, text, settings):
    settings.write_text('[read]\nkeys = "nvda"\n[keys]\nLNDN = ["full stop"]\n')
    listed = call("keys", "--settings", settings).out.splitlines()
    assert "NXHEADING: h: next heading" in listed
    assert "LNDN: full stop: next line" in listed
    usual = call("keys", "--settings", settings, "--keys", "usual").out.splitlines()
    assert "NXHEADING: e: next heading" in usual
    assert "LNDN: full stop: next line" in usual
    assert call("keys").out == call("keys", "--keys", "usual").out
    said = call("settings", "--settings", settings).out.splitlines()
    assert "keys: nvda (mine.toml line 2)" in said
    assert "keys: usual (default)" in call("settings").out.splitlines()
    assert "keys: nvda (option)" in call("settings", "--keys", "nvda").out.splitlines()
    with program.Terminal("read", text, "--advance", "key", "--settings", settings) as terminal:
        terminal.until("f1 says the keys\r\n")
        terminal.type("h")
        terminal.until("heading: none after this\r\n")
        terminal.type(".")
        terminal.until("line: 2\r\n")
        terminal.type("q")
        terminal.until("quotation: none after this\r\n")
        terminal.type("\x04")
        assert terminal.end() == 0


@pytest.mark.parametrize("keys", ['"jaws"', "1"])
def test_a_set_of_keys_that_there_is_not_is_one_sentence(call, settings, keys):
    settings.write_text(f"[read]\nkeys = {keys}\n")
    said = call("keys", "--settings", settings)
    assert (said.code, said.out) == (2, "")
    assert "mine.toml line 2" in said.err
    assert said.err.count("\n") == 1


def test_a_terminal_that_goes_away_ends_reading_whatever_its_keys_mean(text, settings):
    settings.write_text('[read]\nkeys = "nvda"\n')
    ignoring = f"trap '' HUP; exec {' '.join(program.PROGRAM)} read {text} --advance key"
    with program.Terminal(f"{ignoring} --settings {settings}", program=["sh", "-c"]) as terminal:
        terminal.until("f1 says the keys\r\n")
        terminal.type("/")
        terminal.until("search: type the text, Enter\r\n")
        terminal.hang_up()
        terminal.process.wait(program.PATIENCE_S)
