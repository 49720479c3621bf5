"""The front door: what docs/api.md tells of it is so, and nothing is loaded before it is needed."""

import contextlib
import doctest
import io
import re
import subprocess
import sys
from importlib import import_module
from itertools import pairwise
from pathlib import Path

import pytest

import vbraille

PAGE = Path(__file__).parents[1] / "docs" / "api.md"
OPTIONS = doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE
# Modules whose docstrings have examples of what people call.
TOLD = (
    "vbraille",
    "vbraille.analysis",
    "vbraille.reading.frames",
    "vbraille.reading.opening",
    "vbraille.render.braille.style",
    "vbraille.sessions.session",
    "vbraille.testing.simulated",
    "vbraille.wording",
)
HEAVY = ("numpy", "numba", "pandas", "scipy", "matplotlib", "h5py", "louis", "typing", "argparse")


def blocks():
    """Blocks of code on the page: its heading, language, text."""
    heading = ""
    for found in re.finditer(r"^(#+ [^\n]*)$|^```(\w+)\n(.*?)^```$", PAGE.read_text(), re.M | re.S):
        if found[1]:
            heading = found[1].lstrip("# ")
        else:
            yield heading, found[2], found[3]


def test_every_example_of_the_page_runs(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    known, runner = {}, doctest.DocTestRunner(optionflags=OPTIONS)
    for heading, language, text in blocks():
        if language == "python" and text.startswith(">>>"):
            test = doctest.DocTestParser().get_doctest(text, known, heading, str(PAGE), 0)
            said = io.StringIO()
            runner.run(test, out=said.write, clear_globs=False)
            known = test.globs
            assert not runner.failures, said.getvalue()
    assert runner.tries > 10


def programs():
    """Whole programs of the page, each with what stands below it."""
    found = list(blocks())
    for (heading, language, text), (_, _, below) in pairwise(found):
        if language == "python" and not text.startswith(">>>"):
            yield pytest.param(text, below, id=heading)


PROGRAMS = list(programs())


@pytest.mark.parametrize(("program", "printed"), PROGRAMS)
def test_a_whole_program_of_the_page_prints_what_stands_below_it(
    tmp_path, monkeypatch, program, printed
):
    monkeypatch.chdir(tmp_path)
    said = io.StringIO()
    with contextlib.redirect_stdout(said):
        exec(compile(program, str(PAGE), "exec"), {"__name__": "__main__"})
    assert said.getvalue() == printed


def test_there_are_three_whole_programs():
    assert len(PROGRAMS) == 3


@pytest.mark.parametrize("module", TOLD)
def test_every_example_of_a_docstring_runs(module, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    failures, _ = doctest.testmod(import_module(module), optionflags=OPTIONS)
    assert not failures


def test_everything_that_people_call_is_on_the_page_and_has_a_docstring():
    page = PAGE.read_text()
    for name in vbraille.__all__:
        assert f"`{name}" in page or f"vbraille.{name}" in page, name
        assert getattr(vbraille, name).__doc__ or name.isupper(), name


def loaded_by(code):
    """Which of the heavy modules a program loads, that a bare Python does not."""
    asked = f"import sys; {code}; print(*[name for name in {HEAVY} if name in sys.modules])"
    done = subprocess.run([sys.executable, "-c", asked], capture_output=True, text=True, check=True)
    return set(done.stdout.split())


def test_a_program_that_imports_vbraille_waits_for_nothing():
    assert loaded_by("import vbraille; dir(vbraille)") == loaded_by("pass")
    assert "numpy" in loaded_by("import vbraille; vbraille.VBD")


def test_each_name_is_there_and_no_other():
    for name in vbraille.__all__:
        assert getattr(vbraille, name) is getattr(vbraille, name)
    with pytest.raises(AttributeError, match="no attribute 'rendr_text'"):
        vbraille.rendr_text  # noqa: B018
    assert set(vbraille.__all__) <= set(dir(vbraille))
