"""Going by what a text is made of, and what is said there."""

import io

import pytest

from tests.reading.chapters import BOOK, HEADING, Chapters
from tests.reading.commands.test_moving import finger_at
from tests.reading.commands.test_searching import Seeker
from tests.reading.test_reader import Bench
from vbraille.layout.braillepages import Imprint, pef
from vbraille.reading.outputs import Echo
from vbraille.reading.search.seeker import Answering
from vbraille.reading.view import Cue
from vbraille.translate import Book, BrailleTable, Cells
from vbraille.translate.braillefiles.lines import open_brf
from vbraille.translate.braillefiles.pef import PefBook
from vbraille.translate.documents.chapters import Passage
from vbraille.translate.documents.html import HtmlBook
from vbraille.translate.documents.markdown import read_markdown
from vbraille.translate.source import Mark, MarkKind

TABLE = BrailleTable("en-ueb-g1.ctb")


@pytest.fixture
def bench():
    return Bench(book=Book(BOOK, TABLE), width=26, echo=Echo.TEXT)


def texts(said):
    """What is said but for the numbers of lines, which come before a line's text, or alone."""
    return [s.removeprefix("text: ") for s in said if not s.startswith("line: ")]


@pytest.mark.parametrize(
    ("keys", "there"),
    [
        ("e", ["The first part"]),
        ("eee", ["The first part", "A section", "The second part"]),
        ("e1", ["The first part", "The second part"]),
        ("e2", ["The first part", "A section"]),
        ("eeeE", ["The first part", "A section", "The second part", "A section"]),
        (["e", "e", "e", "alt-1"], ["The first part", "A section", "The second part"] * 1
         + ["The first part"]),
        ("ll", ["apples", "plums"]),
        ("lnlL", ["apples", "pears", "plums", "apples"]),
        ("lnL", ["apples", "pears", "list: none before this"]),
        ("r", ["Name; Age"]),
        ("rR", ["Name; Age", "table: none before this"]),
        ("rnr", ["Name; Age", "Ann; 7", "table: none after this"]),
        ("fff", ["2", "iii", "page: none after this"]),
        ("ffF", ["2", "iii", "2"]),
        ("aaa", ["The first part", "See the end of it.", "A section"]),
        ("aaAA", ["The first part", "See the end of it.", "The first part", "1"]),
        ("kkk", ["See the end of it.", "A remark follows.", "More on the net."]),
        ("kkkkK", ["See the end of it.", "A remark follows.", "More on the net.",
         "link: none after this", "A remark follows."]),
        ("eb", ["The first part", "1"]),
        ("A", ["paragraph: none before this"]),
    ],
)  # fmt: skip
def test_a_key_goes_to_the_next_of_its_kind_or_to_the_one_before(bench, keys, there):
    assert texts(bench.press(keys)) == there


def test_what_is_not_there_is_said_and_given_as_a_cue():
    cues = []
    bench = Bench("one", cue=cues.append)
    assert bench.press("elrk") == [
        f"{k}: none after this" for k in ["heading", "list", "table", "link"]
    ]
    assert cues == [Cue.NOT_FOUND] * 4


@pytest.mark.parametrize(
    ("keys", "said"),
    [
        ("l", ["list, line"]),
        ("I", ["item, line"]),
        ("r", ["table, line"]),
        ("QQ", ["quotation, line"] * 2),
        (">L", ["line:", "list, line"]),
    ],
)
def test_a_jump_says_what_it_has_come_to(keys, said):
    assert [sentence.rpartition(" ")[0] for sentence in of_markdown(LISTS).press(keys)] == said


def test_without_pages_of_print_a_page_has_25_lines():
    text = "\n\n".join(f"line {n}" for n in range(1, 60))
    bench = Bench(text)
    assert bench.press("ff") == ["line: 26", "line: 51"]
    assert bench.press("nF") == ["line: 52", "line: 51"]
    assert bench.press("FF") == ["line: 26", "line: 1"]
    assert bench.press("F") == ["page: none before this"]
    assert bench.press("g2\n") == ["go to: type a page, or percent as in 40%, then Enter",
                                   "go to: 2", "line: 26"]  # fmt: skip
    assert bench.press("g9\n")[2] == "page 9: there is no such page"
    assert bench.press("gtwo\n")[2] == (
        "go to: 'two' is no page; type a number, or percent as in 40%"
    )
    assert bench.press("b") == ["line: 1"]


