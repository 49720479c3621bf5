"""The front door: what docs/api.md tells of it is so, and nothing is loaded before it is needed."""

import contextlib
import doctest
import io
import json
import re
import subprocess
import sys
from importlib import import_module
from itertools import pairwise
from pathlib import Path

import pytest

import vbraille
from tests.tiers import heavy
from vbraille.testing import ManualClock

PAGE = Path(__file__).parents[1] / "docs" / "api.md"
OPTIONS = doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE
# Modules whose docstrings have examples.
TOLD = (
    "vbraille",
    "vbraille.braille.cells",
    "vbraille.errors",
    "vbraille.files",
    "vbraille.names",
    "vbraille.reading.frames",
    "vbraille.reading.opening",
    "vbraille.render.braille.style",
    "vbraille.scene.locations",
    "vbraille.scene.patterns",
    "vbraille.scene.traversal",
    "vbraille.sessions.session",
    "vbraille.testing.standins",
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
assert len(PROGRAMS) == 3


@pytest.mark.parametrize(("program", "printed"), PROGRAMS)
def test_a_whole_program_of_the_page_prints_what_stands_below_it(
    tmp_path, monkeypatch, program, printed
):
    monkeypatch.chdir(tmp_path)
    said = io.StringIO()
    with contextlib.redirect_stdout(said):
        exec(compile(program, str(PAGE), "exec"), {"__name__": "__main__"})
    assert said.getvalue() == printed


def test_the_notebook_runs(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    notebook = json.loads(PAGE.with_name("notebook.ipynb").read_text(encoding="utf-8"))
    cells = ["".join(cell["source"]) for cell in notebook["cells"] if cell["cell_type"] == "code"]
    known = {"__name__": "__main__"}
    for cell in cells:
        exec(compile(cell, "notebook.ipynb", "exec"), known)
    assert known["recording"].frames.max() == pytest.approx(1.0, abs=0.05)
    assert len(known["results"].tables["legibility"]) == 1
    assert known["scene"]._repr_png_()[:4] == b"\x89PNG"


@heavy  # pyright takes seconds
def test_the_driver_of_the_page_has_types(tmp_path):
    program = next(param.values[0] for param in PROGRAMS if param.id.startswith("A device"))
    (tmp_path / "bench.py").write_text(f"# pyright: strict\n{program}")
    told = ("--pythonpath", sys.executable, "bench.py")
    done = subprocess.run(
        [Path(sys.executable).with_name("pyright"), *told],
        cwd=tmp_path, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stdout


@pytest.mark.parametrize("module", TOLD)
def test_every_example_of_a_docstring_runs(module, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    failures, tried = doctest.testmod(import_module(module), optionflags=OPTIONS)
    assert tried
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


class Still(vbraille.Device):
    """A device that stands at its left stop."""

    display = vbraille.VBD.display

    def read(self):
        return vbraille.Pose(0, -self.display.span_mm / 2)

    def _send(self, frame):
        pass

    def _release(self):
        pass


@pytest.mark.parametrize(
    ("call", "says"),
    [
        (lambda: vbraille.VBD.style.replace(texture=2), "texture is 2; it must be 0 to 1"),
        (lambda: vbraille.VBD.style.replace(texture="x"), "texture is 'x'; it must be a number"),
        (lambda: vbraille.VBD.style.replace(mapping="sheared"), r"MAPPINGS\['sheared'\]"),
        (
            lambda: vbraille.VBD.style.replace(texure=1),
            "no texure; the nearest is texture$",
        ),
        (lambda: vbraille.VBD.style.replace(cell_gap_mm=0), "cell gap is 0 mm; it must be 0.1"),
        (lambda: vbraille.render_text("a", display="vbd"), "'vbd'; give vbraille.VBD$"),
        (lambda: vbraille.render_text("a", style="dots"), "style is 'dots'; give a vbraille.Br"),
        (lambda: vbraille.render_text(""), "^the text has nothing to read in it; give some$"),
        (lambda: vbraille.render_page("a", first=0), "first is 0; it must be 1 or more"),
        (lambda: vbraille.render_page("a", last=2), "^the text ends at line 1; give lines up to"),
        (lambda: vbraille.render_page("a\n" * 1001), "at most 1000 lines; say which"),
        (lambda: vbraille.open(Still), r"^Still is a class; give a device of it, as in open\(S"),
        (lambda: vbraille.open(3), "^device is 3; give a spec such as 'sim', or a"),
        (lambda: vbraille.analyse([]), "^nothing is given to analyse; give files of sessions"),
        (lambda: vbraille.analyse("Q1"), "^Q1: No such file"),
    ],
)
def test_what_cannot_be_used_is_said_in_one_sentence(call, says):
    with pytest.raises(vbraille.InputError, match=says):
        call()


def test_lines_that_a_text_does_not_have_are_not_shown_and_nothing_is_after_close():
    with vbraille.open(Still(), clock=ManualClock()) as opened:
        for lines, says in (
            ({"first": 0}, "^first is 0; it must be 1 or more$"),
            ({"first": 99}, "^the text has 1 lines; line 99 is past the end$"),
            ({"first": 3, "last": 2}, "^last is 2 and first is 3; last must not be before"),
        ):
            with pytest.raises(vbraille.InputError, match=says):
                opened.show("abc", **lines)
        opened.show("abc", last=99)
    with pytest.raises(vbraille.DeviceError, match=r"^the device is closed; open it again$"):
        opened.show("abc")


class ZeroAtTheLeftStop(Still):
    """A device whose carriage a motor moves to and fro, and that says 0 at its left stop."""

    milliseconds = 0

    def read(self):
        self.milliseconds += 1
        way_mm = 150.0 - abs(0.06 * self.milliseconds % 300.0 - 150.0)
        return vbraille.Pose(self.milliseconds * 1_000_000, way_mm)


def test_a_device_whose_lines_are_never_done_says_why():
    said = []
    with vbraille.open(ZeroAtTheLeftStop(), clock=ManualClock(), say=said.append) as opened:
        lines = opened.read("abc")
        next(lines)
        assert opened.number == 1
        with pytest.raises(vbraille.DeviceError, match="left stop"):
            next(lines)
    assert "the finger turns at 0 mm each time" in said[0]
    assert "left stop, at -3.8 mm" in said[0]
