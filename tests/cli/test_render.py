"""``vbraille render``: what the file holds, and what is left when it is not finished."""

import hashlib
import json
import signal
import subprocess
import time

import h5py
import numpy as np
import pytest

from tests.cli import program
from tests.render.braille.reference import deflections
from tests.render.reader import read_back
from tests.tiers import by_tier, heavy
from vbraille import __version__
from vbraille.braille.geometry import PRESETS, Geometry
from vbraille.layout import Layout
from vbraille.recording import print_in
from vbraille.render import MAPPINGS, MODELS, BrailleStyle, Tuning, single_row
from vbraille.translate import Book, BrailleTable, open_source
from vbraille.wording import count

RECORDED = "t_s,x_mm\n" + "".join(f"{t / 10},{x}\n" for t, x in enumerate((-9, 40, 155, 20, -11)))


def from_the_file_alone(file):
    """Frames of a file once more, by the kernels and by their twin."""
    attributes = file.attrs
    model = MODELS[attributes["model"]]
    name = attributes["mapping"]
    style = BrailleStyle(
        model.style.profile,
        MAPPINGS[name] if name in MAPPINGS else single_row(int(name[-1])),
        Geometry(**json.loads(attributes["geometry"])),
        Tuning(**json.loads(attributes["tuning"])),
    )
    np.testing.assert_array_equal(attributes["column_offset_mm"], model.display.column_offsets_mm())
    np.testing.assert_array_equal(attributes["row_offset_mm"], model.display.row_offsets_mm())
    cells, length = file["page/cells"][:], file["page/length"][:]
    x_mm, line = file["x_mm"][:], file["line"][:]
    again = np.empty(file["frames"].shape, np.float32)
    plain = np.empty(again.shape)
    for row in range(len(cells)):
        here = line == row
        masks = cells[row, : length[row]]
        again[here] = style.render(masks, model.display).path(x_mm[here])
        plain[here] = deflections(x_mm[here], masks, style, model.display)
    return again, plain


@pytest.mark.parametrize(
    ("options", "model", "rate", "first", "last"),
    [
        ("--hand sweep:1000 --lines 2-3", "stress2", 1000, 2, 3),
        ("--model vbd --dot-row 2 --texture 0.5 --rate 333 --hand sweep:90", "vbd", 333, 1, 293),
        ("--hand fluent --seed 5 --lines 4 --mapping sheared --contrast 0.6 --texture-cycles 5",
         "stress2", 1000, 4, 4),
        ("--hand device --rate 100 --lines 1-2 --geometry standard --travel 60 --mapping paired",
         "stress2", 100, 1, 2),
        ("--hand recorded:{} --lines 1-2 --rate 2000 --dot-width 6", "stress2", 2000, 1, 1),
    ],
)  # fmt: skip
def test_the_file_holds_all_that_was_rendered(
    call, tmp_path, texts, options, model, rate, first, last
):
    source, out = texts / "english.txt", tmp_path / "out.h5"
    if model == "vbd":  # all of a text, a small one
        source, last = tmp_path / "text.txt", 2
        source.write_text("one\n\ntwo\n")
    recorded = tmp_path / "hand.csv"
    recorded.write_text(RECORDED)
    said = call("render", source, "--out", out, *options.format(recorded).split())
    assert said.code == 0
    assert not list(tmp_path.glob(".*"))
    with h5py.File(out) as file:
        t_s, x_mm, line, frames = (file[name][:] for name in ("t_s", "x_mm", "line", "frames"))
        assert file.attrs["model"] == model
        assert file.attrs["rate_hz"] == rate
        assert file.attrs["first_line"] == first
        assert file.attrs["vbraille_version"] == __version__
        assert file.attrs["source"] == str(source)
        assert file.attrs["source_sha256"] == hashlib.sha256(source.read_bytes()).hexdigest()

        array = MODELS[model].display
        assert frames.dtype == np.float32
        assert frames.shape == (t_s.size, array.rows, array.columns)
        assert t_s.shape == x_mm.shape == line.shape == file["part"].shape
        assert file.attrs["format"] == 3
        assert not file["part"][:].any()
        pitch_mm = json.loads(file.attrs["geometry"])["line_pitch_mm"]
        assert set(file["y_mm"][:]) == {pitch_mm / 2}
        assert not file["theta_rad"][:].any()
        np.testing.assert_allclose(t_s, np.arange(t_s.size) / rate, rtol=0, atol=1e-9)

        cells, length = file["page/cells"][:], file["page/length"][:]
        assert cells.dtype == np.uint8
        layout = Layout(
            Book(open_source(str(source)), BrailleTable("en-ueb-g2.ctb")), cells.shape[1]
        )
        masks = [wanted.masks for wanted in layout.lines(first, last)]
        for row, wanted in enumerate(layout.lines(first, last)):
            assert print_in(file, row, wanted.masks.size).text == wanted.text
        assert length.tolist() == [m.size for m in masks]
        for row, wanted in enumerate(masks):
            assert cells[row, : length[row]].tolist() == wanted.tolist()
            assert not cells[row, length[row] :].any()
        assert set(np.unique(line)) == set(range(len(masks)))
        assert (np.diff(line) >= 0).all()
        geometry = Geometry(**json.loads(file.attrs["geometry"]))
        if "recorded" not in options:
            for row in range(len(masks)):  # each line from the left stop to its end and back
                there = x_mm[line == row]
                home_mm = -array.span_mm / 2
                assert there[0] == pytest.approx(home_mm)
                assert there[-1] < home_mm + 250 / rate
                end_mm = geometry.extent_mm(length[row]) + array.span_mm / 2
                assert end_mm - 1000 / rate < there.max() < end_mm + 1e-9
        assert frames.max() > 0.5
        again, plain = from_the_file_alone(file)
    np.testing.assert_array_equal(frames, again)
    np.testing.assert_allclose(frames, plain, rtol=0, atol=1e-6)
    lines, seconds = count(len(masks), "line"), f"{t_s.size / rate:.1f} s"
    assert said.out == f"rendered: {lines}, {t_s.size} frames, {seconds} of reading\n"