@pytest.mark.parametrize(
    ("typed", "there"),
    [
        ("2", "2"),
        ("III", "iii"),
        ("0.5%", "line: 1"),
        ("99%", "This is the note."),
        ("50 %", "Ann; 7"),
        ("7", "page 7: there is no such page"),
        ("101%", "go to: 101% is more than the book; type 0% to 100%"),
    ],
)
def test_a_page_of_print_or_a_share_is_typed(bench, typed, there):
    said = bench.press(["g", *typed, "\n"])
    assert said[1] == f"go to: {typed}"
    assert texts(said[2:]) == [there] or said[2:] == [there]


NEAR_LINKS = Passage(
    "See one or two.",
    marks=(Mark(MarkKind.LINK, 4, 7, "a:1"), Mark(MarkKind.LINK, 11, 14, "a:2")),
)


def test_a_link_of_the_same_line_is_said_and_comes_under_the_finger():
    passages = [Passage("None here."), NEAR_LINKS]
    bench = Bench(book=Book(Chapters(passages), TABLE), width=26, echo=Echo.TEXT)
    bench.press("k")
    finger_at(bench, 1)
    assert bench.press("k") == ["link: two"]
    assert bench.press("u")[-1] == "word: two."
    assert bench.press("\n") == ["link: a:2"]
    assert bench.press("K") == ["link: one"]
    assert bench.press("u\n")[-2:] == ["word: one", "link: a:1"]
    assert bench.press("kk") == ["link: two", "link: none after this"]


def test_a_link_that_was_gone_to_is_followed_where_no_finger_is_known():
    bench = Bench(book=Book(Chapters([Passage("None here."), NEAR_LINKS]), TABLE), width=26)
    assert bench.reader.cell is None
    assert bench.press("kk\n") == ["link: one, line 2", "link: two", "link: a:2"]


def test_a_note_is_followed_and_left_again(bench):
    bench.press("kk")
    line = bench.reader.line
    finger_at(bench, line.text.index("remark") + 3)
    assert texts(bench.press("\n")) == ["This is the note."]
    assert texts(bench.press("b")) == ["A remark follows."]
    assert texts(bench.press("k\n")) == ["More on the net.", "link: https://example.org"]
    assert texts(bench.press("e\n")) == ["heading: none after this", "link: https://example.org"]
    assert texts(bench.press("E\n")) == ["The second part", "link: none here"]


def test_where_am_i_says_line_page_percent_heading_and_words(bench):
    bench.press("rn")
    assert bench.press("i") == [
        f"line: {bench.reader.line.number}",
        "page: 2",
        f"percent: {100 * bench.layout.progress(bench.reader.line):.0f}",
        "heading: A section",
        "words left: 20",
    ]
    assert bench.press("H") == ["headers: Name; Age"]
    assert bench.press("nH")[-1] == "headers: this is no row of a table"


def brf(pages):
    return open_brf(io.BytesIO("\n\f".join(pages).encode()), "book.brf")


def pef_book(pages):
    rows = [[Cells.from_brf(line).masks for line in page.split("\n")] for page in pages]
    return PefBook.open(io.BytesIO(b"".join(pef(rows, Imprint("", "en", "urn:x"), 9, 9))), "book")


