"""A stranger's machine: the wheel, installed without the checkout, and a user who owns no home.

The wheel is made of the source distribution, pip installs it, and where the tests are run by root
another user calls it. There is liblouis's library, but not its binding for Python.
"""

import os
import shutil
import subprocess
import sys
import sysconfig
import tempfile
import venv
from pathlib import Path

import louis
import pytest

from tests.tiers import heavy

ROOT = Path(__file__).parents[1]
TEXTS = (("story.txt", "english.txt"), ("house.scene", "scenes/house.scene"))
PROTOCOL = """\
format = 1
name = "one"
title = "One letter"
source = "ours"
model = "vbd"
[design]
kind = "combinations"
characters = ["a"]
length = 1
"""
DISC = """\
canvas = {width_mm = 12.0, height_mm = 6.0}
[[elements]]
kind = "circle"
center_mm = [6.0, 3.0]
radius_mm = 2.0
stroke = {width_mm = 1.0}
"""
BY_PYTHON = """
import vbraille
print(vbraille.__file__)
cells = vbraille.translate_text("the world", language="en", grade=2)
print(cells.to_unicode(), cells.source(0), cells.of_source(4))
print(*vbraille.analyse("P1").tables["legibility"][["participant", "correct"]].loc[0])
"""
LINES = """\
page story.txt --format unicode
render story.txt --lines 1 --out story.h5
read story.txt --device sim --hand sweep:400 --lines 1
feel disc.scene --device sim --hand sweep:400
session run one.toml --participant P1 --answers simulated --device sim --fast --out P1
session check P1
"""
# Compiling what drives the actuators, which a wheel does not bring, takes a minute.
HEAVY = f"""\
--version
settings
structure story.txt
scene schema
session plan letters --participant P01 --seed 1
setup
scene check house.scene
{LINES}analyse P1 --out report
session run rating --participant P2 --answers simulated --device sim --fast --out P2
analyse P2 --out other
"""
SECONDS = 120  # that a command may take, far more than any does, but for compiling


def _write_files(folder):
    """Write what a stranger has brought: a text, two pictures, a protocol."""
    folder.mkdir()
    for name, source in TEXTS:
        shutil.copy(ROOT / "texts" / source, folder / name)
    (folder / "one.toml").write_text(PROTOCOL)
    (folder / "disc.scene").write_text(DISC)
    return folder


def _install(folder):
    """Make a fresh environment of a wheel that was made of the source distribution; its Python."""
    for target, source in ("sdist", ROOT), ("wheel", folder / "source"):
        told = (sys.executable, "-m", "hatchling", "build", "-t", target, "-d", folder)
        subprocess.run(told, cwd=source, check=True, capture_output=True)
        if target == "sdist":
            (made,) = folder.glob("*.tar.gz")
            subprocess.run(("tar", "xzf", made), cwd=folder, check=True)
            (folder / made.name.removesuffix(".tar.gz")).rename(folder / "source")
    (wheel,) = folder.glob("*.whl")
    shutil.rmtree(folder / "source")
    fresh = folder / "fresh"
    venv.create(fresh)
    told = (sys.executable, "-m", "pip", "--python", fresh / "bin/python", "install")
    options = ("-q", "--no-deps", "--no-index", "--disable-pip-version-check")
    subprocess.run([*told, *options, wheel], check=True, capture_output=True)
    packages = Path(sysconfig.get_path("purelib", vars={"base": fresh, "platbase": fresh}))
    # A folder that a .pth file names is searched, while .pth files in it, as that of a checkout
    # that can be edited, are not read.
    (packages / "needed.pth").write_text(sysconfig.get_path("purelib"))
    (packages / "louis.py").touch()  # as the package of that name on PyPI, which is another
    return fresh / "bin" / "python"


def _another_user(python):
    """The user 65534, where it can be had and can run this Python; else the one who tests."""
    if os.getuid():
        return {}
    other = {"user": 65534, "group": 65534, "extra_groups": []}
    try:
        subprocess.run([python, "-c", "import numpy"], check=True, capture_output=True, **other)
    except (OSError, subprocess.CalledProcessError):  # the checkout is root's alone
        return {}
    return other


@pytest.fixture
def call():
    """Function that calls a program as a stranger, in a folder of theirs; the home is read-only."""
    with tempfile.TemporaryDirectory(prefix="vbraille-stranger-") as name:
        folder = Path(name)
        folder.chmod(0o755)  # pytest's own folders are for one user alone
        python = _install(folder)
        other = _another_user(python)
        work = _write_files(folder / "work")
        (folder / "home").mkdir(mode=0o555)
        if other:
            os.chown(work, other["user"], other["group"])
        environment = {
            "PATH": f"{folder}/fresh/bin:{os.environ['PATH']}",
            "HOME": str(folder / "home"),
            "TMPDIR": str(work),
        }

        def run(*told, limit_s=SECONDS, **more):
            return subprocess.run(
                told, cwd=work, env=environment | more, stdin=subprocess.DEVNULL,
                capture_output=True, text=True, timeout=limit_s, check=False, **other,
            )  # fmt: skip

        yield run


def test_a_stranger_reads_feels_and_runs_a_session(call):
    # Kernels as plain Python: a second each, where compiling takes half a minute.
    plain = {"NUMBA_DISABLE_JIT": "1"}
    for line in LINES.splitlines():
        done = call("vbraille", *line.split(), **plain)
        assert done.returncode == 0, (line, done.stderr)
        assert done.stdout, line
    done = call("python", "-c", BY_PYTHON)
    place, *said = done.stdout.splitlines()
    assert "fresh" in Path(place).parts
    assert said == ["⠮⠀⠸⠺ (0, 3) (2, 4)", "P1 1"]


@heavy
def test_a_stranger_does_it_with_compiled_kernels(call):
    for line in HEAVY.splitlines():
        done = call("vbraille", *line.split(), limit_s=600)
        assert done.returncode == 0, (line, done.stderr)
        assert done.stdout, line


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
    work = _write_files(tmp_path / "work")
    for line in HEAVY.splitlines():
        done = subprocess.run(
            [python, "-m", "vbraille", *line.split()],
            cwd=work, stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=600,
            check=False,
        )  # fmt: skip
        assert done.returncode == 0, done.stderr
        assert done.stdout
