"""Sources in chapters: numbers and places of blocks, whatever is asked for first."""

import numpy as np
import pytest

from vbraille.translate.documents.chapters import LONGEST_BLOCK, ChapterSource, Passage
from vbraille.translate.source import BlockKind, Mark, MarkKind

CHAPTERS = (
    (Passage("One", BlockKind.HEADING, 1, anchors=("one",)), Passage("first"), Passage("")),
    (),
    (
        Passage("a", BlockKind.ITEM, 1, group=1),
        Passage("b", BlockKind.ITEM, 1, group=1),
        Passage("see there", marks=(Mark(MarkKind.LINK, 4, 9, "#one"),), anchors=("end",)),
    ),
    (Passage("c", BlockKind.ITEM, 1, group=1), Passage("word " * 4000)),
)


class Made(ChapterSource):
    """A source of the chapters above, which counts how often it reads each."""

    def __init__(self) -> None:
        super().__init__("made", [3, 1, 3, 9], "0" * 64)
        self.reads = [0] * len(CHAPTERS)

    def passages(self, chapter):
        self.reads[chapter] += 1
        return CHAPTERS[chapter]


def all_blocks(source):
    blocks = []
    while (block := source.block(len(blocks))) is not None:
        blocks.append(block)
    return blocks


def test_the_places_of_blocks_follow_one_another():
    blocks = all_blocks(Made())
    character = 0
    for block in blocks:
        if not block.continues:
            assert len(block.text) == 0 or block.text.places[0] == character
        assert block.text.places.tolist() == list(range(character, character + len(block.text)))
        character = block.text.end
    texts = [str(block.text) for block in blocks]
    assert texts[:7] == ["One", "first", "", "a", "b", "see there", "c"]
    assert "".join(texts[7:]) == "word " * 4000
    assert [block.continues for block in blocks[7:]] == [False, True, True]
    assert all(len(text) <= LONGEST_BLOCK for text in texts)
    assert [block.group for block in blocks[:8]] == [0, 0, 0, 1, 1, 0, 2, 0]


def test_a_mark_stands_at_its_word():
    block = Made().block(5)
    (mark,) = block.marks
    first, after = block.text.index(mark.start), block.text.index(mark.end)
    assert str(block.text)[first:after] == "there"


@pytest.mark.parametrize("seed", range(20))
def test_whatever_is_asked_for_first(seed):
    expected = all_blocks(Made())
    source = Made()
    for number in np.random.default_rng(seed).permutation(len(expected) + 2).tolist():
        found = source.block(number)
        if number >= len(expected):
            assert found is None
        else:
            assert str(found.text) == str(expected[number].text)
            assert found.text.places.tolist() == expected[number].text.places.tolist()
    assert source.block(-1) is None


def test_every_character_has_its_block():
    source = Made()
    blocks = all_blocks(Made())
    for character in range(40):
        expected = next(n for n, block in enumerate(blocks) if character < block.text.end)
        assert source.block_at(character) == expected
    assert source.block_at(blocks[-1].text.end) is None
    assert source.block_at(-5) == 0


def test_an_index_leads_to_the_end_without_the_beginning():
    first = Made()
    blocks = all_blocks(first)
    later = Made()
    later.adopt(first.index())
    assert str(later.block(6).text) == "c"
    assert later.reads == [0, 0, 0, 1]
    assert later.complete
    assert later.block(len(blocks)) is None
    fresh = Made()
    first._digest = "1" * 64  # the index of another file
    fresh.adopt(first.index())
    assert not fresh.complete


def test_anchors_and_progress():
    source = Made()
    assert source.anchor("end") == int(source.block(5).text.places[0])
    assert source.anchor("one") == 0
    assert source.anchor("nowhere") is None
    shares = [source.progress(n) for n in range(len(all_blocks(source)))]
    assert shares[0] == 0.0
    assert shares == sorted(shares)
    assert shares[-1] < 1.0


class Long(ChapterSource):
    """A source of one short chapter and one of many passages, and how many of those it has made."""

    def __init__(self) -> None:
        super().__init__("long", [1, 999], "0" * 64)
        self.made = 0

    def passages(self, chapter):
        for number in range(10_000 if chapter else 1):
            self.made += 1
            yield Passage(f"x{number}", BlockKind.ITEM, 1, group=1 + number // 5_000)


def test_a_long_chapter_is_read_in_pieces():
    source = Long()
    assert str(source.block(1).text) == "x0"
    assert source.made < 3_000
    assert not source.complete
    assert source.progress(1) < source.progress(1_500) < 1.0
    assert str(source.block(9_000).text) == "x8999"
    assert (source.block(2).group, source.block(5_001).group) == (2, 3)
    assert source.block(10_001) is None
    again = Long()
    again.adopt(source.index())
    assert str(again.block(5_001).text) == "x5000"
    assert again.block(5_001).group == 3
    assert str(again.block(20).text) == "x19"
    assert again.block_at(source.end - 1) == 10_000