@pytest.mark.parametrize("made", [brf, pef_book])
def test_pages_of_a_braille_file_are_counted_on(made):
    pages = [f"PAGE\n{chr(ord('A') + n % 26)}{chr(ord('A') + n // 26)}" for n in range(70)]
    bench = Bench(book=Book(made(pages)), width=9, echo=Echo.TEXT)
    assert bench.press("ni")[-4:-2] == ["line: 2", "page: 1"]
    said = bench.press("g65\n")
    assert said[1] == "go to: 65"
    bench.press("n")
    assert bench.reader.line.cells.to_brf() == "MC"
    assert "page: 65" in bench.press("i")
    bench.press("F")
    assert "page: 65" in bench.press("i")
    bench.press("F")
    assert "page: 64" in bench.press("i")
    bench.press("ff")
    assert "page: 66" in bench.press("i")
    assert bench.press("g71\n")[-1] == "page 71: there is no such page"


def test_a_page_of_a_braille_file_may_end_within_a_line():
    bench = Bench(book=Book(open_brf(io.BytesIO(b"A\fB\fC"), "book.brf")), width=9)
    for page, cells in (("3", "C"), ("2", "B"), ("1", "A")):
        bench.press(["g", page, "\n"])
        assert bench.reader.line.cells.to_brf() == cells
        assert f"page: {page}" in bench.press("i")
    for cells in "BC":
        bench.press("f")
        assert bench.reader.line.cells.to_brf() == cells
    for cells in "BA":
        bench.press("F")
        assert bench.reader.line.cells.to_brf() == cells


def test_the_page_before_is_found_beyond_pages_without_a_line():
    bench = Bench(book=Book(open_brf(io.BytesIO(b"A\n\f\f\fD"), "book.brf")), width=9)
    assert bench.press("fi")[2] == "page: 4"
    assert bench.press("Fi")[-3] == "page: 1"
    assert bench.press("F") == ["page: none before this"]


def test_a_table_without_headers_says_so():
    source = Chapters([Passage("a; b", BOOK.block(9).kind, group=1)])
    assert Bench(book=Book(source, TABLE)).press("H") == ["headers: the table has none"]


def test_words_left_of_a_long_book_are_told_by_those_that_are_near():
    part = [Passage("ten words stand in each one of all these paragraphs here")] * 1_000
    bench = Bench(book=Book(Chapters(*[part] * 8), TABLE))
    said = bench.press("i")
    assert said[:3] == ["line: 1", "page: 1 in braille", "percent: 0"]
    label, _, number = said[3].rpartition(" ")
    assert label == "words left: about"
    assert 60_000 < int(number) < 100_000


def test_a_page_that_is_far_is_looked_for_while_reading_goes_on():
    text = "\n\n".join(f"line {n}" for n in range(1, 12_000))
    seeker = Seeker()
    bench = Bench(text, seeker=seeker)
    assert bench.press("g3\n")[-1] == "line: 51"
    assert bench.press("g400\n")[1:] == ["go to: 400", "searching"]
    asked = seeker.asked[-1]
    assert (asked.line, asked.width) == (399 * 25 + 1, bench.layout.width)
    assert bench.layout.lines_to(asked.line) > 9_000  # which no reader waits for
    assert bench.press("n") == ["line: 52"]
    answering = Answering(bench.layout.book)
    seeker.answers = list(answering.answer(asked))[-1:]
    bench.run(0.05)
    assert bench.said[-1].startswith("place: ")
    assert bench.reader.line.text == "line 9976"
    seeker.answers = list(answering.answer(seeker.asked[-1]))[-1:]
    bench.run(0.05)
    assert bench.press("b") == ["line: 52"]
    bench.press("g500\n")
    seeker.answers = list(answering.answer(seeker.asked[-1]))[-1:]
    bench.run(0.05)
    assert bench.said[-1] == "page 500: there is no such page"


LISTS = """# First part

1. First item.

   Inside the first item.

2. Second item.

   ### A heading in an item

   > A quotation here.
   >
   > It goes on.

   | a | b |
   |---|---|
   | c | d |

3. Third item.

Between the lists.

- Apples.
- Pears.

> Another quotation.

After the lists.
"""


def of_markdown(text, **options):
    """A reader of a text in Markdown."""
    source = read_markdown(io.BytesIO(text.encode()), "book.md")
    return Bench(book=Book(source, TABLE), width=26, **options)


