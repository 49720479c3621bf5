"""Man pages: each command has one, with all its options, that man shows without a warning."""

import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from vbraille.cli.commandtable import ACTIONS, COMMANDS

SCRIPT = Path(__file__).parents[1] / "packaging" / "manual.py"


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("man")
    subprocess.run([sys.executable, SCRIPT, folder], check=True, timeout=60)
    return folder


def test_each_command_has_a_page_with_its_options(folder):
    actions = {f"vbraille-{name}-{action}.1" for name in ACTIONS for action in ACTIONS[name]}
    names = {"vbraille.1", *(f"vbraille-{name}.1" for name in COMMANDS), *actions}
    assert {path.name for path in folder.iterdir()} == names
    read = (folder / "vbraille-read.1").read_text(encoding="utf-8")
    for said in ("\\-\\-texture", "0…1", "\\-\\-also", "vbraille read [options] [FILE]"):
        assert said in read
    overview = (folder / "vbraille.1").read_text(encoding="utf-8")
    assert all(f"\\-{name}\\fR(1)" in overview for name in COMMANDS)


@pytest.mark.skipif(not shutil.which("groff"), reason="groff, which shows man pages, is not here")
def test_man_shows_each_without_a_warning(folder):
    told = ["groff", "-man", "-Tutf8", "-Kutf8", "-ww", "-z", *sorted(folder.iterdir())]
    done = subprocess.run(told, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (0, "")
