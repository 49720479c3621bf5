"""Whatever is wrong with what the user gave: one sentence, exit code 2, nothing written."""

import signal
import zipfile

import numpy as np
import pytest

from tests.cli.program import run
from tests.conftest import SEED
from vbraille.cli import main


@pytest.fixture
def call(capsys):
    """The program's main in this process; its exit code, and what it printed."""
    numbers = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGALRM)
    before = {number: signal.getsignal(number) for number in numbers}

    def call(*arguments):
        code = main([str(argument) for argument in arguments])
        return code, *capsys.readouterr()

    yield call
    for number, handler in before.items():
        signal.signal(number, handler)


@pytest.fixture
def files(tmp_path, texts, monkeypatch):
    """A folder of files that are wrong in many ways, and are the names of the cases below."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "good").write_bytes((texts / "english.txt").read_bytes()[:2000])
    (tmp_path / "empty").touch()
    (tmp_path / "blank").write_text(" \n\n \t\n")
    (tmp_path / "directory").mkdir()
    (tmp_path / "image").write_bytes(b"\x89PNG\r\n\x1a\n" + bytes(range(256)))
    with zipfile.ZipFile(tmp_path / "zip", "w") as archive:
        archive.writestr("a", "b")
    (tmp_path / "noise").write_bytes(np.random.default_rng(SEED).bytes(4000))
    (tmp_path / "gap.csv").write_text("t_s,x_mm\n0,0\n0.1,1\n3,2\n")
    (tmp_path / "nan.csv").write_text("t_s,x_mm\n0,0\n0.1,nan\n")
    (tmp_path / "text.csv").write_text("t_s,x_mm\n0,0\n0.1,left\n")
    return tmp_path


CASES = [
    ("page missing", "no file missing"),
    ("page empty", "empty is empty"),
    ("page blank", "blank has no text"),
    ("page directory", "directory is a directory"),
    ("page image", "image is a PNG image"),
    ("page zip", "zip is a zip archive"),
    ("page noise", "noise is binary data"),
    ("page good --table en-ueb-g9.ctb", "the nearest are en-ueb-g"),
    ("page good --language english", "the nearest are"),
    ("page good --language en --grade 7", "there is 1, 2"),
    ("page good --table en-ueb-g2.ctb --grade 2", "give either"),
    ("page good --encoding klingon", "no text encoding"),
    ("page good --lines 0", "'0'"),
    ("page good --lines 5-3", "'5-3'"),
    ("page good --lines some", "'some'"),
    ("page good --lines 999", "ends at line"),
    ("page good --travel 5", "must be at least 17.1 mm"),
    ("page good --travel nan", "1 to 10000 mm"),
    ("page good --dot-width -1", "0.1 to 20 mm"),
    ("page good --dot-width 15", "at most the cell pitch"),
    ("page good --dot-spacing inf", "0.1 to 50 mm"),
    ("page good --cell-gap wide", "'wide' is not a number"),
    ("page good --line-pitch 0", "1 to 500 mm"),
    ("page good --format pdf", "invalid choice"),
    ("page good --nonsense", "unrecognized arguments"),
    ("page", "required: FILE"),
    ("dance", "invalid choice"),
    ("", "required: COMMAND"),
    ("tables --language klingon", "the nearest are"),
    ("read good --texture 1.5", "texture is 1.5; it must be 0 to 1"),
    ("read good --contrast nan", "contrast is nan; it must be 0 to 1"),
    ("read good --texture-cycles 4", "odd number"),
    ("read good --model vbd --mapping paired", "--dot-row"),
    ("read good --model vbd --dot-row 4", "1, 2 or 3"),
    ("read good --dot-row 1", "--mapping"),
    ("read good --mapping twisted", "invalid choice"),
    ("read good --rate 0", "1 to 10000 Hz"),
    ("read good --hand walk", "sweep:SPEED"),
    ("read good --hand sweep:-3", "0.1 to 1000 mm/s"),
    ("read good --hand sweep:fast", "0.1 to 1000 mm/s"),
    ("read good --hand recorded:missing.csv", "missing.csv"),
    ("read good --hand recorded:gap.csv", "gap.csv"),
    ("read good --hand recorded:nan.csv", "nan.csv"),
    ("read good --hand recorded:text.csv", "text.csv"),
    ("read good --device lamp:1", "there is sim"),
    ("read good --advance key", "needs a terminal"),
    ("render good", "required: --out"),
    ("render good --out directory", "does not end in .h5"),
    ("render good --out no/where.h5", "no/where.h5 cannot be written"),
    ("render empty --out a.h5", "empty is empty"),
    ("plot", "required: KIND"),
    ("plot wave", "--out F.png or F.svg"),
    ("plot wave --out a.pdf", ".png"),
    ("plot wave --out no/where.png", "no/where.png"),
    ("plot page --csv", "needs a text"),
    ("plot wave good --csv", "takes no text"),
    ("plot page good --csv --at nan", "--at"),
    ("plot mapping --csv --letter internationalisation", "1 to 4"),
    ("plot strain --csv --model stress2", "VBD"),
]


@pytest.mark.parametrize(("line", "said"), CASES)
def test_one_sentence_and_exit_code_2(call, files, line, said):
    there = sorted(path.name for path in files.iterdir())
    code, out, err = call(*line.split())
    assert code == 2
    assert out == ""
    *before, sentence = err.splitlines()
    assert sentence.startswith("vbraille: ")
    assert said in sentence
    assert all(line.startswith("line width: ") for line in before)
    assert sorted(path.name for path in files.iterdir()) == there


def test_a_file_that_cannot_be_read(call):
    code, _, err = call("page", "/proc/self/mem")
    assert code == 2
    assert err.startswith("vbraille: /proc/self/mem ")


def test_the_same_from_a_process_of_its_own(files):
    done = run("page", files / "image")
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr.startswith(f"vbraille: {files / 'image'} is a PNG image")


def test_any_bytes_are_paged_or_refused(call, tmp_path):
    random = np.random.default_rng(SEED)
    path = tmp_path / "bytes"
    pieces = [
        b"word ",
        b"\n\n",
        b"\x00",
        b"\xff\xfe",
        "é€😀".encode(),
        b"\r\n",
        b"\x1b[2J",
        b"\xad",
    ]
    codes = set()
    for _ in range(1000):
        chosen = random.integers(0, len(pieces) + 1, random.integers(0, 40))
        path.write_bytes(
            b"".join(random.bytes(3) if n == len(pieces) else pieces[n] for n in chosen)
        )
        code, out, err = call("page", path, "--format", random.choice(["unicode", "text", "dots"]))
        codes.add(code)
        assert code in (0, 2), err
        assert "vbraille's own" not in err
        assert "\x1b" not in out + err
    assert codes == {0, 2}


def test_any_options_are_taken_or_refused(call, files):
    random = np.random.default_rng(SEED)
    values = ["0", "1", "-1", "nan", "inf", "1e308", "1e-320", "3.7", "", "x", "7", "é", "2-", "-"]
    options = ["--dot-width", "--dot-spacing", "--cell-gap", "--travel", "--lines", "--grade",
               "--line-pitch", "--language", "--table", "--encoding", "--model"]  # fmt: skip
    for _ in range(1000):
        chosen = [
            f"{option}={random.choice(values)}" for option in random.choice(options, 2, False)
        ]
        code, _, err = call("page", files / "good", "--lines=1", *chosen)
        assert code in (0, 2), (chosen, err)
