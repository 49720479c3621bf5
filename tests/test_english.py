"""The docstrings of the package: what each begins with, and how wide its lines are."""

import ast
import inspect
import re
from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path

import vbraille

PACKAGE = Path(vbraille.__file__).parent
WIDEST = 100  # columns
FRAGMENT = re.compile(r"(?:Of|Its|None of) ")  # a beginning that needs the name before it
SECTIONS = frozenset(("Parameters", "Attributes", "Returns", "Yields", "Raises"))


def docstrings(tree: ast.Module) -> Iterator[tuple[str, ast.Constant]]:
    """Name of each object that has a docstring, and the docstring."""
    left: list[ast.Module | ast.stmt] = [tree]
    while left:
        node = left.pop()
        body = getattr(node, "body", ())
        left += [*body, *getattr(node, "orelse", ())]
        match body:
            case [ast.Expr(value=ast.Constant(value=str()) as text), *_]:
                yield getattr(node, "name", "module"), text


def beginnings(text: str) -> Iterator[str]:
    """First lines of a docstring and of the descriptions in its numpydoc sections."""
    lines = inspect.cleandoc(text).split("\n")
    yield lines[0]
    inside = False
    for before, line in pairwise(lines):
        if line and not line.strip("-"):
            inside = before in SECTIONS
        if inside and before and not before.startswith(" ") and line.startswith("    "):
            yield line.strip()


def test_docstrings_stand_alone_and_fit_the_page():
    faults = []
    for path in sorted(PACKAGE.rglob("*.py")):
        file = path.relative_to(PACKAGE.parent)
        source = path.read_text(encoding="utf-8")
        lines = source.splitlines()
        for name, text in docstrings(ast.parse(source)):
            faults += [
                f"{file}: {name}: a description begins as a fragment: {line}"
                for line in beginnings(str(text.value))
                if FRAGMENT.match(line)
            ]
            faults += [
                f"{file}: {name}: a line of the docstring has {len(line)} columns: {line.strip()}"
                for line in lines[text.lineno - 1 : text.end_lineno]
                if len(line) > WIDEST
            ]
    assert not faults, "\n".join(faults)


def test_a_fragment_is_found_wherever_it_can_stand():
    text = """Of it.

    Parameters
    ----------
    x : int
        Its place.
    y, z
        Numbers
        Of something.

    Raises
    ------
    ValueError
        None of these.
    """
    found = [line for line in beginnings(text) if FRAGMENT.match(line)]
    assert found == ["Of it.", "Its place.", "None of these."]
