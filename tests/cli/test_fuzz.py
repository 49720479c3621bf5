"""Arbitrary files and options, by the tier: every run ends with a code of its own."""

import encodings.aliases
import re
import time

import numpy as np
import pytest

from tests.conftest import SEED
from tests.tiers import by_tier
from vbraille.translate import list_tables

# Coverage would double their time, and others cover what these do.
pytestmark = pytest.mark.no_cover

PARTS = range(by_tier(1, 4, 200))
PATIENCE_S = 10.0
CONTROLS = re.compile(r"[\x00-\x09\x0b-\x1f\x7f-\x9f]")
MARKS = [b"\xff\xfe", b"\xfe\xff", b"\xef\xbb\xbf", b"\xff\xfe\0\0", b"\0\0\xfe\xff"]


@pytest.fixture(params=PARTS)
def rng(request):
    """Random numbers of a part of the tests, the same in every run."""
    return np.random.default_rng([SEED, request.param])


def check(call, *arguments):
    """Run, and see that it ended as it should."""
    begun = time.monotonic()
    said = call(*arguments)
    what = f"{arguments}: {said}"
    assert said.code in (0, 2), what  # 1 would be a fault
    assert time.monotonic() - begun < PATIENCE_S, what
    for printed in (said.out, said.err):
        assert not CONTROLS.search(printed), what
        assert printed[-1:] in ("", "\n"), what
    refusals = [line for line in said.err.split("\n") if line.startswith("vbraille: ")]
    assert len(refusals) == (said.code == 2), what
    if said.code == 2:
        assert said.err.split("\n")[-2] == refusals[0], what
        assert said.out == "" or "--format unicode" in refusals[0], what
    return said


def pick(rng, choices):
    return choices[rng.integers(len(choices))]


def characters(rng, size):
    """Any characters, lone surrogates among them; most from where they are likely."""
    blocks = [
        (0x20, 0x7F), (0x20, 0x7F), (0x00, 0x20), (0x80, 0x180), (0x300, 0x340), (0x2000, 0x2070),
        (0x2800, 0x2900), (0x4E00, 0x9FFF), (0xD800, 0xE000), (0x10000, 0x110000),
    ]  # fmt: skip
    return "".join(chr(rng.integers(*pick(rng, blocks))) for _ in range(size))


def content(rng):
    """Bytes of a file: noise, text in some encoding with or without damage, few kinds of bytes."""
    size = int(pick(rng, [0, 1, 2, 3, 5, 20, 100, 300]))
    kind = rng.integers(5)
    if kind == 0:
        return rng.bytes(size)
    if kind == 1:
        return pick(rng, MARKS) + rng.bytes(size)
    if kind == 2:
        return bytes(pick(rng, b"ab \n\r\t-.\x0c\x1b\xad\xa0\x85\0") for _ in range(size))
    encoding = pick(rng, ["utf-8", "utf-8", "utf-16", "utf-32", "utf-16-be"])
    written = bytearray(characters(rng, size).encode(encoding, "surrogatepass"))
    if kind == 3 and written:
        for place in rng.integers(len(written), size=rng.integers(1, 4)):
            written[place] = rng.integers(256)
    return bytes(written)


ENCODINGS = sorted({*encodings.aliases.aliases.values(), "undefined", "idna", "utf_8_sig", "x"})


def test_any_bytes_as_a_text(call, text, rng):
    read = 0
    for _ in range(100):
        text.write_bytes(content(rng))
        options = ["--format", pick(rng, ["text", "unicode", "brf", "dots"])]
        if rng.random() < 0.4:
            options += ["--encoding", pick(rng, ENCODINGS)]
        if rng.random() < 0.3:
            options += ["--keep-lines"]
        if rng.random() < 0.3:
            options += ["--travel", pick(rng, ["18", "40", "10000"])]
        read += check(call, "page", text, *options).code == 0
    assert 20 < read < 100


