"""The wheel, installed where there is no checkout."""

import os
import shutil
import subprocess
import sys
import sysconfig
import venv
import zipfile
from pathlib import Path

import louis
import pytest

from tests.tiers import by_tier, heavy

ROOT = Path(__file__).parents[1]
LIGHT = [
    "--version",
    "page story.txt --format unicode",
    "structure story.txt",
    "session plan letters --participant P01 --seed 1",
    "scene schema",
    "settings",
]
# Each compiles what drives the actuators, which a wheel does not bring, or runs on it.
HEAVY = [
    "setup",
    "scene check house.scene",
    "read story.txt --device sim --hand sweep:400 --lines 1",
    "session run rating --participant P1 --answers simulated --device sim --fast --out P1",
    "analyse P1 --out report",
]
TEXTS = (("story.txt", "english.txt"), ("house.scene", "scenes/house.scene"))


@pytest.fixture(scope="module")
def call(tmp_path_factory):
    """Function that runs the wheel's Python, beside the packages that it needs, and no home."""
    folder = tmp_path_factory.mktemp("stranger")
    build = (sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", folder)
    subprocess.run(build, cwd=ROOT, check=True, capture_output=True)
    venv.create(folder / "fresh")
    places = {"base": str(folder / "fresh"), "platbase": str(folder / "fresh")}
    packages = Path(sysconfig.get_path("purelib", vars=places))
    (wheel,) = folder.glob("*.whl")
    zipfile.ZipFile(wheel).extractall(packages)
    # A folder that a .pth file names is searched, while .pth files in it, as that of a checkout
    # that can be edited, are not read.
    (packages / "needed.pth").write_text(sysconfig.get_path("purelib"))
    for name, source in TEXTS:
        shutil.copy(ROOT / "texts" / source, folder / name)
    environment = {
        "PATH": os.environ["PATH"],
        "HOME": str(folder / "nowhere"),
        "XDG_RUNTIME_DIR": str(folder),
    }

    def run(*arguments):
        return subprocess.run(
            [folder / "fresh" / "bin" / "python", *arguments],
            cwd=folder,
            env=environment,
            stdin=subprocess.DEVNULL,
            capture_output=True,
            text=True,
            timeout=600,  # compiling takes a minute where nothing else runs
            check=False,
        )

    return run


@pytest.mark.parametrize("line", by_tier(LIGHT[1:2], LIGHT, LIGHT))
def test_the_wheel_does_without_the_checkout(call, line):
    done = call("-m", "vbraille", *line.split())
    assert done.returncode == 0, done.stderr
    assert done.stdout


@heavy
def test_the_wheel_reads_and_runs_a_session_and_analyses_it(call):
    for line in HEAVY:
        done = call("-m", "vbraille", *line.split())
        assert done.returncode == 0, done.stderr
        assert done.stdout


OTHERS = [name for name in ("python3.12", "python3.13") if name != Path(sys.executable).name]


@heavy  # pip installs all packages anew
@pytest.mark.parametrize("name", OTHERS)
def test_another_python_reads_with_all_that_pip_installs(tmp_path, name):
    of_pyenv = Path.home().glob(f".pyenv/versions/{name.removeprefix('python')}.*/bin/python")
    for found in filter(None, (shutil.which(name), *of_pyenv)):
        made = subprocess.run(
            [found, "-m", "venv", tmp_path / "venv"], check=False, capture_output=True
        )
        if not made.returncode:
            break
    else:
        pytest.skip(f"this machine has no {name} that makes environments")
    python = tmp_path / "venv" / "bin" / "python"
    installed = subprocess.run(
        [python, "-m", "pip", "install", "-q", f"{ROOT}[analysis]"],
        check=False, capture_output=True, text=True,
    )  # fmt: skip
    if installed.returncode:
        pytest.skip(f"pip has not all packages for {name}: {installed.stderr[-300:]}")
    place = subprocess.check_output(
        [python, "-c", "import sysconfig; print(sysconfig.get_path('purelib'))"], text=True
    )
    (Path(place.strip()) / "louis").symlink_to(Path(louis.__file__).parent)
    for name, source in TEXTS:
        shutil.copy(ROOT / "texts" / source, tmp_path / name)
    for line in HEAVY:
        done = subprocess.run(
            [python, "-m", "vbraille", *line.split()],
            cwd=tmp_path, stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=600,
            check=False,
        )  # fmt: skip
        assert done.returncode == 0, done.stderr
        assert done.stdout


def test_the_wheel_is_what_runs(call):
    done = call("-c", "import vbraille; print(vbraille.__file__)")
    assert "fresh" in Path(done.stdout).parts, done.stderr
