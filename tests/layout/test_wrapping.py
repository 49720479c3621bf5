"""Where lines are broken: every word whole that finds room, and no symbol cut."""

from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.laid import cuts_inside
from tests.layout.pages import brf, lay_out
from tests.tiers import examples
from vbraille.layout.blocks import wrap
from vbraille.translate import BrailleTable

# Few values, so that blanks and long words both come.
runs_of_cells = st.lists(st.tuples(st.integers(0, 5), st.integers(0, 12)), max_size=12).map(
    lambda runs: b"".join(b"\0" * blanks + b"\1" * word for blanks, word in runs)
)


def wrapped(breaks: bytes, width: int, indent: int, runover: int) -> list[bytes]:
    """Lines as words that find room, one after the other; the twin of `wrap`."""
    lines: list[bytes] = []
    line, room = b"", width - indent
    at = 0
    while at < len(breaks):
        start = at + len(breaks[at:]) - len(breaks[at:].lstrip(b"\0"))
        gap = start - at
        word = breaks[start:].split(b"\0", 1)[0]
        at = start + len(word)
        if not word:
            break
        if not lines and not line:
            line = b"\0" * max(0, min(gap, width // 2, room - len(word)))
            fits = True
        else:
            fits = len(line) + gap + len(word) <= room
            if fits:
                line += b"\0" * gap
        if not fits:
            lines.append(line)
            line, room = b"", width - runover
        while len(line) + len(word) > room:
            lines.append(word[:room])
            word, room = word[room:], width - runover
        line += word
    return [*lines, line] if line else lines or [b""]


class TestWrap:
    @pytest.mark.parametrize(
        ("text", "width", "lines"),
        [
            ("", 5, [""]),
            ("   ", 5, [""]),
            ("one two", 7, ["one two"]),
            ("one two", 6, ["one", "two"]),
            ("one  two", 7, ["one", "two"]),
            ("one two ", 7, ["one two"]),
            ("a seven-and-more b", 6, ["a", "seven-", "and-mo", "re b"]),
            ("  one", 6, ["  one"]),
            ("      one", 6, ["   one"]),
            ("    words", 6, [" words"]),
            ("   all-of-it", 6, ["all-of", "-it"]),
        ],
    )
    def test_words(self, text, width, lines):
        breaks = text.replace(" ", "\0").encode()
        found = [text[start:stop] for start, stop, _ in wrap(breaks, width)]
        assert [line.rstrip() for line in found] == lines

    def test_indents(self):
        assert wrap(b"aa\0bb\0cc\0dd", 6, 2, 1) == [(0, 2, 2), (3, 8, 1), (9, 11, 1)]
        assert wrap(b"aa\0bb\0cc", 6, 0, 4) == [(0, 5, 0), (6, 8, 4)]

    @examples(150)
    @given(runs_of_cells | st.binary(max_size=60), st.integers(1, 14), st.data())
    def test_laws(self, breaks, width, data):
        indent = data.draw(st.integers(0, width - 1))
        runover = data.draw(st.integers(0, width - 1))
        bounds = wrap(breaks, width, indent, runover)
        cells = [breaks[start:stop] for start, stop, _ in bounds]
        # Nothing is lost, in order; what is left out is blank.
        assert b"".join(cells).replace(b"\0", b"") == breaks.replace(b"\0", b"")
        # No line is too long, and each has its indent.
        assert [i for _, _, i in bounds[1:]] == [runover] * (len(bounds) - 1)
        assert bounds[0][2] in (indent, 0)
        assert all(i + stop - start <= width for start, stop, i in bounds)
        # Every line but the first begins with a word, and ends with one.
        assert all(line[:1] != b"\0" for line in cells[1:])
        assert all(line[-1:] != b"\0" for line in cells[:-1])
        for (start, stop, i), (following, _, _) in pairwise(bounds):
            word = breaks[following:].split(b"\0", 1)[0]
            if following == stop:  # a word is cut only where it fills a line, from its beginning
                assert stop - start == width - i
                assert b"\0" not in breaks[start:stop].lstrip(b"\0")
                assert len(breaks[start:].lstrip(b"\0").split(b"\0", 1)[0]) > width - i
            else:  # greedy: the next word would not have found room
                assert not breaks[stop:following].strip(b"\0")
                assert following + len(word) - start > width - i

    @examples(150)
    @given(runs_of_cells, st.integers(1, 14), st.data())
    def test_as_its_twin(self, breaks, width, data):
        indent = data.draw(st.integers(0, width - 1))
        runover = data.draw(st.integers(0, width - 1))
        found = [breaks[start:stop] for start, stop, _ in wrap(breaks, width, indent, runover)]
        found[-1] = found[-1].rstrip(b"\0")
        assert found == wrapped(breaks, width, indent, runover)


class TestWholeSymbols:
    """Lines end where a character of the source ends."""

    @pytest.mark.parametrize(
        ("starts", "width", "lines"),
        [
            ("aabbccdd", 5, ["aabb", "ccdd"]),
            ("abbb", 3, ["a", "bbb"]),
            ("abbbbb", 3, ["a", "bbb", "bb"]),
            ("aaaaab", 3, ["aaa", "aab"]),
            ("a b b c", 4, ["a", "b b", "c"]),
            ("aa c c dd", 4, ["aa", "c c", "dd"]),
            ("a b bbb b", 3, ["a", "b b", "bb", "b"]),
        ],
    )
    def test_cells_of_one_character_stay_together(self, starts, width, lines):
        breaks = starts.replace(" ", "\0").encode()
        # A blank between two cells of one character is a part of it.
        owners = [ord(c) for c in starts]
        for n in range(1, len(starts) - 1):
            if (starts[n] == " " and starts[n - 1] == starts[n + 1]) or starts[n] == " ":
                owners[n] = owners[n - 1]
        found = [starts[start:stop] for start, stop, _ in wrap(breaks, width, starts=owners)]
        assert found == lines

    def test_a_symbol_takes_the_indent_if_it_needs_it(self):
        assert wrap(b"\1\1\1\1\1\0\1", 5, 2, 0, list(b"aaaaabc")) == [(0, 5, 0), (6, 7, 0)]
        assert wrap(b"\1\1\1\1\1\1", 5, 2, 0, list(b"aaaabb")) == [(0, 4, 1), (4, 6, 0)]

    def test_a_symbol_of_two_cells_goes_to_the_next_line(self, table):
        # The slash of UEB is two cells; so is a capital with its sign.
        assert brf(lay_out("abcdefgh/klm", table, 9)) == ["  ABCDEF<", "_/KLM"]
        assert brf(lay_out("abcdefg/klm", table, 10)) == ["  ABCDEFG", "_/KLM"]
        assert brf(lay_out("xxxxxxX", table, 9)) == ["  XXXXXX", ",X"]
        assert [line.text for line in lay_out("xxxxxxX", table, 9).lines()] == ["xxxxxx", "X"]

    @pytest.mark.parametrize(("language", "table"), [("cmn", "zh-tw.ctb"), ("ko", "ko-g2.ctb")])
    def test_real_text_in_syllables_of_several_cells(self, texts, language, table):
        text = (texts / "declaration" / f"{language}.txt").read_text().replace(" ", "")
        layout = lay_out(text, BrailleTable(table))
        assert layout.count() > 20
        assert cuts_inside(layout) == 0
