"""What cannot be used: one sentence that says what to do, exit code 2, and nothing printed."""

import io
import re
import sys
import zipfile

import pytest

from tests.tiers import TIER, Tier, heavy
from vbraille.translate import list_tables

PNG = b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\0\1\0\0\0\1\x08\6\0\0\0\x1f\x15\xc4\x89"


COMMANDS = [
    ("page",),
    ("render", "--out", "never.h5"),
    # It starts the process of a device each time, and opens files and tables as the others do.
    pytest.param(("read",), marks=heavy),
]


def zipped():
    archive = io.BytesIO()
    with zipfile.ZipFile(archive, "w") as written:
        written.writestr("text.txt", "one two three")
    return archive.getvalue()


def refused(said, *, code=2):
    """The sentence, without who says it."""
    assert said.code == code
    assert said.out == ""
    *before, sentence = said.err.split("\n")[:-1]
    assert not [line for line in before if not line.startswith("line width: ")]
    assert sentence.startswith("vbraille: ")
    assert "fault of vbraille" not in sentence
    assert sentence.isprintable()
    return sentence.removeprefix("vbraille: ")


@pytest.mark.parametrize(
    ("content", "sentence"),
    [
        (b"", "{} is empty; give a text file"),
        (b"\xef\xbb\xbf", "{} is empty; give a text file"),
        (b" \n\n\t \n", "{} has no text in it; give a text file"),
        (PNG, "{} is a PNG image, not text; give a text file"),
        (zipped(), "{} is a zip archive (a .docx, .odt or .epub is one too), not text; give"),
        (bytes(range(256)) * 16, "{} is binary data, not text; give a text file"),
    ],
    ids=["empty", "mark", "blank", "image", "archive", "binary"],
)
@pytest.mark.parametrize("command", COMMANDS)
def test_files_that_are_no_text(call, text, content, sentence, command):
    text.write_bytes(content)
    assert refused(call(*command, text)).startswith(sentence.format(text))


def test_files_that_cannot_be_read(call, tmp_path):
    missing, folder, loop = tmp_path / "none.txt", tmp_path, tmp_path / "loop.txt"
    loop.symlink_to(loop)
    for command in (("page",), ("render", "--out", "never.h5"), ("read",)):
        said = refused(call(*command, missing))
        assert said == f"there is no file {missing}; check the name"
        if command == ("read",) and TIER is Tier.TEST:
            return  # it starts the process of a device each time
        said = refused(call(*command, folder))
        assert said == f"{folder} is a directory; give a text file in it"
        said = refused(call(*command, "/proc/self/mem"))
        assert said == "/proc/self/mem cannot be read: Input/output error"
        assert "cannot be read" in refused(call(*command, loop))


def test_a_control_character_in_a_name_is_named(call):
    assert "no<escape>[2J<bell>" in refused(call("page", "no\x1b[2J\x07"))
    assert "\\udcff" in refused(call("page", "no\udcff"))


NUMBERS = {
    "--dot-width": ("0.1 to 20 mm", "0.09", "20.1"),
    "--dot-spacing": ("0.1 to 50 mm", "0", "51"),
    "--cell-gap": ("0.1 to 50 mm", "-3", "1e9"),
    "--line-pitch": ("1 to 500 mm", "0.5", "501"),
    "--travel": ("1 to 10000 mm", "0.9", "1e5"),
    "--texture": ("0 to 1", "-0.1", "1.01"),
    "--contrast": ("0 to 1", "-1", "2"),
    "--rate": ("1 to 10000 Hz", "0", "10001"),
}


@pytest.mark.parametrize("option", NUMBERS)
def test_numbers_out_of_range_name_the_range(call, text, option):
    wanted, *outside = NUMBERS[option]
    commands = ["render", "read"]
    if option not in ("--texture", "--contrast", "--rate"):
        commands.append("page")
    for command in commands:
        out = ("--out", "never.h5") if command == "render" else ()
        for value in (*outside, "nan", "inf", "-inf"):
            said = refused(call(command, text, *out, f"{option}={value}"))
            assert said.endswith(f"; it must be {wanted}")
        for value in ("", "wide", "1,5", "0x10"):
            said = refused(call(command, text, *out, f"{option}={value}"))
            assert f"argument {option}: {value!r} is not a number" in said