# Of each option some values that can be used.
USABLE = {
    "--table": ["en-ueb-g1.ctb", "fr-bfu-comp8.utb", "de-g1.ctb"],
    "--language": ["fr", "de", "en-GB"],
    "--grade": ["1", "2"],
    "--encoding": ["latin-1", "utf-16"],
    "--lines": ["1", "1-2", "2-", "-2"],
    "--model": ["vbd", "stress2"],
    "--geometry": ["vbd", "standard"],
    "--dot-width": ["2.5", "11"],
    "--dot-spacing": ["3", "0.1"],
    "--cell-gap": ["3", "50"],
    "--line-pitch": ["10"],
    "--travel": ["30", "300"],
    "--format": ["brf", "dots", "text"],
    "--texture": ["0.5", "0"],
    "--contrast": ["0.3", "1e-9"],
    "--texture-cycles": ["5", "11"],
    "--mapping": ["sheared", "compact"],
    "--dot-row": ["2"],
    "--seed": ["3"],
    "--rate": ["200", "9999.5"],
    "--device": ["sim"],
    "--advance": ["return"],
    "--echo": ["none", "both"],
}
ODD = [
    "", " ", "0", "1", "-1", "+1", "0.5", "1e-309", "1e309", "nan", "-inf", "1_0", "٣", "0x10",
    "1,5", "9" * 18, "9" * 19, "9" * 400, "x", "é", "\udcff", "\x1b[2J", "\n", "%s", "%(prog)s",
    "{0}", "--", "-", "-h", "--help", "1-2", "3-1", "-3", "3-", "0-1", "en", "a" * 50, "/", "..",
    "~", ",", "en-", "en-ueb-g2.ctb,", "sim:", ":", "sweep:", "recorded:", "recorded:.", "none",
    "stress2",
]  # fmt: skip
OF_A_PAGE = list(USABLE)[:12]
OF_A_SHOWING = list(USABLE)[13:20]
OPTIONS = {
    "page": [*OF_A_PAGE, "--format"],
    "render": [*OF_A_PAGE, *OF_A_SHOWING],
    "read": [*OF_A_PAGE, *OF_A_SHOWING, "--device", "--advance", "--echo"],
    "tables": ["--language"],
}


# A reading starts a process: some are enough.
COMMANDS = [*["page"] * 9, *["render"] * 6, *["tables"] * 3, "read"]


def test_any_values_of_options(call, tmp_path, text, rng):
    text.write_text("one two\n\nthree\n")
    hand = tmp_path / "hand.csv"
    hand.write_text("0,-10\n0.005,5\n")  # a reading that takes no time
    done = 0
    for _ in range(80):
        command = pick(rng, COMMANDS)
        arguments = [command]
        if command != "tables":
            arguments += [text if rng.random() < 0.95 else pick(rng, ODD)]
        if command in ("render", "read"):
            arguments += ["--hand", f"recorded:{hand}" if rng.random() < 0.9 else pick(rng, ODD)]
        if command == "render":
            arguments += ["--out", tmp_path / "out.h5"]
        for _ in range(rng.integers(1, 4)):
            option = pick(rng, OPTIONS[command])
            usable = rng.random() < 0.7 and option in USABLE
            value = pick(rng, USABLE[option] if usable else ODD)
            arguments += [option, value] if rng.random() < 0.5 else [f"{option}={value}"]
        done += check(call, *arguments).code == 0
    assert 20 < done < 75
    assert {path.name for path in tmp_path.iterdir()} <= {"text.txt", "hand.csv", "out.h5"}


FIELDS = ["0", "1", "0.1", "0.2", "0.3", "-5", "1e9", "nan", "", "x", '"', "\0", "\r", "é", " 2 "]


def test_any_bytes_as_a_recorded_hand(call, tmp_path, text, rng):
    hand = tmp_path / "hand.csv"
    for _ in range(60):
        rows = [
            ",".join(pick(rng, FIELDS) for _ in range(pick(rng, [1, 2, 2, 2, 3])))
            for _ in range(rng.integers(6))
        ]
        head = pick(rng, ["", "t_s,x_mm\n", "x_mm,t_s\n"])
        written = content(rng) if rng.random() < 0.3 else (head + "\n".join(rows)).encode()
        hand.write_bytes(written)
        out = tmp_path / "out.h5"
        said = check(call, "render", text, "--out", out, "--hand", f"recorded:{hand}")
        assert out.exists() == (said.code == 0)
        out.unlink(missing_ok=True)


def test_every_table_writes_any_text(call, text, rng):
    """Some of the tables each; what a table does not know it spells."""
    text.write_text(characters(rng, 30), "utf-8", "surrogatepass")
    for table in list_tables()[rng.integers(32) :: 32]:
        said = check(call, "page", text, "--table", table.name)
        assert said.code == 0
        assert said.out.strip("\n")
