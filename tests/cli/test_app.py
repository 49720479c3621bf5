"""The program as a whole: refusals, help, faults, closed outputs and completion."""

import os
import resource
import shutil
import subprocess
import sys
from pathlib import Path

import click
import pytest

import vbraille.translate
from tests.cli import program
from tests.commandline import commands
from vbraille.cli import options
from vbraille.cli.app import HELP


def all_options():
    """Each option of each command, with the words that call the command."""
    for words, command in commands():
        for param in command.params:
            if isinstance(param, click.Option):
                yield words, command, param


@pytest.mark.parametrize(
    ("line", "named"),
    [
        ("tabels", "did you mean 'tables'"),
        ("nosuch", "vbraille --help"),
        ("scene chek x", "did you mean 'check'"),
        ("tables --langage fr", "did you mean --language"),
        ("tables --nosuch", "tables --help-all"),
        ("tables more", "more"),
        ("tables --language", "--language"),
        ("map x.scene", "--out"),
        ("map", "FILE"),
        ("completion csh", "csh"),
        ("map x.scene --out x.png --model stres2", "did you mean stress2"),
        ("render x.txt --out x.h5 --lines 3-1", "--lines"),
        ("render x.txt --out x.h5 --lines 0", "--lines"),
        ("render x.txt --out x.h5 --lines 1-2-3", "--lines"),
        ("tables --log /nowhere/log", "/nowhere/log"),
        ("no\x1b[2J\x07", "x1b"),
    ],
)
def test_a_refusal_is_one_sentence_with_what_it_is_about(call, line, named):
    done = call(*line.split(" "))
    assert (done.code, done.out) == (2, "")
    assert done.err.startswith("vbraille: ")
    assert done.err.count("\n") == 1
    assert done.err[:-1].isprintable()
    assert named in done.err


def test_no_number_of_any_option_is_taken_that_is_not_finite_and_in_range():
    seen = 0
    for words, command, param in all_options():
        if not isinstance(param.type, options.Number):
            continue
        seen += 1
        wrong = ["nan", "inf", "-inf", "", "wide", "1,5", "0x10", True]
        wrong += [] if param.type.low is None else [param.type.low - 1, f"{param.type.low - 1}"]
        wrong += [] if param.type.high is None else [param.type.high + 1]
        for value in wrong:
            with pytest.raises(click.BadParameter):
                param.type.convert(value, param, click.Context(command))
        for value in (param.type.low, param.type.high):
            assert value is None or param.type.convert(str(value), param, None) == value, words
    assert seen > 10


def test_an_option_has_a_sentence_and_one_meaning_in_all_commands():
    kinds = {}
    for words, _, param in all_options():
        assert param.help, (words, param.name)
        assert param.help[0].isupper(), param.help
        assert param.help.endswith("."), param.help
        if param.name == "participants":  # one number, or many sizes of a study
            continue
        kind = type(param.type), param.is_flag, param.multiple
        assert kinds.setdefault(param.opts[-1], kind) == kind, (words, param.name)


def test_help_fits_a_screen_and_all_of_it_is_a_flag_away(call):
    for words, command in commands():
        if isinstance(command, click.Group):
            continue
        short, whole = (call(*words, flag) for flag in ("--help", "--help-all"))
        assert (short.code, short.err, whole.code) == (0, "", 0)
        assert len(short.out.splitlines()) <= 32, words
        for param in command.params:
            if isinstance(param, click.Option):
                assert param.opts[-1] in whole.out, words
        groups = {getattr(param, "group", options.FIRST) for param in command.params}
        own = groups - {options.FIRST, "For developers"}
        assert all(group not in short.out and group in whole.out for group in own), words


def test_each_example_can_be_given():
    from tests.commandline import parsed

    for words, command in commands():
        if command.epilog and command.epilog.startswith("Example: vbraille "):
            example = command.epilog.removeprefix("Example: ").partition(" > ")[0].split()
            assert parsed(example[1:]) == words[0]