def test_options_are_in_the_file(call, tmp_path, text):
    out = tmp_path / "out.h5"
    options = "--geometry vbd --dot-width 2.5 --dot-spacing 4.5 --cell-gap 6 --line-pitch 15"
    more = "--travel 222 --texture 0.25 --contrast 0.75 --texture-cycles 3 --mapping compact"
    said = call("render", text, "--out", out, "--hand=sweep:1000", *options.split(), *more.split())
    assert said.code == 0
    with h5py.File(out) as file:
        row_spacing_mm = PRESETS["vbd"].row_spacing_mm
        assert Geometry(**json.loads(file.attrs["geometry"])) == Geometry(
            2.5, 4.5, 6.0, row_spacing_mm, 15.0, 222.0
        )
        assert Tuning(**json.loads(file.attrs["tuning"])) == Tuning(0.25, 0.75, 3)
        assert file.attrs["mapping"] == "compact"


def test_a_hand_s_chances_come_from_the_seed(call, tmp_path, text):
    def places(seed):
        out = tmp_path / "out.h5"
        options = ("--out", out, "--force", "--hand=fluent", "--lines=1", "--rate=100")
        assert call("render", text, *options, "--seed", seed).code == 0
        with h5py.File(out) as file:
            return file["x_mm"][:].tolist()

    assert places(3) == places(3)
    assert places(3) != places(4)


@pytest.fixture
def old(call, tmp_path, text):
    """A file from an earlier run, as bytes, where the next is to be."""
    out = tmp_path / "out.h5"
    assert call("render", text, "--out", out, "--hand", "sweep:1000").code == 0
    return out, out.read_bytes()


def test_a_file_that_is_there_is_replaced_only_if_told_so(old, call, text):
    out, before = old
    said = call("render", text, "--out", out, "--lines", "2")
    assert (said.code, said.out) == (2, "")
    wanted = f"vbraille: {out} already exists; choose another name, or add --force"
    assert said.err.splitlines()[-1] == wanted
    assert out.read_bytes() == before
    assert call("render", text, "--out", out, "--lines", "2", "--force").code == 0
    assert out.read_bytes() != before


def test_frames_are_compressed_and_read_back_the_same(call, tmp_path, text):
    out = tmp_path / "out.h5"
    options = ("--hand", "sweep:60", "--texture", "0.5", "--lines", "1")
    assert call("render", text, "--out", out, *options).code == 0
    with h5py.File(out) as file:
        grown = [file[name] for name in ("t_s", "x_mm", "line", "frames", "page/cells")]
        assert {dataset.compression for dataset in grown} == {"gzip"}
        assert out.stat().st_size < 0.2 * sum(dataset.nbytes for dataset in grown)
        again, _ = from_the_file_alone(file)
        np.testing.assert_array_equal(file["frames"][:], again)


def files_in(folder):
    return sorted(path.name for path in folder.iterdir() if path.suffix != ".txt")