@pytest.mark.parametrize(
    ("keys", "there"),
    [
        ("ll", ["1. First item.", "• Apples."]),
        ("lnl", ["1. First item.", "Inside the first item.", "• Apples."]),
        ("l3l", ["1. First item.", "A heading in an item", "• Apples."]),
        ("lrl", ["1. First item.", "a  b", "• Apples."]),
        ("llL", ["1. First item.", "• Apples.", "1. First item."]),
        ("llLL", ["1. First item.", "• Apples.", "1. First item.", "list: none before this"]),
        ("l3L", ["1. First item.", "A heading in an item", "list: none before this"]),
        (">L", ["After the lists.", "• Apples."]),
        (">LL", ["After the lists.", "• Apples.", "1. First item."]),
        (">RR", ["After the lists.", "a  b", "table: none before this"]),
        ("II", ["1. First item.", "2. Second item."]),
        ("lnI", ["1. First item.", "Inside the first item.", "2. Second item."]),
        (["l", "n", "alt-i"], ["1. First item.", "Inside the first item.", "1. First item."]),
        ("QQQ", ["A quotation here.", "Another quotation.", "quotation: none after this"]),
        ([">", "alt-q", "alt-q"], ["After the lists.", "Another quotation.",
                                   "A quotation here."]),
    ],
)  # fmt: skip
def test_a_list_is_one_whatever_its_items_hold(keys, there):
    assert texts(of_markdown(LISTS, echo=Echo.TEXT).press(keys)) == there


@pytest.mark.parametrize(
    ("table", "keys", "said"),
    [
        ("| Name | Age |\n|---|---|\n| Ann | 7 |", "rH", "headers: in this row: Name; Age"),
        ("| Name | Age |\n|---|---|\n| Ann | 7 |", "rnH", "headers: Name; Age"),
        ("<table><tr><td>Ann<td>7<tr><th>Name<th>Age<tr><td>Bob<td>8</table>", "rH",
         "headers: the table has none"),
        ("<table><tr><td>Ann<td>7<tr><td>Bob<td>8</table>", "rH", "headers: the table has none"),
    ],
)  # fmt: skip
def test_the_header_row_says_its_headers_too(table, keys, said):
    assert of_markdown(f"Before.\n\n{table}\n\nAfter.").press(keys)[-1] == said


NOTES = """<html><body><p>One<a epub:type="noteref" href="#n1" id="r1">1</a> stands here.</p>
<p>Two<a epub:type="noteref" href="#n2" id="r2">2</a> stands here, and again<a epub:type="noteref"
href="#n1">1</a>.</p><p>The end.</p>
<aside epub:type="footnote" id="n1"><p>The first note.</p><p>It goes on.</p></aside>
<aside epub:type="footnote" id="n2"><p>The second note. <a href="#r2">back</a></p></aside>
<aside epub:type="footnote" id="n3"><p>A note that nothing refers to.</p></aside>
</body></html>"""


@pytest.mark.parametrize(
    ("keys", "last"),
    [
        ("k\n", "line: 4"),
        ("k\n\n", "note: 1, line 1"),  # it was followed from there, though another is nearer
        (">ppp\n", "note: 1, line 2"),  # read to it: the reference before it
        (">pp\n", "note: 1, line 2"),  # from a note's second paragraph
        (">p\n", "note: 2, line 2"),  # whose link back leads no farther than to its paragraph
        (">\n", "reference: none before this"),
    ],
)
def test_enter_on_a_note_goes_back_to_its_reference(keys, last):
    source = HtmlBook.open(io.BytesIO(NOTES.encode()), "book.html")
    bench = Bench(book=Book(source, TABLE), width=60)
    assert bench.press(keys)[-1] == last


PICTURES = """# A part

![A cat](cat.png) and ![a dog](dog.png) in one line.

Between.

![A map](map.svg)

After.
"""