def test_without_a_command_it_prints_help_and_help_names_all_commands(call):
    done = call()
    assert (done.code, done.out) == (2, "")
    assert all(f"\n  {name} " in done.err for name in HELP)
    assert call("help", "tables").out == call("tables", "-h").out
    assert call("-V").out.startswith("vbraille ")


@pytest.mark.new_processes
def test_help_is_quick():
    def cost_s(*words):
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        subprocess.run([*program.PROGRAM, *words], stdout=subprocess.DEVNULL, check=True)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime

    assert min(cost_s("--help") for _ in range(5)) <= 0.15
    assert min(cost_s("read", "--help") for _ in range(5)) <= 0.2


def test_a_fault_is_one_sentence_and_its_traceback_is_there_for_those_who_ask(call, monkeypatch):
    def broken():
        raise RuntimeError("some fault")

    monkeypatch.setattr(vbraille.translate, "list_tables", broken)
    done = call("tables")
    assert (done.code, done.out) == (1, "")
    assert done.err.count("\n") == 1
    assert "RuntimeError: some fault" in done.err
    monkeypatch.setenv("VBRAILLE_TRACEBACK", "1")
    assert "Traceback" in call("tables").err


def in_shell(line, **environment):
    return subprocess.run(
        ["sh", "-c", line, "sh", *program.PROGRAM],
        env=os.environ | environment,
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        check=False,
        timeout=program.PATIENCE_S,
    )


@pytest.mark.new_processes
@pytest.mark.parametrize(
    ("line", "code", "said"),
    [
        ('{ "$@" tables; echo $? >&2; } | true', 0, "1\n"),
        ('"$@" tables >&-', 1, "vbraille: the output is closed"),
        ('"$@" tables >/dev/full', 1, "vbraille: No space left on device"),
        ('"$@" nosuch 2>&-', 2, ""),
        ('"$@" tables --language fr 2>&- >/dev/null <&-', 0, ""),
        ('"$@" map x --out y.png <&- >&-', 2, "vbraille: "),
    ],
)
def test_outputs_that_are_closed_or_full_are_a_code_and_no_traceback(line, code, said):
    done = in_shell(line)
    assert done.returncode == code
    assert done.stderr.startswith(said)
    assert "Traceback" not in done.stderr
    assert "Exception" not in done.stderr


COMPLETIONS = {
    "bash": """
        eval "$(vbraille completion bash)"
        COMP_WORDS=({line}) COMP_CWORD={last}
        _vbraille_completion vbraille; printf '%s\\n' "${{COMPREPLY[@]}}"
    """,
    "zsh": """
        compdef() {{ : }}
        _describe() {{ print -l -- $completions_with_descriptions }}
        compadd() {{ print -l -- $completions }}
        words=({line}) CURRENT={current}
        eval "$(vbraille completion zsh)"
        _vbraille_completion
    """,
    "fish": "vbraille completion fish | source; complete -C '{line}'",
}


@pytest.mark.parametrize(
    ("line", "offered"),
    [
        ("vbraille tab", "tables"),
        ("vbraille scene ch", "check"),
        ("vbraille tables --la", "--language"),
        ("vbraille map x.scene --model stress2-", "stress2-8x8"),
    ],
)
@pytest.mark.parametrize("shell", COMPLETIONS)
def test_shells_complete(shell, line, offered):
    if shutil.which(shell) is None:
        pytest.skip(f"{shell} is not installed")
    last = len(line.split()) - 1
    script = COMPLETIONS[shell].format(line=line, last=last, current=last + 1)
    path = f"{Path(sys.executable).parent}:{os.environ['PATH']}"
    done = subprocess.run(
        [shell, "-c", script], env=os.environ | {"PATH": path}, capture_output=True, text=True,
        check=False, timeout=60,
    )  # fmt: skip
    assert offered in done.stdout.replace(":", "\n").split(), done.stderr
