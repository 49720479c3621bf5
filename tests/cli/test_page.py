"""``vbraille page``: the formats, ranges of lines, and its output in hostile surroundings."""

import os

import pytest

from tests.cli import program
from vbraille.braille.spelling import spell
from vbraille.translate import Cells

UNICODE = """\
⠀⠀⠐⠕⠀⠞⠺⠕⠀⠹⠗⠑⠑
⠀⠀⠋⠳⠗⠀⠋⠊⠧⠑⠀⠎⠊⠭
⠀⠀⠎⠑⠧⠢⠀⠑⠊⠣⠞⠀⠝⠔⠑
"""


def test_the_formats_say_the_same(call, text):
    assert call("page", text) == call("page", text, "--format", "unicode")
    assert call("page", text).out == UNICODE
    assert call("page", text).err == program.line_width(26)
    said = call("page", text, "--format", "text")
    assert said.out == "one two three\nfour five six\nseven eight nine\n"
    brf = call("page", text, "--format", "brf").out
    assert brf.splitlines()[0] == '  "O TWO ?REE'
    dots = call("page", text, "--format", "dots").out
    assert dots.splitlines()[0] == ("0 0 5 1-3-5 0 2-3-4-5 2-4-5-6 1-3-5 0 1-4-5-6 1-2-3-5 1-5 1-5")
    for line, brf_line, dots_line in zip(
        UNICODE.splitlines(), brf.splitlines(), dots.splitlines(), strict=True
    ):
        masks = Cells.from_unicode(line).masks.tolist()
        assert Cells.from_brf(brf_line).masks.tolist() == masks
        assert list(spell(dots_line, {})) == masks


@pytest.mark.no_cover
@pytest.mark.parametrize(
    ("lines", "wanted"),
    [
        ("1", slice(0, 1)),
        ("3-10", slice(2, 10)),
        ("290-", slice(289, None)),
        ("-3", slice(0, 3)),
        ("292-999999999999999", slice(291, None)),
    ],
)
def test_lines_are_counted_from_1_in_the_book(call, texts, lines, wanted):
    whole = call("page", texts / "english.txt", "--format", "text").out.splitlines()
    assert len(whole) == 297
    part = call("page", texts / "english.txt", "--format", "text", f"--lines={lines}")
    assert part.code == 0
    assert part.out.splitlines() == whole[wanted]


def test_options_of_text_and_page_reach_it(call, tmp_path, text):
    def first(*options):
        said = call("page", text, "--lines", "1", *options)
        assert said.code == 0
        return said.out.strip("\n⠀"), said.err

    assert first("--table", "en-ueb-g1.ctb")[0] == "⠕⠝⠑⠀⠞⠺⠕⠀⠞⠓⠗⠑⠑"
    assert first("--grade", "1") == first("--table", "en-ueb-g1.ctb")
    french = tmp_path / "french.txt"
    french.write_text("où")
    assert call("page", french, "--language", "fr").out == "⠀⠀⠕⠾\n"
    assert first("--travel", "60") == ("⠐⠕", program.line_width(4))
    assert first("--travel", "18")[1] == program.line_width(1)
    assert first("--model", "vbd")[1] == program.line_width(28)
    assert first("--geometry", "standard", "--cell-gap", "10")[1] == program.line_width(24)
    text.write_bytes("Größe\n  kurz".encode("latin-1"))
    verse = call("page", text, "--format", "text", "--encoding", "latin-1", "--keep-lines")
    assert verse.out == "Größe\n  kurz\n"


def test_a_text_that_is_not_utf_8_is_told_once(call, text):
    text.write_bytes("Zwölf Boxkämpfer jagen Viktor quer über den Sylter Deich".encode("cp1252"))
    said = call("page", text, "--format", "text")
    assert "Boxkämpfer" in said.out
    assert len(said.err.splitlines()) == 2
    assert "--encoding" in said.err


def test_nothing_in_a_text_moves_the_cursor(call, text):
    text.write_bytes(b"red \x1b[31m ring \x07 rub \x7f csi \xc2\x9b2J")
    said = call("page", text, "--format", "text", "--travel", "1000")
    assert said.out == "red <escape>[31m ring <bell> rub <delete> csi ›2J\n"


@pytest.mark.parametrize(
    ("choice", "instead"),
    [
        (("--table", "fr-bfu-comp8.utb"), "--table fr-bfu-comp6.utb, which has six, or --format"),
        (("--language", "ja"), "give --format unicode"),
    ],
)
def test_a_table_of_eight_dots_has_no_brf(call, text, choice, instead):
    said = call("page", text, *choice, "--format", "brf")
    assert (said.code, said.out) == (2, "")
    assert said.err.count("\n") == 1
    assert "has eight dots and BRF has six" in said.err
    assert instead in said.err
    assert call("page", text, *choice).code == 0


@pytest.mark.parametrize(
    ("options", "line", "said_of_it"),
    [
        ((), '  HI .<GR9N+ FACE.> "!', "named in the text"),
        (("--undefined", "drop"), '  HI  "!', "left out"),
    ],
)
def test_what_the_table_does_not_know_is_written_in_six_dots(call, text, options, line, said_of_it):
    text.write_text("hi \U0001f600 there")
    said = call("page", text, "--format", "brf", *options)
    assert (said.code, said.out) == (0, f"{line}\n")
    width, counted = said.err.splitlines()
    assert width == program.line_width(26)[:-1]
    assert "does not know 1 character (1 of U+1F600 grinning face)" in counted
    assert said_of_it in counted