def test_pictures_are_gone_to_one_after_the_other():
    bench = of_markdown(PICTURES)
    assert bench.press(",,,,") == [
        "picture: A cat, line 2",
        "picture: a dog",
        "figure: A map, line 5",
        "figure: none after this",
    ]
    assert bench.press(";;") == ["picture: a dog, line 2", "picture: A cat"]


def test_a_jump_says_the_heading_it_comes_to_and_a_step_does_not():
    bench = of_markdown("# A part\n\nText.\n\n## A section\n\nMore.\n")
    assert bench.press("e") == ["heading 2: A section, line 3"]
    assert bench.press("1E") == [
        "heading of level 1: none after this",
        "heading 1: A part, line 1",
    ]
    assert bench.press("nn") == ["line: 2", "line: 3"]
    assert bench.press("b") == ["heading 2: A section, line 3"]
    assert bench.press("/part\n")[-1] == "not found after this: part"
    assert bench.press("\\part\n")[-1] == "heading 1: A part, line 1"


CONTENTS = "\n\n".join(
    f"# Part {n}\n\nText.\n\n## Section {n} of winter\n\nMore text." for n in range(1, 4)
)
ASKED = "contents: type a number or words, Enter; up and down go through the headings"


def test_the_contents_are_listed_and_a_heading_is_chosen_by_number_words_or_arrows():
    bench = of_markdown(CONTENTS)
    lines = [
        line
        for n in range(1, 4)
        for line in (f"{2 * n - 1}: Part {n}, level 1", f"{2 * n}: Section {n} of winter, level 2")
    ]
    assert bench.press("O") == [*lines, ASKED]
    assert bench.press("4\n") == ["contents: 4", "heading 2: Section 2 of winter, line 7"]
    assert bench.press("nO")[1:] == [*lines, ASKED]
    assert bench.press(["down", "up", "up", "\n"])[1:] == [  # from the heading here
        "contents: 4: Section 2 of winter, level 2",
        "contents: 3: Part 2, level 1",
        "contents: 3: Part 2, level 1",
        "heading 1: Part 2, line 5",
    ]
    said = bench.press("OPART 3\n")
    assert said[-2:] == ["contents: PART 3", "heading 1: Part 3, line 9"]
    said = bench.press("Owinter\n")
    assert said[-5:] == ["contents: winter", lines[1], lines[3], lines[5], ASKED]
    assert bench.press("2\n")[-1] == "heading 2: Section 1 of winter, line 3"
    assert bench.press("Osummer\n")[-1] == "contents: no such heading"
    assert bench.press("b") == ["heading 1: Part 3, line 9"]
    assert Bench("Plain text.").press("O") == ["contents: the book has no headings"]


def test_of_many_headings_those_of_the_upper_levels_are_said_and_words_find_the_others():
    bench = of_markdown("\n\n".join(f"# Part {n}\n\n## Below {n}" for n in range(1, 61)))
    said = bench.press("O")
    assert said[:2] == ["1: Part 1, level 1", "3: Part 2, level 1"]
    assert said[-2:] == ["contents: 120 headings; these are to level 1", ASKED]
    assert len(said) == 62
    assert bench.press("below 60\n")[-1].startswith("heading 2: Below 60, line ")


def test_the_headings_of_a_long_book_come_when_they_are_found():
    part = [Passage("A part", HEADING, 1), *[Passage("Text.")] * 5_000]
    seeker = Seeker()
    bench = Bench(book=Book(Chapters(part, part), TABLE), seeker=seeker)
    assert bench.press("O") == ["searching"]
    assert bench.press("n") == ["line: 2"]
    seeker.answers = list(Answering(bench.layout.book).answer(seeker.asked[-1]))[-1:]
    bench.run(0.05)
    assert bench.said[-3:] == ["1: A part, level 1", "2: A part, level 1", ASKED]
    bench.press(["escape", "O"])
    bench.press("/")
    seeker.answers = list(Answering(bench.layout.book).answer(seeker.asked[-1]))[-1:]
    bench.run(0.05)
    assert bench.said[-1] == "contents: not now; answer first"
    assert bench.press("x\n")[0] == "text: x"