@pytest.mark.parametrize(
    ("options", "pattern"),
    [
        ("--travel 12", r"a travel of 12 mm is too short for one cell; it must be at least 17.1"),
        ("--dot-width 15", r"dot width is 15 mm; it must be at most the cell pitch, here 11.1 mm"),
        ("--table nosuch.ctb", r"there is no braille table 'nosuch.ctb'; the nearest are "),
        ("--table en-ueb-g3.ctb", r"nearest are en-ueb-g[12].ctb, en-ueb-g[12].ctb"),
        ("--table=", r"there is no braille table ''"),
        ("--table /etc/passwd", r"liblouis cannot use /etc/passwd as a braille table"),
        ("--language xx", r"there is no table for language 'xx'; the nearest is xh "),
        ("--grade 7", r"there is no grade 7 for language 'en'; there is .*1, 2"),
        ("--language fr --grade 9", r"no grade 9 for language 'fr'; there is 1, 2"),
        ("--grade 1.5", r"argument --grade: '1.5' is not a whole number"),
        ("--table en-ueb-g2.ctb --language en", r"either --table or those"),
        ("--table en-ueb-g2.ctb --grade 2", r"either --table or those"),
        ("--encoding klingon", r"there is no text encoding 'klingon'; try windows-1252, "),
        ("--encoding rot13", r"there is no text encoding 'rot13'"),
        ("--lines 0", r"argument --lines: '0' is no range: lines count from 1 upwards"),
        ("--lines 0-3", r"lines count from 1"),
        ("--lines 5-3", r"argument --lines: '5-3' is no range: lines count from 1 upwards"),
        ("--lines abc", r"argument --lines: 'abc' is not a range of lines, such as 3-10"),
        ("--lines=-", r"argument --lines: '-' is not a range of lines, such as 3-10"),
        ("--lines 1-2-3", r"'1-2-3' is not a range of lines"),
        ("--lines 1.5", r"'1.5' is not a range of lines"),
        ("--lines=--", r"argument --lines: expected one argument"),
        ("--lines 4", r"text.txt ends at line 3; --lines 4 is past that"),
        ("--lines 9-99", r"text.txt ends at line 3; --lines 9 is past that"),
        ("--model braille", r"argument --model: invalid choice: 'braille' \(choose from"),
        ("--geometry jumbo", r"argument --geometry: invalid choice: 'jumbo'"),
        ("--no-such-option", r"unrecognized arguments: --no-such-option"),
        ("more.txt", r"unrecognized arguments: more.txt"),
    ],
)
@pytest.mark.parametrize("command", COMMANDS)
def test_options_of_the_page(call, text, options, pattern, command):
    assert re.search(pattern, refused(call(*command, text, *options.split(" "))))


@pytest.mark.parametrize(
    ("options", "pattern"),
    [
        ("--model vbd --mapping paired", r"the VBD has one row of actuators; --dot-row chooses"),
        ("--model vbd --texture-cycles 7", r"the texture of the VBD has a fixed wavelength"),
        ("--model vbd --dot-row 4", r"dot row is 4; it must be 1, 2 or 3"),
        ("--dot-row 1", r"the STReSS² shows all dot rows; --mapping chooses how"),
        ("--mapping upside-down", r"argument --mapping: invalid choice: 'upside-down'"),
        ("--texture-cycles 4", r"texture cycles are 4; they must be an odd number, 1 to 11"),
        ("--texture-cycles 13", r"odd number, 1 to 11"),
        ("--texture-cycles 7.0", r"'7.0' is not a whole number"),
        ("--hand glove", r"there is no hand 'glove'; give sweep:SPEED in mm/s, slow, fluent or"),
        ("--hand recorded:", r"there is no hand 'recorded:'"),
        ("--hand sweep:0", r"sweep speed is 0 mm/s; it must be 0.1 to 1000 mm/s"),
        ("--hand sweep:nan", r"sweep speed is nan mm/s; it must be 0.1 to 1000 mm/s"),
        ("--hand sweep:fast", r"sweep speed is 'fast'; it must be a number, 0.1 to 1000 mm/s"),
        ("--hand recorded:/nowhere.csv", r"there is no file /nowhere.csv; check the name"),
        ("--hand recorded:/tmp", r"/tmp is a directory; give a CSV file in it"),
        ("--seed=-1", r"argument --seed: seed is -1; it must be 0 or more"),
        ("--seed one", r"argument --seed: 'one' is not a whole number"),
    ],
)
@pytest.mark.parametrize("command", [("render", "--out", "never.h5"), ("read",)])
def test_options_of_a_showing(call, text, options, pattern, command):
    said = call(*command, text, *options.split(" "))
    assert re.search(pattern, refused(said))
    assert said.err.count("\n") == 1


@pytest.mark.parametrize(
    ("options", "pattern"),
    [
        ("--device netbox", r"there is no device kind 'netbox'; there are .*latero.*sim"),
        ("--device=", r"there is no device kind ''; there are .*sim"),
        (
            "--device serial:x --hand sweep:60",
            r"^--hand is for the simulated device, and serial:x is",
        ),
        (
            "--device serial:x --seed 1",
            r"^--seed is for .*; leave --seed out, or leave --device out",
        ),
        ("--table nosuch.ctb", r"there is no braille table 'nosuch.ctb'; the nearest are "),
        ("--advance slowly", r"argument --advance: invalid choice: 'slowly'"),
        ("--advance key", r"--advance key needs a terminal to type at; leave it out without one"),
        ("--echo loud", r"argument --echo: invalid choice: 'loud'"),
    ],
)
def test_options_of_a_reading(call, text, options, pattern):
    assert re.search(pattern, refused(call("read", text, *options.split(" "))))


