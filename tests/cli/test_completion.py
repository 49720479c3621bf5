"""Completion: what the program offers in each place of a line, and the scripts in real shells."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from vbraille.cli.commands.completion import candidates
from vbraille.cli.commandtable import ACTIONS, COMMANDS, GROUPS


@pytest.mark.parametrize(
    ("line", "offered"),
    [
        ("", [*COMMANDS]),
        ("sess", ["session"]),
        ("session ", [*ACTIONS["session"]]),
        ("session ru", ["run"]),
        ("session run let", ["letters"]),
        ("read --mo", ["--model", "--monitor"]),
        ("read book.txt --echo b", ["both"]),
        ("read --table en-ueb-g", ["en-ueb-g1.ctb", "en-ueb-g2.ctb"]),
        ("read --device s", ["serial:", "sim"]),
        ("device info s", ["serial:", "sim"]),
        ("page --verb", ["--verbose"]),
        ("read --lines ", []),
        ("read boo", []),
        ("nosuch ", []),
    ],
)
def test_what_may_stand_in_the_place_of_the_last_word(line, offered):
    assert sorted(candidates(line.split(" "))) == sorted(offered)


def shell(name, script, *arguments):
    if shutil.which(name) is None:
        pytest.skip(f"there is no {name}")
    path = f"{Path(sys.executable).parent}:{os.environ['PATH']}"
    done = subprocess.run(
        [name, *arguments, "-c", script],
        env=os.environ | {"PATH": path},
        capture_output=True,
        text=True,
        check=True,
        timeout=60,
    )
    assert not done.stderr
    return done.stdout.split()


@pytest.mark.parametrize(
    ("line", "found"),
    [
        ("vbraille session ru", ["run"]),
        ("vbraille page --format b", ["brf"]),
        ("vbraille page --lines ", []),
        ("vbraille read --device ser", ["serial:"]),
    ],
)
def test_bash_completes(line, found):
    script = f"""
        eval "$(vbraille completion bash)"
        COMP_LINE='{line}' COMP_POINT={len(line)}
        _vbraille; printf '%s\\n' "${{COMPREPLY[@]}}"
    """
    assert shell("bash", script) == found


@pytest.mark.parametrize(
    "loaded",
    [
        'eval "$(vbraille completion zsh)"',
        "vbraille completion zsh > {}/_vbraille; fpath=({}); autoload -Uz _vbraille",
    ],
)
def test_zsh_completes_at_the_first_tab(tmp_path, loaded):
    script = f"""
        compdef() {{ : }}
        compadd() {{ print -l -- "${{@[2,-1]}}" }}
        {loaded.format(tmp_path, tmp_path)}
        words=(vbraille session r) CURRENT=3
        _vbraille
    """
    assert sorted(shell("zsh", script, "-f")) == ["resume", "run"]


def test_fish_completes():
    script = "vbraille completion fish | source; complete -C 'vbraille session r'"
    assert {"resume", "run"} <= set(shell("fish", script, "--no-config"))


def test_each_command_is_in_one_group_of_the_overview():
    assert sorted(name for names in GROUPS.values() for name in names) == sorted(COMMANDS)
