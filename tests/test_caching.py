"""A user whose home and whose vbraille cannot be written."""

import os
import shutil
import stat
import subprocess
import sys
from pathlib import Path

import h5py
import pytest

import vbraille
from tests.cli import program
from tests.tiers import heavy

# Not even root can make anything here.
NOWHERE = "/proc/none"
VBRAILLE = ("-m", "vbraille")


@pytest.fixture
def sealed(tmp_path):
    """A copy of the program beside which nothing can be kept, not even by root."""
    package = Path(vbraille.__file__).parent
    shutil.copytree(
        package, tmp_path / "sealed/vbraille", ignore=shutil.ignore_patterns("__pycache__")
    )
    copied = tmp_path / "sealed/vbraille"
    for folder in [copied, *copied.rglob("*")]:
        if folder.is_dir():
            (folder / "__pycache__").touch()
    return tmp_path / "sealed"


def run(sealed, temporary, *arguments):
    """Run Python with the sealed program and no home; only `temporary` can be written."""
    hidden = ("NUMBA_CACHE_DIR", "MPLCONFIGDIR", "PYTHONPATH", "TMPDIR")
    kept = {name: value for name, value in os.environ.items() if name not in hidden}
    homeless = dict.fromkeys(("HOME", "XDG_CACHE_HOME", "XDG_CONFIG_HOME"), NOWHERE)
    return subprocess.run(
        [sys.executable, *arguments],
        env={**kept, **homeless, "PYTHONPATH": str(sealed), "TMPDIR": str(temporary)},
        cwd=temporary,
        stdin=subprocess.DEVNULL,
        capture_output=True,
        encoding="utf-8",
        check=False,
        timeout=120,
    )


@heavy  # kernels are compiled anew
def test_without_a_home_kernels_are_kept_in_a_private_temporary_folder(sealed, tmp_path):
    (tmp_path / "text.txt").write_text("one two three\n")
    done = run(sealed, tmp_path, *VBRAILLE, "render", "text.txt", "--out", "frames.h5")
    assert (done.returncode, done.stderr) == (0, program.line_width(26))
    with h5py.File(tmp_path / "frames.h5") as file:
        assert file["frames"][:].max() == 1
    private = tmp_path / f"vbraille-{os.getuid()}"
    assert stat.S_IMODE(private.stat().st_mode) == 0o700
    assert list(private.rglob("*.nbc"))


def test_without_a_home_pictures_are_drawn_and_nothing_is_said_of_it(sealed, tmp_path):
    done = run(sealed, tmp_path, *VBRAILLE, "plot", "deflection", "--out", "profile.svg")
    assert (done.returncode, done.stderr) == (0, "")
    assert (tmp_path / "profile.svg").stat().st_size > 1000


def test_a_folder_that_others_can_write_is_not_trusted_with_code(sealed, tmp_path):
    private = tmp_path / f"vbraille-{os.getuid()}"
    private.mkdir()
    private.chmod(0o777)
    asked = "from vbraille.caching import keep_compiled; print(keep_compiled())"
    assert run(sealed, tmp_path, "-c", asked).stdout == "False\n"
    private.chmod(0o700)
    assert run(sealed, tmp_path, "-c", asked).stdout == "True\n"
    if os.geteuid() == 0:  # another user has made it
        os.chown(private, 65534, 65534)
        assert run(sealed, tmp_path, "-c", asked).stdout == "False\n"


def test_a_first_reading_says_that_it_compiles(tmp_path):
    said = "from vbraille.caching import compiling_note as note; print(note())"
    command = [sys.executable, "-c", said]
    environment = {**os.environ, "NUMBA_CACHE_DIR": str(tmp_path)}
    first = subprocess.run(command, env=environment, capture_output=True, text=True, check=True)
    assert first.stdout.startswith("compiling ")
    assert list(tmp_path.iterdir()) == []  # nothing is compiled by asking
    compiled = "from vbraille.caching import _compiled_folder as f; print(f())"
    folder = subprocess.run(
        [sys.executable, "-c", compiled],
        env=environment,
        capture_output=True,
        text=True,
        check=True,
    ).stdout.strip()
    (Path(folder) / "engine").mkdir(parents=True)
    (Path(folder) / "engine" / "tick.run-1.nbc").touch()
    again = subprocess.run(command, env=environment, capture_output=True, text=True, check=True)
    assert again.stdout == "None\n"
