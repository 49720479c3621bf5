"""The place of a reading is kept, at most once a second, and at its end."""

from tests.reading.test_reader import TEXT, Bench
from vbraille.reading.reader import Unkept


class Kept(Unkept):
    def __init__(self):
        super().__init__()
        self.places = []

    def keep_at(self, _, character, **place):
        self.places.append(character)
        self.how = place


def test_a_place_is_kept_once_a_second_and_at_the_end():
    kept = Kept()
    bench = Bench(TEXT, kept=kept)
    starts = [TEXT.index(word) for word in ("one", "four", "seven")]
    bench.run(0.05)
    assert kept.places == starts[:1]
    bench.press("n")
    bench.press("n")
    bench.run(0.5)
    assert kept.places == starts[:1]
    bench.run(0.6)
    assert kept.places == [starts[0], starts[2]]
    bench.press("p")
    bench.reader.leave()
    assert kept.places == [starts[0], starts[2], starts[1]]
    assert kept.how == {
        "line": 2,
        "lines_before": 1,
        "width": 20,
        "table": "en-ueb-g2.ctb",
        "page": "",
    }


def test_reading_begins_at_a_place():
    bench = Bench(TEXT, at=TEXT.index("five"))
    assert bench.reader.line.number == 2
    assert bench.press("b") == ["back: there was no jump"]
    assert bench.press("p") == ["line: 1"]
