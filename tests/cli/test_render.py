import hashlib
import json
import resource
import signal
import subprocess

import h5py
import numpy as np
import pytest

from tests.cli.program import VBRAILLE, run
from vbraille import __version__
from vbraille.geometry import Geometry
from vbraille.page import Layout
from vbraille.render import MAPPINGS, MODELS, Tuning, single_row
from vbraille.render.reference import deflections
from vbraille.translate import Book, Document, Table

OPTIONS = {
    "stress2": ("--mapping", "sheared", "--texture", "0.5", "--contrast", "0.8"),
    "vbd": ("--model", "vbd", "--dot-row", "2", "--dot-width", "3"),
}


@pytest.mark.parametrize("name", sorted(OPTIONS))
@pytest.mark.parametrize("hand", ["sweep:80", "fluent", "recorded"])
def test_the_file_is_enough_to_render_it_again(texts, tmp_path, name, hand):
    out = tmp_path / "reading.h5"
    if hand == "recorded":
        path = tmp_path / "hand.csv"
        times = np.arange(0, 12, 0.05)
        places = 150 - 162 * np.cos(times * 2 * np.pi / 5)
        rows = [f"{t:.6f},{x:.6f}" for t, x in zip(times, np.maximum(places, -10.5), strict=True)]
        path.write_text("t_s,x_mm\n" + "\n".join(rows))
        hand = f"recorded:{path}"
    source = texts / "english.txt"
    done = run("render", source, "--out", out, "--lines", "3-4", "--hand", hand, "--rate", "500",
               *OPTIONS[name])  # fmt: skip
    assert done.returncode == 0
    model = MODELS[name]
    with h5py.File(out) as file:
        attributes = dict(file.attrs)
        data = {key: file[key][:] for key in ("t_s", "x_mm", "line", "frames")}
        cells, lengths = file["page/cells"][:], file["page/length"][:]
    assert attributes["first_line"] == 3
    assert attributes["model"] == name
    assert attributes["vbraille_version"] == __version__
    assert attributes["source"] == str(source)
    assert attributes["source_sha256"] == hashlib.sha256(source.read_bytes()).hexdigest()
    assert attributes["rate_hz"] == 500
    np.testing.assert_allclose(attributes["column_offset_mm"], model.array.column_offsets_mm())
    np.testing.assert_allclose(attributes["row_offset_mm"], model.array.row_offsets_mm())
    count = len(data["t_s"])
    assert data["frames"].shape == (count, *model.array.shape)
    assert data["frames"].dtype == np.float32
    np.testing.assert_allclose(data["t_s"], np.arange(count) / 500)
    assert set(data["line"]) == {0, 1}
    assert (np.diff(data["line"]) >= 0).all()
    geometry = Geometry(**json.loads(attributes["geometry"]))
    width = geometry.cells_per_line(model.array.span_mm)
    layout = Layout(Book(Document.from_text(source.read_text()), Table("en-ueb-g2.ctb")), width)
    for row, line in enumerate(layout.lines(3, 4)):
        masks = cells[row, : lengths[row]]
        np.testing.assert_array_equal(masks, line.masks)
        assert not cells[row, lengths[row] :].any()
        here = data["line"] == row
        again = deflections(
            data["x_mm"][here],
            masks,
            array=model.array,
            profile=model.profile,
            mapping=single_row(2) if name == "vbd" else MAPPINGS[attributes["mapping"]],
            geometry=geometry,
            tuning=Tuning(**json.loads(attributes["tuning"])),
        )
        np.testing.assert_allclose(data["frames"][here], again, atol=1e-6)
        assert again.max() > 0.5


def test_progress_in_plain_lines(texts, tmp_path):
    done = run("render", texts / "deutsch.txt", "--language", "de", "--out", tmp_path / "d.h5",
               "--rate", "50", "--plain")  # fmt: skip
    said = [line for line in done.stderr.splitlines() if line.endswith("percent")]
    percents = [int(line.split()[0]) for line in said]
    assert percents == sorted(set(percents))
    assert len(percents) >= 3
    assert "\r" not in done.stderr


def small_disk() -> None:
    """A disk that is full after 300 kB, for the process to come."""
    resource.setrlimit(resource.RLIMIT_FSIZE, (300_000, 300_000))
    signal.signal(signal.SIGXFSZ, signal.SIG_IGN)


def test_a_full_disk_leaves_what_was_there(texts, tmp_path):
    out = tmp_path / "reading.h5"
    out.write_bytes(b"precious")
    done = run("render", texts / "english.txt", "--out", out, preexec_fn=small_disk)
    assert done.returncode == 1
    assert done.stderr.splitlines()[-1].startswith(f"vbraille: {out} could not be written: ")
    assert "Traceback" not in done.stderr
    assert "HDF5" not in done.stderr
    assert out.read_bytes() == b"precious"
    assert list(tmp_path.iterdir()) == [out]


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_an_interrupted_run_leaves_no_file(texts, tmp_path, number):
    with subprocess.Popen(
        [*VBRAILLE, "render", str(texts / "english.txt"), "--out", str(tmp_path / "r.h5"),
         "--plain", "--hand", "device"],
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
    ) as process:  # fmt: skip
        assert process.stderr
        while not process.stderr.readline().endswith("percent\n"):
            pass
        process.send_signal(number)
        rest = process.stderr.read()
        assert process.wait() == 1
    assert rest.splitlines()[-1] == "vbraille: stopped"
    assert "Traceback" not in rest
    assert list(tmp_path.iterdir()) == []
