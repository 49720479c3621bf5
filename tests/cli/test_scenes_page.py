"""docs/scenes.md: its examples are scenes, its Python runs, its keys are those that there are."""

import doctest
import io
import re
import tomllib
from pathlib import Path

import pytest

from tests.scene.keyspage import BEGIN, END, PAGE, keys_text
from vbraille.scene.reading import (
    MOST_BYTES,
    MOST_DEPTH,
    MOST_DOTS,
    MOST_FILES,
    MOST_PATTERNS,
    MOST_POINTS,
    open_scene,
)
from vbraille.scene.stock import stock_textures

ROOT = PAGE.parents[1]
TEXT = PAGE.read_text("utf-8")
BLOCKS = re.findall(r"^```(\w+)\n(.*?)^```$", TEXT, re.MULTILINE | re.DOTALL)
SCENES = [text for language, text in BLOCKS if language == "toml"]


@pytest.mark.parametrize("number", range(len(SCENES)))
def test_each_example_is_a_scene_that_has_no_remarks(number, tmp_path, call):
    path = tmp_path / "moon.scene"
    path.write_text(SCENES[number], encoding="utf-8")
    assert open_scene(path).resolved.elements
    done = call("scene", "check", path)
    assert (done.code, done.err) == (0, "")
    assert done.out.endswith("remarks: none\n")


def test_there_are_small_steps():
    assert len(SCENES) >= 6


def test_what_check_prints_of_the_first_scene_stands_below_it(tmp_path, monkeypatch, call):
    monkeypatch.chdir(tmp_path)
    Path("moon.scene").write_text(SCENES[0], encoding="utf-8")
    assert ("text", call("scene", "check", "moon.scene").out) in BLOCKS


def test_the_error_of_the_page_is_the_programs(tmp_path, monkeypatch, call):
    monkeypatch.chdir(tmp_path)
    wrong = SCENES[0].replace('kind = "circle"', 'kind = "cirle"')
    Path("moon.scene").write_text(wrong, encoding="utf-8")
    (said,) = (text for _, text in BLOCKS if text.startswith("vbraille: "))
    assert call("scene", "check", "moon.scene").err.startswith(said.removesuffix("…\n"))


def test_the_python_of_the_page_runs(monkeypatch):
    monkeypatch.chdir(ROOT)
    runner, known = doctest.DocTestRunner(optionflags=doctest.ELLIPSIS), {}
    for language, text in BLOCKS:
        if language == "python":
            test = doctest.DocTestParser().get_doctest(text, known, "page", str(PAGE), 0)
            said = io.StringIO()
            runner.run(test, out=said.write, clear_globs=False)
            known = test.globs
            assert not runner.failures, said.getvalue()
    assert runner.tries > 5


def test_every_texture_of_the_bank_is_in_the_table():
    assert re.findall(r"^\| `([a-z0-9-]+)`", TEXT, re.MULTILINE) == list(stock_textures())


def test_the_keys_are_those_of_the_values():
    assert TEXT.partition(BEGIN)[2].partition(END)[0] == f"\n{keys_text()}\n", (
        "docs/scenes.md is old; write its keys anew: python -m tests.scene.keyspage"
    )


def test_the_limits_are_those_of_the_program():
    (said,) = re.findall(
        r"A scene file has at most (.*?) patterns within one another\.", TEXT, re.S
    )
    numbers = [float(one.replace(",", "")) for one in re.findall(r"\d[\d,]*", said)]
    assert numbers == [
        MOST_BYTES / 1e6,
        50_000,
        MOST_PATTERNS,
        MOST_POINTS,
        MOST_DOTS,
        MOST_FILES,
        MOST_DEPTH,
    ]


def test_the_first_line_for_editors_is_a_comment_to_toml():
    (line,) = (text for _, text in BLOCKS if text.startswith("#:schema"))
    assert tomllib.loads(line) == {}
