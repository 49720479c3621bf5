"""Bad input: one sentence that names it, exit code 2, and nothing printed or written."""

import io
import sys
import zipfile

import pytest

PNG = b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\0\1\0\0\0\1\x08\6\0\0\0\x1f\x15\xc4\x89"
COMMANDS = [("page",), ("render", "--out", "never.h5"), ("read",)]


def zipped():
    archive = io.BytesIO()
    with zipfile.ZipFile(archive, "w") as written:
        written.writestr("text.txt", "one two three")
    return archive.getvalue()


def refused(said, *, code=2):
    """The sentence, without who says it."""
    assert said.code == code, said.err
    assert said.out == ""
    *before, sentence = said.err.split("\n")[:-1]
    assert not [line for line in before if not line.startswith("line width: ")]
    assert sentence.startswith("vbraille: ")
    assert "internal error" not in sentence
    assert sentence.isprintable()
    return sentence


@pytest.mark.parametrize(
    ("content", "named"),
    [
        (b"", "empty"),
        (b" \n\n\t \n", "no text"),
        (PNG, "PNG"),
        (zipped(), "zip"),
        (bytes(range(256)) * 16, "binary"),
    ],
    ids=["empty", "blank", "image", "archive", "binary"],
)
@pytest.mark.parametrize("command", COMMANDS[:2])
def test_files_that_are_no_text(call, text, content, named, command):
    text.write_bytes(content)
    assert named in refused(call(*command, text))


@pytest.mark.parametrize("command", COMMANDS)
def test_files_that_cannot_be_read(call, tmp_path, command):
    missing, loop = tmp_path / "none.txt", tmp_path / "loop.txt"
    loop.symlink_to(loop)
    for path in (missing, tmp_path, loop, "/proc/self/mem"):
        assert str(path) in refused(call(*command, path))


def test_a_control_character_in_a_name_is_named(call):
    assert "no<escape>[2J<bell>" in refused(call("page", "no\x1b[2J\x07"))
    assert "\\udcff" in refused(call("page", "no\udcff"))


@pytest.mark.parametrize(
    ("options", "named"),
    [
        ("--travel 12", "travel"),
        ("--dot-width 15", "dot width"),
        ("--table nosuch.ctb", "nosuch.ctb"),
        ("--table /etc/passwd", "/etc/passwd"),
        ("--language xx", "'xx'"),
        ("--grade 7", "grade 7"),
        ("--table en-ueb-g2.ctb --language en", "table"),
        ("--encoding klingon", "klingon"),
        ("--lines 4", "--lines 4"),
        ("--lines 9-99", "--lines 9"),
        ("--model vbd --mapping paired", "--dot-row"),
        ("--model vbd --texture-cycles 7", "texture"),
        ("--dot-row 1", "--mapping"),
        ("--mapping upside-down", "upside-down"),
        ("--texture-cycles 4", "odd"),
        ("--geometry jumbo", "jumbo"),
        ("--hand glove", "glove"),
        ("--hand sweep:0", "sweep"),
        ("--hand sweep:nan", "sweep"),
        ("--hand recorded:/nowhere.csv", "/nowhere.csv"),
    ],
)
def test_options_that_do_not_go_together_or_are_of_no_use(call, text, tmp_path, options, named):
    out = tmp_path / "never.h5"
    assert named in refused(call("render", text, "--out", out, *options.split()))
    assert not out.exists()


@pytest.fixture(scope="module")
def audited():
    """Programs that this process begins, as Python's own audit tells; a hook stays for good."""
    begun = []
    sys.addaudithook(
        lambda event, told: event == "subprocess.Popen" and begun.append(list(map(str, told[1])))
    )
    return begun


@pytest.mark.parametrize(
    ("command", "named"),
    [
        ("read {text} --device nosuch:x", "nosuch"),
        ("device check nosuch:x", "nosuch"),
        ("read {text} --model nosuch", "nosuch"),
    ],
)
def test_what_is_not_there_is_refused_before_anything_is_begun_or_compiled(
    call, text, audited, monkeypatch, tmp_path, command, named
):
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path / "kernels"))  # which has none yet
    audited.clear()
    assert named in refused(call(*command.format(text=text).split()))
    assert audited == []
    assert list(tmp_path.glob("kernels/**/*.nb?")) == []


@pytest.mark.parametrize(
    ("recording", "named"),
    [
        (b"", "empty"),
        (b"t_s,x_mm\n0,1\n0.1,2\n0.9,3\n", "line 4"),
        (b"t_s,x_mm\n0,1\n0.1,nan\n", "line 3"),
        (b"t_s,x_mm\n0,1\n0.1,left\n", "line 3"),
        (b"t_s,x_mm\n0.1,1\n0,2\n", "line 3"),
        (b"t_s,x_mm\n0,1\n", "2 samples"),
        (b"time,place\n0,1\n", "t_s"),
        (PNG, "hand.csv"),
    ],
)
def test_recordings_of_no_use(call, tmp_path, text, recording, named):
    hand = tmp_path / "hand.csv"
    hand.write_bytes(recording)
    out = tmp_path / "never.h5"
    assert named in refused(call("render", text, "--out", out, "--hand", f"recorded:{hand}"))
    assert not out.exists()


def test_places_where_nothing_can_be_written(call, tmp_path, text):
    folder = tmp_path / "folder.h5"
    folder.mkdir()
    (tmp_path / ".busy.h5.partial").mkdir()
    for out in (
        folder, "/proc/out.h5",
        tmp_path / f"{'a' * 300}.h5", tmp_path / "busy.h5", tmp_path / "out.txt", "",
    ):  # fmt: skip
        assert str(out) in refused(call("render", text, "--out", out))
    for parent in (tmp_path / "no", text):
        assert f"{parent};" in refused(call("render", text, "--out", parent / "out.h5"))
    assert list(folder.iterdir()) == []
