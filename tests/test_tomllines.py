"""The line of a key, as a reader of the file counts it, however TOML has it written."""

import doctest
import tomllib

import pytest
from hypothesis import given
from hypothesis import strategies as st

from vbraille import tomlfile
from vbraille.sessions.planning.loading import FOLDER, shipped
from vbraille.tomlfile import lines_of

NASTY = (
    r"""# first = 0
a.b = 1 # a.c = 2
"q.r" . 'lit#' = "x # y"
basic = DDD
[no]
no = 1 \"QQ "" DDDQQ
literal = SSS
[[no]]
TTSSS
date = 1979-05-27 07:32:00.5
point = 3.5e-1
empty = [ ] # , [
nested = [
  [1, 2], # [
  { x = "]", y = [3,
    4] },
  DDD
]DDD,
]
braces = { inner = 1, 'or # not' = { deep = 2 } }
[table]
key = 'C:\'
  [ table . "sub.table" ]
  k-1 = inf
[[many]]
name = "one"
[[many]]
[many.own]
x = 1
[[many.more]]
[[many.more]]
[many.more.last]
last = "\\\""
""".replace("QQ", 2 * chr(34))
    .replace("TT", 2 * chr(39))
    .replace("DDD", '"' * 3)
    .replace("SSS", "'" * 3)
)


def reached(tree, path):
    """Whether a path leads to something."""
    try:
        for step in path:
            tree = tree[step]
    except (KeyError, IndexError, TypeError):
        return False
    return True


def paths(tree, path=()):
    """All keys and tables of a tree; items only where they are tables."""
    if path:
        yield path
    if isinstance(tree, dict):
        for key, value in tree.items():
            yield from paths(value, (*path, key))
    if isinstance(tree, list) and all(isinstance(item, dict) for item in tree):
        for item, value in enumerate(tree):
            yield from paths(value, (*path, item))


def first_lines(text):
    """The same by another way: the statement with which `tomllib` knows of a path."""
    written, tree = text.split("\n")[:-1], tomllib.loads(text)
    known, begun = {}, 0
    for end in range(1, len(written) + 1):
        try:
            so_far = tomllib.loads("\n".join((*written[:end], "")))
        except tomllib.TOMLDecodeError:
            continue  # within a value of several lines
        for path in paths(tree):
            if reached(so_far, path):
                known.setdefault(path, begun + 1)
        begun = end
    return known


class TestLines:
    def test_the_example(self):
        assert doctest.testmod(tomlfile) == (0, 1)

    @pytest.mark.parametrize("text", [NASTY, NASTY.replace("\n", "\r\n"), ""])
    def test_keys_and_tables(self, text):
        found, known = lines_of(text), first_lines(text)
        braces = {path for path in known if path[0] == "braces" and len(path) > 1}
        assert len(braces) == 3 * bool(text)
        assert {path: found.get(path) for path in known if path not in braces} == {
            path: line for path, line in known.items() if path not in braces
        }

    @pytest.mark.parametrize("name", shipped())
    def test_a_protocol(self, name):
        text = (FOLDER / f"{name}.toml").read_text("utf-8")
        found, known = lines_of(text), first_lines(text)
        begun = sorted({*known.values(), text.count("\n") + 1})

        def nearest(path):
            """Line of a path; of what is in braces, which are not looked into, theirs."""
            return found[path] if path in found else nearest(path[:-1])

        for path, first in known.items():
            after = next((line for line in begun if line > first), first + 1)
            # A statement of several lines has the line of each item.
            assert first <= nearest(path) < after, path
            assert nearest(path) == first or ("choices" in path or "levels" in path), path

    def test_items(self):
        found = lines_of(NASTY)
        begin = NASTY.split("\n").index("nested = [") + 1
        items = {path[1:]: line - begin for path, line in found.items() if path[0] == "nested"}
        assert [items[path] for path in [(), (0,), (0, 1), (1,), (2,)]] == [0, 1, 1, 2, 4]

    @given(
        st.lists(
            st.tuples(
                st.sampled_from(["", "# [x]\n", "[t{}]\n", "[t{}.u]\n", "[[m]]\n", "[[m.n]]\n"]),
                st.sampled_from(
                    ["1", '"#"', "'''\n[z]\n'''", "[\n1,\n[2, 3\n]]", "[\n]", "{ a = 1 }"]
                ),
            )
        )
    )
    def test_whatever_comes_before_it(self, parts):
        text = "[[m]]\n"
        for number, (header, value) in enumerate(parts):
            text += f"{header.format(number)}k{number} = {value}\n"
        found = lines_of(text)
        for number in range(len(parts)):
            line = next(
                n for n, at in enumerate(text.split("\n"), 1) if at[:9].startswith(f"k{number} ")
            )
            assert [n for path, n in found.items() if path[-1] == f"k{number}"] == [line]