@pytest.mark.parametrize(
    ("options", "written"),
    [
        ((), "  ! ^(=T=^)1 ="),
        (("--foreign", "own"), "  ! ^/ET^/E1 ="),
    ],
)
def test_a_passage_in_another_language(call, tmp_path, options, written):
    book = tmp_path / "book.html"
    book.write_text('<html lang="en"><p>the <span lang="fr">été</span>, for</p></html>')
    said = call("page", book, "--format", "brf", *options)
    assert (said.code, said.out) == (0, f"{written}\n")


def test_only_what_was_printed_is_counted(call, text):
    text.write_text(
        "one \U0001f600\n\ntwo\n\nthree \U0001f600\u0434\u4e2d\ue000\ue001 \U0001f600\n"
    )
    assert "1 character (" in call("page", text, "--lines", "1").err
    assert call("page", text, "--lines", "2").err == program.line_width(26)
    said = call("page", text).err
    assert "3 characters (3 of U+1F600 grinning face), named" in said
    assert "4 characters (1 of " in said
    assert "1 of others" in said


def test_a_text_in_another_script_names_its_languages(call, text):
    text.write_text("Все люди рождаются свободными.\n\nИ равными.\n")
    said = call("page", text)
    assert said.code == 0
    notes = [note for note in said.err.splitlines() if "Cyrillic letters" in note]
    assert len(notes) == 1
    assert "--language" in notes[0]
    assert call("page", text, "--language", "ru").err == program.line_width(26, "Russian braille")


def test_the_lines_of_text_together_are_the_text(call, text):
    for width in ("40", "60", "300"):
        text.write_text("Look at https://example.org/a/b -- it is well-known.")
        said = call("page", text, "--format", "text", "--travel", width)
        assert said.out.replace("\n", "") == text.read_text()


def test_overstrikes_are_no_text(call, text):
    text.write_text("A _\bw_\bo_\br_\bd and b\bbo\bol\bld\bd\n" * 3)
    said = call("page", text, "--format", "text", "--travel", "1000")
    assert said.out == "A word and bold A word and bold A word and bold\n"
    assert said.err.count("\n") == 1


def test_a_brf_file_is_read_as_it_is(call, tmp_path):
    book = tmp_path / "book.BRF"
    book.write_bytes(b"  ,! 9vi*t]\r\n\r\n,b #c\r\n")
    said = call("page", book, "--format", "brf")
    assert said.out == "  ,! 9VI*T]\n\n,B #C\n"
    assert said.err == program.line_width(26, "braille as it is")
    assert call("page", book, "--format", "text").out == "  ,! 9vi*t]\n\n,b #c\n"
    assert call("page", book, "--lines", "3").out == "⠠⠃⠀⠼⠉\n"
    said = call("page", book, "--language", "fr")
    assert (said.code, said.out) == (2, "")
    assert said.err == f"vbraille: {book} is in braille already; leave out --language\n"
    book.write_text("caf\xe9")
    said = call("page", book)
    assert (said.code, said.out) == (0, "⠉⠁⠋\n")
    assert "1 character that are no braille" in said.err
    book.write_text("⣀")
    assert call("page", book).out == "⣀\n"
    said = call("page", book, "--format", "brf")
    assert (said.code, said.out) == (2, "")
    assert "dots 7-8; give --format unicode" in said.err


@pytest.mark.parametrize(
    "surroundings",
    [
        {"LC_ALL": "C", "PYTHONCOERCECLOCALE": "0", "PYTHONUTF8": "0"},
        {"LC_ALL": "POSIX", "PYTHONIOENCODING": "latin-1"},
    ],
)
def test_it_prints_whatever_the_locale(tmp_path, surroundings):
    text = tmp_path / "Größe.txt"
    text.write_text("naïve 點\n\none two three\n")
    environment = {k: v for k, v in os.environ.items() if not k.startswith(("LC_", "LANG"))}
    done = program.run("page", text, "--format", "text", env={**environment, **surroundings})
    assert done.returncode == 0
    assert done.stdout == "naïve 點\none two three\n"
    done = program.run("page", f"{text}.Ω", env={**environment, **surroundings})
    assert done.returncode == 2
    assert done.stderr.startswith("vbraille: there is no file")
    assert done.stderr.count("\n") == 1


@pytest.mark.new_processes
def test_a_reader_who_has_enough_ends_it_quietly(tmp_path):
    big = tmp_path / "big.txt"
    big.write_text("one two three\n\n" * 20_000)
    with program.start("page", big) as process:
        assert process.stdout.readline() == "⠀⠀⠐⠕⠀⠞⠺⠕⠀⠹⠗⠑⠑\n".encode()
        process.stdout.close()
        assert process.stderr.read() == program.line_width(26).encode()
        assert process.wait(program.PATIENCE_S) == 1  # not all of it was printed


def test_a_pipe_is_read_like_a_file(text):
    done = program.run("page", "/dev/stdin", stdin=None, input=text.read_text())
    assert (done.returncode, done.stdout) == (0, UNICODE)