def test_a_full_disk_leaves_the_old_file_and_no_part_of_the_new(old, tmp_path, text):
    out, before = old
    # At the last writing, and at the first.
    for size in (len(before) - 1, 4096)[: by_tier(1, 2, 2)]:
        blocks = size // 512
        # Python would write a part of what it has compiled of a module, and fail ever after.
        limited = f'export PYTHONDONTWRITEBYTECODE=1; ulimit -f {blocks}; exec "$@"'
        done = subprocess.run(
            ["sh", "-c", limited, "sh", *program.PROGRAM, "render", text, "--out", out,
             "--force", "--hand", "sweep:1000"],
            capture_output=True, check=False, encoding="utf-8", timeout=program.PATIENCE_S,
        )  # fmt: skip
        assert done.returncode == 1
        *_, sentence = done.stderr.splitlines()
        assert sentence == f"vbraille: {out} could not be written: File too large"
        assert "Traceback" not in done.stderr
        assert done.stdout == ""
        assert files_in(tmp_path) == ["out.h5"]
        assert out.read_bytes() == before


def half_done(texts, out):
    """Start a long run, and wait until a part of it is written."""
    options = "--force --hand sweep:1000 --model vbd --rate 10000 --dot-width 2"
    process = program.start("render", texts / "english.txt", "--out", out, *options.split())
    partial = out.with_name(f".{out.name}.partial")
    end = time.monotonic() + program.PATIENCE_S
    while not (partial.exists() and partial.stat().st_size > 100_000):
        assert process.poll() is None, process.stderr.read()
        assert time.monotonic() < end
        time.sleep(0.01)
    process.stderr.readline()  # the width
    return process


@pytest.mark.parametrize(
    "signals",
    [
        (signal.SIGINT, signal.SIGINT),
        # One handler takes all signals; another test has SIGTERM.
        pytest.param((signal.SIGHUP,), marks=heavy),
    ],
)
def test_a_signal_leaves_the_old_file_and_no_part_of_the_new(old, texts, tmp_path, signals):
    out, before = old
    with half_done(texts, out) as process:
        assert files_in(tmp_path) == [".out.h5.partial", "out.h5"]
        for number in signals:
            process.send_signal(number)
        assert is_stopped(process)
    assert files_in(tmp_path) == ["out.h5"]
    assert out.read_bytes() == before


def is_stopped(process):
    said = process.stderr.read().decode()
    return (
        process.wait(program.PATIENCE_S) == 1
        and process.stdout.read() == b""
        and [s for s in said.splitlines() if "percent" not in s] == ["vbraille: stopped"]
    )


def test_a_killed_run_leaves_the_old_file_and_the_next_run_cleans_up(old, call, texts, tmp_path):
    out, before = old
    with half_done(texts, out) as process:
        process.kill()
    assert out.read_bytes() == before
    assert files_in(tmp_path) == [".out.h5.partial", "out.h5"]
    assert (
        call("render", tmp_path / "text.txt", "--out", out, "--force", "--hand=sweep:1000").code
        == 0
    )
    assert files_in(tmp_path) == ["out.h5"]
    assert out.read_bytes() == before  # the same run as before


def test_a_page_is_rendered_without_a_next_line(call, tmp_path):
    out = tmp_path / "page.h5"
    said = call(
        "render", "texts/english.txt", "--out", out, "--height", "42", "--lines", "1-5",
        "--hand", "sweep:400", "--texture", "0",
    )  # fmt: skip
    assert (said.code, said.out.split(",")[0]) == (0, "rendered: 5 lines")
    model = MODELS["stress2"]
    with h5py.File(out) as file:
        line, part, y_mm = file["line"][:], file["part"][:], file["y_mm"][:]
        # Three lines to a page; each is read along its middle.
        assert set(line) == {0, 1, 2, 3, 4}
        on = np.abs(y_mm / 14 % 1 - 0.5) < 1e-9
        np.testing.assert_array_equal(part[on], np.floor(y_mm[on] / 14))
        for row in range(5):
            here = on & (line == row)
            masks = file["page/cells"][row][: file["page/length"][row]]
            masks = np.append(masks, np.zeros(26, np.uint8))
            x_mm, frames = file["x_mm"][here], file["frames"][here]
            style, array = model.style, model.display
            read = read_back(
                frames, x_mm, array=array, mapping=style.mapping, geometry=style.geometry
            )
            np.testing.assert_array_equal(read, masks[: read.size])
            assert read.any()


@pytest.mark.parametrize("height", ["6", "20000", "nan"])
def test_a_height_that_no_page_has_is_refused(call, tmp_path, height):
    out = tmp_path / "page.h5"
    said = call("render", "texts/english.txt", "--out", out, "--height", height)
    assert (said.code, said.out, out.exists()) == (2, "", False)
    assert "height" in said.err
