"""The README and the pages of docs/: their commands can be given, and what they name is there."""

import re
import shlex
from collections import Counter
from pathlib import Path

import pytest

from tests.commandline import helps, parsed
from tests.documents import DOCS, TABLES, with_table, words_of_guides

ROOT = Path(__file__).parents[1]
PAGES = sorted([*ROOT.glob("*.md"), *ROOT.glob("docs/*.md")])
# Pages that lead a reader to a first success: their commands are copied as they stand.
DOORS = [ROOT / "README.md", *(ROOT / f"docs/{name}.md" for name in ("reading", "lab", "building"))]

_INDENTED = r"(?<=\n\n)((?:    \S[^\n]*\n)+)"
_BLOCK = re.compile(rf"^```\w*\n(.*?)^```$|{_INDENTED}", re.MULTILINE | re.DOTALL)
_COMMANDS = re.compile(rf"^```sh\n(.*?)^```$|{_INDENTED}", re.MULTILINE | re.DOTALL)
_INLINE = re.compile(r"`([^`\n]+)`")
_LINK = re.compile(r"\]\(([^)#\s]+)[^)\s]*\)")
_OPTION = re.compile(r"--[a-z][a-z-]*")
_FILE = re.compile(r"(?:vbraille|tests|texts|docs)/[\w./-]*\w/?")
_SOURCE = re.compile(r"^[a-z_]+(?:/\w+)+\.(?:py|toml|csv|js|h)$")
_CLASS = re.compile(r"^class ([A-Z]\w*)", re.MULTILINE)
_ALIAS = re.compile(r"^([A-Z]\w*) = ", re.MULTILINE)
_MODULE = re.compile(r"(?<![/-])vbraille(?:\.[A-Za-z_]\w*)+")


def of_each(pages):
    return pytest.mark.parametrize(
        "page", pages, ids=[str(page.relative_to(ROOT)) for page in pages]
    )


def commands(page):
    """What a reader of a page would copy, a line each, in its order."""
    blocks = _COMMANDS.finditer(page.read_text(encoding="utf-8"))
    lines = "".join(block[1] or block[2] for block in blocks).splitlines()
    return [line.strip() for line in lines if line.strip()]


def code(page):
    """What stands in backquotes in the sentences of a page."""
    return _INLINE.findall(_BLOCK.sub("", page.read_text(encoding="utf-8")))


@of_each(DOORS)
def test_each_command_can_be_given_as_it_is_written(page):
    given = commands(page)
    longer = [words for words in code(page) if words.startswith("vbraille ") and " --" in words]
    assert given
    for line in given + longer:
        program, *words = shlex.split(line.partition(" > ")[0])
        if program == "make":
            targets = (ROOT / "Makefile").read_text()
            assert all(re.search(rf"^{word}:", targets, re.MULTILINE) for word in words), line
        elif program == "vbraille" and "--help" not in words:
            assert parsed(words) == words[0]
        else:
            assert program in ("vbraille", "cc") or line == ". .venv/bin/activate", line


@of_each(PAGES)
def test_each_command_of_a_block_can_be_given(page):
    """Those with an ellipsis have a part of the reader's own; remarks stand after three blanks."""
    for line in commands(page):
        if line.startswith("vbraille ") and "…" not in line and "..." not in line:
            words = shlex.split(re.split(r" {3,}| > ", line)[0])[1:]
            assert "--help" in words or parsed(words) == words[0], line


@of_each(PAGES)
def test_a_line_has_at_most_120_characters(page):
    lines = page.read_text(encoding="utf-8").splitlines()
    assert [line for line in lines if len(line) > 120 and not line.startswith("|")] == []


@of_each(DOORS)
def test_each_text_that_a_command_takes_is_there(page):
    for line in commands(page):
        for name in _FILE.findall(line):
            assert (ROOT / name).exists(), line


@of_each(DOORS)
def test_each_option_that_is_named_is_one(page):
    known = set(_OPTION.findall(helps()))
    named = {option for words in code(page) for option in _OPTION.findall(words)}
    assert named <= known


@of_each(PAGES)
def test_each_link_leads_somewhere(page):
    for target in _LINK.findall(page.read_text(encoding="utf-8")):
        assert "://" in target or (page.parent / target).exists(), target


@of_each(PAGES)
def test_each_file_that_is_named_is_there(page):
    for words in code(page):
        for name in _FILE.findall(words):
            assert (ROOT / name).exists() or "…" in words, name


def test_each_file_that_the_architecture_names_is_there():
    page = DOCS / "architecture.md"
    named = [name for words in code(page) for name in _SOURCE.findall(words)]
    assert len(named) > 40
    there = [(ROOT / name).exists() or (ROOT / "vbraille" / name).exists() for name in named]
    assert [name for name, found in zip(named, there, strict=True) if not found] == []


@of_each(PAGES)
def test_each_module_and_what_it_is_said_to_have_is_there(page):
    for words in code(page):
        for name in _MODULE.findall(words):
            place, parts = ROOT, name.split(".")
            while parts and (place / parts[0]).is_dir():
                place /= parts.pop(0)
            if parts and (place / f"{parts[0]}.py").is_file():
                place /= f"{parts.pop(0)}.py"
            source = (place if place.is_file() else place / "__init__.py").read_text()
            if place == ROOT / "vbraille":
                parts = parts[:1]  # what a name of the front door has stands where it comes from
            assert all(re.search(rf"\b{part}\b", source) for part in parts), name


def test_guides_have_at_most_35_000_words():
    """Neither specifications, records nor what is made from the program is counted."""
    words = words_of_guides()
    assert sum(words.values()) <= 35_000, words


def test_a_picture_has_words():
    for page in PAGES:
        for words in re.findall(r"!\[([^\]]*)\]", page.read_text(encoding="utf-8")):
            assert len(words.split()) > 10, (page.name, words)


def test_a_name_stands_for_one_thing():
    """No two classes of a folder are called the same; the glossary's names are in the program."""
    paths = set((ROOT / "vbraille").rglob("*.py"))
    texts = {path: path.read_text(encoding="utf-8") for path in paths}
    named = Counter((path.parent, name) for path in paths for name in _CLASS.findall(texts[path]))
    assert [name for name, number in named.items() if number > 1] == []
    sources, classes = texts.values(), {name for _, name in named}
    aliases = {name for text in sources for name in _ALIAS.findall(text)}
    told = {words for words in code(ROOT / "docs/glossary.md") if words[0].isupper()}
    assert told <= set(classes) | aliases


def test_the_glossary_has_each_word_once():
    page = (ROOT / "docs/glossary.md").read_text(encoding="utf-8")
    words = re.findall(r"\*\*([^*]+)\*\*", page)
    assert sorted(set(words)) == sorted(words)


@pytest.mark.parametrize(
    ("name", "rows"), TABLES, ids=lambda part: part if type(part) is str else ""
)
def test_each_table_is_what_the_program_has(name, rows):
    text = (DOCS / name).read_text(encoding="utf-8")
    assert with_table(text, rows) == text, "python -m tests.documents writes it"
