"""Commands where the packages of the extras are not installed, as after `make read`."""

import os
import subprocess
import sys
from importlib import import_module

import pytest

from tests.tiers import by_tier
from vbraille.errors import EXTRAS, lacking, needing_extras

# Python reads it when it starts, in child processes, too: what stands there as None is not there.
CUSTOMIZE = f"import sys\nsys.modules.update(dict.fromkeys({sorted(EXTRAS)}))\n"
CALL = """
import sys
from vbraille.cli.app import main
for line in sys.stdin.read().splitlines():
    print("begins:", line, file=sys.stderr)
    print("ended:", main(line.split()), line, flush=True)
"""
READING = """\
read {texts}/english.txt --device sim --hand sweep:400 --lines 1 --no-places
page {texts}/english.txt --format brf
structure {texts}/english.txt
render {texts}/english.txt --lines 1 --out {out}/reading.h5
feel {out}/small.scene --device sim --hand sweep:400
scene check {texts}/scenes/house.scene
device info sim --model stress2
session plan rating --participant P1 --seed 1
session run rating --participant P1 --seed 1 --answers simulated --device sim --fast --out {out}/P1
session export {out}/P1 --out {out}/trials.csv
session check {out}/P1
"""
SCENE = """\
[canvas]
width_mm = 12.0
height_mm = 6.0

[[elements]]
kind = "circle"
center_mm = [6.0, 3.0]
radius_mm = 2.0
stroke = {width_mm = 1.0}
"""
MORE = {
    "analyse {out}/P1": "analysis",
    "session methods {out}/P1": "analysis",
    "power letters --effect T0=0.5,T100=0.64 --participants 6": "analysis",
    "plot page {texts}/english.txt --out {out}/page.png": "pictures",
    "map {texts}/scenes/house.scene --outline --out {out}/map.png": "pictures",
}


# What a system other than Linux does not have, as far as commands use it.
ANOTHER_SYSTEM = """
import os, signal, sys
sys.modules.update(dict.fromkeys(("fcntl", "pty", "resource", "termios", "tty")))
for module, names in (
    (os, ("memfd_create", "sched_setscheduler", "sched_param", "SCHED_FIFO")),
    (signal, ("SIGHUP", "SIGTSTP", "SIGCONT", "SIGALRM", "SIGQUIT", "SIGUSR1")),
):
    for name in names:
        delattr(module, name)
"""
ANYWHERE = """\
page {texts}/english.txt --format brf
structure {texts}/english.txt
render {texts}/english.txt --lines 1 --out {out}/reading.h5
map {texts}/scenes/house.scene --out {out}/house.png
scene check {texts}/scenes/house.scene
session run letters --participant P1 --answers simulated --fast --out {out}/P1
analyse {out}/scored.csv
device info sim --model stress2
"""
ON_LINUX = """\
read {texts}/english.txt --device sim --no-places
feel {texts}/scenes/house.scene --device sim
"""
TRIALS = "participant,condition,presented,answered\nP1,T0,ab,ab\nP2,T0,ab,a?\n"


@pytest.fixture
def ended(tmp_path, texts):
    """Function that gives the exit codes of commands, by line, and what they said on stderr."""
    (tmp_path / "sitecustomize.py").write_text(CUSTOMIZE)
    (tmp_path / "scored.csv").write_text(TRIALS)
    (tmp_path / "small.scene").write_text(SCENE)
    environment = os.environ | {"PYTHONPATH": str(tmp_path), "VBRAILLE_SETTINGS": "/dev/null"}

    def run(lines):
        done = subprocess.run(
            [sys.executable, "-c", CALL],
            input=lines.format(texts=texts, out=tmp_path),
            capture_output=True,
            text=True,
            env=environment,
            check=True,
            timeout=300,
        )
        codes = (line.split(" ", 2) for line in done.stdout.splitlines() if line[:6] == "ended:")
        return {line: int(code) for _, code, line in codes}, done.stderr

    return run


def test_reading_feeling_and_sessions_need_no_extra(ended):
    lines = READING.splitlines()
    # Those that drive a device in real time have processes, which load again.
    quick = [line for line in lines if not line.startswith(("read", "feel", "device"))]
    lines = by_tier(quick, lines, lines)
    codes, said = ended("\n".join(lines))
    assert len(codes) == len(lines)
    assert not any(codes.values()), said


def test_a_command_without_its_extra_says_what_installs_it(ended):
    codes, said = ended("\n".join(MORE))
    assert set(codes.values()) == {2}, said
    parts = said.split("begins: ")[1:]
    for part, extra in zip(parts, MORE.values(), strict=True):
        sentence = part.splitlines()[-1]
        assert "make setup" in sentence, part
        assert f"vbraille[{extra}]" in sentence or "vbraille[all]" in sentence, part
        assert "Traceback" not in part


def test_on_another_system_all_works_that_drives_nothing(ended, tmp_path):
    (tmp_path / "sitecustomize.py").write_text(ANOTHER_SYSTEM)
    codes, said = ended(ANYWHERE + ON_LINUX)
    assert list(codes.values()) == [0] * 8 + [1] * 2, said
    assert "Traceback" not in said
    assert said.count("this needs Linux: the system has no ") == 2


def test_a_module_of_no_extra_is_missing_as_ever():
    with pytest.raises(ModuleNotFoundError), needing_extras():
        import_module("vbraille.nothing_of_the_kind")
    assert "vbraille[sound]" in lacking("sounddevice")
