"""Docstrings and comments: first words, subjects, and width of lines."""

import ast
import inspect
import re
import tokenize
from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path

import vbraille

PACKAGE = Path(vbraille.__file__).parent
TESTS = Path(__file__).parent
WIDEST = 100  # columns
FRAGMENT = re.compile(r"(?:Of|Its|None of) ")  # a beginning that needs the name before it
QUESTION = re.compile(r"(?:What|Whether|Who|How|Of|Which|Where|When)\b")  # no verb and no thing
NO_ONE = re.compile(r"\b(?:nobody|somebody|whoever)\b", re.IGNORECASE)
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


def english(path: Path) -> Iterator[tuple[int, str]]:
    """Line number and text of each docstring and comment of a file that has such a word."""
    with tokenize.open(path) as file:
        source = file.read()
    if not NO_ONE.search(source):  # looking for comments takes longest
        return
    for _, text in docstrings(ast.parse(source)):
        yield text.lineno, str(text.value)
    for token in tokenize.generate_tokens(iter(source.splitlines(keepends=True)).__next__):
        if token.type == tokenize.COMMENT:
            yield token.start[0], token.string


def test_docstrings_open_with_a_verb_or_a_thing_stand_alone_and_fit_the_page():
    faults = []
    for path in sorted(PACKAGE.rglob("*.py")):
        file = path.relative_to(PACKAGE.parent)
        source = path.read_text(encoding="utf-8")
        lines = source.splitlines()
        for name, text in docstrings(ast.parse(source)):
            opening, *more = beginnings(str(text.value))
            faults += [
                f"{file}: {name}: a description begins as a fragment: {line}"
                for line in (opening, *more)
                if FRAGMENT.match(line)
            ]
            faults += [
                f"{file}: {name}: a line of the docstring has {len(line)} columns: {line.strip()}"
                for line in lines[text.lineno - 1 : text.end_lineno]
                if len(line) > WIDEST
            ]
            if QUESTION.match(opening):
                faults.append(f"{file}: {name}: neither a verb nor a thing: {opening}")
    assert not faults, "\n".join(faults)


def test_docstrings_and_comments_name_the_person_or_thing_that_is_meant():
    faults = [
        f"{path}:{line}: {found[0]}"
        for path in sorted([*PACKAGE.rglob("*.py"), *TESTS.rglob("*.py")])
        for line, text in english(path)
        if (found := NO_ONE.search(text))
    ]
    assert not faults, "\n".join(faults)
