"""What is under the finger, by character, dots, word and spelling."""

from tests.reading.commands.test_moving import finger_at
from tests.reading.test_reader import Bench
from vbraille.reading.outputs import Echo


def test_a_cell_is_told_by_its_dots_its_text_and_its_word():
    bench = Bench("the rather naïve 5")
    finger_at(bench, 2)  # after the indent
    assert bench.press("u") == ["cell: dots 2-3-4-6", "characters: the", "word: the"]
    finger_at(bench, 0)
    assert bench.press("u") == ["cell: no dots"]
    naive = bench.reader.line.cell_of(bench.reader.line.text.index("ï"))
    finger_at(bench, naive)
    assert bench.press("u")[1:] == [
        "character: U+00EF latin small letter i with diaeresis",
        "word: naïve",
    ]
    assert bench.press("W") == ["spelling: n a ï v e"]
    five = bench.reader.line.cell_of(bench.reader.line.text.index("5"))
    finger_at(bench, five + 1)
    assert bench.press("u") == ["cell: dots 1-5", "character: 5", "word: 5"]


def test_where_there_is_nothing_it_is_said():
    bench = Bench("one")
    assert bench.press("uW") == ["cell: none here", "word: none here"]


def test_the_line_is_said_again_even_without_an_echo():
    assert Bench("one two").press("V") == ["text: one two"]
    bench = Bench("one two", echo=Echo.BOTH)
    assert bench.press("V") == bench.said[1:3]
    assert bench.said[1].startswith("cells: ")


def test_where_a_plain_text_is_read():
    bench = Bench("\n\n".join(f"paragraph {n}" for n in range(1, 31)))
    bench.press("n" * 26)
    said = bench.press("i")
    assert said == ["line: 27", "page: 2 in braille", "percent: 87", "words left: 8"]
