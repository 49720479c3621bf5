import subprocess
from pathlib import Path

import pytest

from tests.cli.program import VBRAILLE, run
from vbraille.page import Layout
from vbraille.translate import Book, Document, Table


@pytest.fixture(scope="module")
def layout(texts):
    return Layout(
        Book(Document.from_text((texts / "english.txt").read_text()), Table("en-ueb-g2.ctb")), 26
    )


@pytest.mark.parametrize(
    ("how", "spell"),
    [
        ("unicode", lambda line: line.printed.to_unicode()),
        ("brf", lambda line: line.printed.to_brf()),
        ("dots", lambda line: line.printed.to_dots()),
        ("text", lambda line: line.text),
    ],
)
def test_formats(texts, layout, how, spell):
    done = run("page", texts / "english.txt", "--format", how, "--lines", "3-30")
    assert done.returncode == 0
    assert done.stdout.splitlines() == [spell(line) for line in layout.lines(3, 30)]
    assert done.stderr == "line width: 26 cells\n"


def test_the_whole_text_on_the_vbd_in_french(texts):
    done = run("page", texts / "francais.txt", "--model", "vbd", "--language", "fr")
    assert done.stderr == "line width: 28 cells\n"
    table = Table("fr-bfu-comp6.utb")
    layout = Layout(Book(Document.from_text((texts / "francais.txt").read_text()), table), 28)
    assert done.stdout.splitlines() == [line.printed.to_unicode() for line in layout.lines()]


def test_the_geometry_s_width(texts):
    done = run("page", texts / "english.txt", "--lines", "1", "--geometry", "standard")
    assert done.stderr == "line width: 48 cells\n"
    done = run("page", texts / "english.txt", "--lines", "1", "--travel", "100", "--cell-gap", "6")
    assert done.stderr == "line width: 9 cells\n"


def test_verse_keeps_its_lines(tmp_path):
    verse = tmp_path / "verse"
    verse.write_text("one\n  two\n\nthree\n")
    kept = run("page", verse, "--keep-lines", "--format", "brf").stdout
    assert kept == '"O\n  TWO\n\n?REE\n'
    assert run("page", verse, "--format", "text").stdout == "one two\nthree\n"


def test_an_encoding_is_guessed_said_once_and_overridden(tmp_path, texts):
    path = tmp_path / "text"
    path.write_bytes((texts / "francais.txt").read_text().encode("cp1252", "replace"))
    right = run("page", texts / "francais.txt", "--format", "text", "--lines", "2-4").stdout
    guessed = run("page", path, "--format", "text", "--lines", "2-4")
    assert guessed.stdout == right
    assert guessed.stderr.count("--encoding") == 1
    first = next(n for n, byte in enumerate(path.read_bytes()) if byte > 127)
    assert f"(byte {first})" in guessed.stderr
    told = run("page", path, "--format", "text", "--lines", "2-4", "--encoding", "cp1252")
    assert (told.stdout, told.stderr) == (right, "line width: 26 cells\n")


@pytest.mark.parametrize("locale", ["C", "POSIX", "en_US.ISO-8859-1"])
def test_it_prints_in_any_locale(texts, locale):
    environment = {"PATH": "/usr/bin:/bin", "LC_ALL": locale, "PYTHONIOENCODING": "latin-1"}
    done = run("page", texts / "english.txt", "--lines", "1", env=environment, encoding="utf-8")
    assert "⠠⠁" in done.stdout


def test_a_reader_that_has_enough_ends_it_quietly(texts):
    with subprocess.Popen(
        [*VBRAILLE, "page", str(texts / "english.txt"), "--format", "dots"],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    ) as page:
        assert page.stdout
        assert page.stderr
        assert page.stdout.readline()
        page.stdout.close()
        assert page.stderr.read() == "line width: 26 cells\n"
        assert page.wait() == 0


def test_a_full_disk_is_said():
    with Path("/dev/full").open("w") as full:
        done = run("tables", capture_output=False, stdout=full, stderr=subprocess.PIPE)
    assert done.returncode == 1
    assert done.stderr == "vbraille: No space left on device\n"


def test_tables():
    every = run("tables").stdout.splitlines()
    assert len(every) > 150
    english = next(line for line in every if line.startswith("en-ueb-g2.ctb: "))
    assert ", language en, grade 2, " in english
    french = run("tables", "--language", "fr").stdout.splitlines()
    assert french == [line for line in every if ", language fr," in line]
    assert any(line.startswith("fr-bfu-comp6.utb: ") and line.endswith("6 dots") for line in french)


def test_help_and_version_are_no_errors():
    done = run("--help")
    assert (done.returncode, done.stderr) == (0, "")
    assert all(command in done.stdout for command in ("read", "page", "render", "plot", "tables"))
    assert run("--version").stdout.startswith("vbraille 0.")
