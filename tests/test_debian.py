"""The package for Debian: it builds, lintian finds no fault in it, and what is in it runs."""

import os
import re
import shutil
import subprocess
import sys
import sysconfig
import tomllib
from pathlib import Path

import pytest

from tests.tiers import heavy

ROOT = Path(__file__).parents[1]
TOOLS = ("dpkg-buildpackage", "dh_python3", "lintian")
PLACES = """
etc/security/limits.d/95-vbraille-rtprio.conf
lib/udev/rules.d/70-vbraille.rules
usr/bin/vbraille
usr/share/bash-completion/completions/vbraille
usr/share/doc/vbraille/copyright
usr/share/doc/vbraille/examples/english.txt
usr/share/fish/vendor_completions.d/vbraille.fish
usr/share/zsh/vendor-completions/_vbraille
"""


def test_its_dependencies_have_the_bounds_of_the_project():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    needed = (re.match(r"([\w.]+)>=([\d.]+)", each) for each in project["dependencies"])
    bounds = {found[1].replace(".", "_"): found[2] for found in needed if found}
    for line in (ROOT / "debian" / "py3dist-overrides").read_text().splitlines():
        name, bound = re.match(r"(\w+) \S+ \(>= (?:1:)?([\d.]+)\)$", line).groups()
        assert bound == bounds[name], line


@heavy  # half a minute
@pytest.mark.skipif(not all(map(shutil.which, TOOLS)), reason="Debian's tools are not here")
def test_the_package_builds_and_what_is_in_it_runs(tmp_path):
    told = (ROOT / "packaging" / "build-deb", tmp_path / "made", sys.executable)
    done = subprocess.run(told, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    (package,) = tmp_path.glob("made/*.deb")
    root = tmp_path / "root"
    subprocess.run(("dpkg-deb", "-x", package, root), check=True)
    assert not [place for place in PLACES.split() if not (root / place).is_file()]
    packages = (root / "usr/lib/python3/dist-packages", sysconfig.get_path("purelib"))
    done = subprocess.run(
        [sys.executable, root / "usr/bin/vbraille", "page", ROOT / "texts" / "english.txt"],
        env=os.environ | {"PYTHONPATH": ":".join(map(str, packages))},
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert "⠠⠓⠢" in done.stdout