@pytest.fixture(scope="module")
def audited():
    """Programs that this process begins, as Python's own audit tells; a hook stays for good."""
    begun = []
    sys.addaudithook(
        lambda event, told: event == "subprocess.Popen" and begun.append(list(map(str, told[1])))
    )
    return begun


@pytest.mark.parametrize(
    ("command", "pattern"),
    [
        ("read {text} --device nosuch", "there is no device kind 'nosuch'"),
        ("read {text} --device nosuch:x", "there is no device kind 'nosuch'"),
        ("read {text}.none", "there is no file"),
        ("read {text} --table nosuch.ctb", "there is no braille table"),
        ("read {text} --language xx", "there is no table for language"),
        ("read {text} --grade 7", "there is no grade 7"),
        ("read {text} --model nosuch", "invalid choice: 'nosuch'"),
        ("feel {text} --device nosuch:x", "there is no device kind 'nosuch'"),
        ("device check nosuch:x", "there is no device kind 'nosuch'"),
        ("device info nosuch:x", "there is no device kind 'nosuch'"),
    ],
)
def test_what_is_not_there_is_refused_before_anything_is_begun_or_compiled(
    call, text, audited, monkeypatch, tmp_path, command, pattern
):
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path / "kernels"))  # which has none yet
    audited.clear()
    assert pattern in refused(call(*command.format(text=text).split()))
    assert audited == []
    assert list(tmp_path.glob("kernels/**/*.nb?")) == []


@pytest.mark.parametrize(
    ("recording", "pattern"),
    [
        (b"", r"hand.csv is empty"),
        (b"t_s,x_mm\n0,1\n0.1,2\n0.9,3\n", r"line 4: nothing was recorded for 0.8 s"),
        (b"t_s,x_mm\n0,1\n0.1,nan\n", r"line 3: x_mm is 'nan'; give a number"),
        (b"t_s,x_mm\n0,1\n0.1,left\n", r"line 3: x_mm is 'left'; give a number"),
        (b"t_s,x_mm\n0,1\n0.1,\n", r"line 3: x_mm is empty"),
        (b"t_s,x_mm\n0.1,1\n0,2\n", r"line 3: t_s is not later"),
        (b"t_s,x_mm\n0,1\n", r"fewer than 2 samples"),
        (b"time,place\n0,1\n", r"t_s"),
        (PNG, r"not UTF-8 text"),
    ],
)
def test_recordings_of_no_use(call, tmp_path, text, recording, pattern):
    hand = tmp_path / "hand.csv"
    hand.write_bytes(recording)
    for command in (("render", "--out", tmp_path / "never.h5"), ("read",)):
        assert re.search(pattern, refused(call(*command, text, "--hand", f"recorded:{hand}")))
    assert not list(tmp_path.glob("*never*"))


def test_places_where_nothing_can_be_written(call, tmp_path, text):
    folder = tmp_path / "folder.h5"
    folder.mkdir()
    (tmp_path / ".busy.h5.partial").mkdir()
    for out, pattern in [
        (folder, r"folder.h5 is a directory; give the name of a file in it"),
        (tmp_path / "no" / "out.h5", r"out.h5 cannot be written: No such file or directory"),
        ("/proc/out.h5", r"/proc/out.h5 cannot be written: No such file or directory"),
        (text / "out.h5", r"out.h5 cannot be written: Not a directory"),
        (tmp_path / f"{'a' * 300}.h5", r"cannot be written: File name too long"),
        (tmp_path / "busy.h5", r"busy.h5 cannot be written: Is a directory"),
        (tmp_path / "out.txt", r"out.txt does not end in .h5; render writes HDF5"),
        ("", r"does not end in .h5"),
    ]:
        assert re.search(pattern, refused(call("render", text, "--out", out)))
    assert list(folder.iterdir()) == []


def test_commands_that_are_none(call):
    assert "the following arguments are required: COMMAND" in refused(call())
    assert "there is no command 'write'" in refused(call("write"))
    assert "the following arguments are required: FILE" in refused(call("page"))
    assert "the following arguments are required: --out" in refused(call("render", "x.txt"))
    assert "unrecognized arguments: --langu fr" in refused(call("tables", "--langu", "fr"))
    assert "argument --language: expected one argument" in refused(call("tables", "--language=--"))


def test_a_table_that_is_there_is_never_refused(call, text):
    """The nearest that a sentence names can be used."""
    said = refused(call("page", text, "--table", "en-ueb-2.ctb"))
    names = said.partition("nearest are ")[2].partition(" (")[0].split(", ")
    assert set(names) <= {table.name for table in list_tables()}
    for name in names:
        assert call("page", text, "--table", name).code == 0
