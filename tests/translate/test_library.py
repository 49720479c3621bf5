"""liblouis is found by its binding or without it, and no text holds up a reading for ever."""

import subprocess
import sys
import time
from threading import Thread

import pytest

from tests.translate.test_liblouis import translate
from vbraille.layout.texts import Unknown
from vbraille.translate import Book, BrailleTable, Document, Undefined
from vbraille.translate.library import call

WAYS = """
import sys
if sys.argv[1] == "alone":
    sys.modules["louis"] = None  # as if there were none
from vbraille.translate import BrailleTable, Document, list_tables
from vbraille.translate.liblouis import display_dots, library_version
loaded = sys.modules.get("louis") is not None
print(loaded, file=sys.stderr)
print(library_version(), [(t.name, t.title, t.dots) for t in list_tables()])
print(display_dots("de-eurobrl6.dis", "abc!"))
for name in ("en-ueb-g2.ctb", "fr-bfu-comp6.utb", "de-g2.ctb", "ko-g2.ctb", "zh-tw.ctb"):
    table = BrailleTable(name)
    for text in ("The child can't. 12 x 3, naïve œuvre", "한국어 中文 ~ 😀 über", "a b  c\\u0301"):
        cells = table.translate(Document.from_text(text).block(0).text)
        print(name, table.eight_dots, cells.to_unicode(), cells.starts.tolist(), cells.end)
"""


def run(*arguments, **how):
    return subprocess.run(
        [sys.executable, *arguments], capture_output=True, text=True, timeout=60, check=False, **how
    )


class TestFound:
    def test_both_ways_give_the_same_cells_and_places(self):
        with_binding, alone = run("-c", WAYS, "binding"), run("-c", WAYS, "alone")
        assert (with_binding.stderr, alone.stderr) == ("True\n", "False\n")
        assert alone.stdout == with_binding.stdout != ""

    def test_the_empty_package_of_that_name_is_none(self, tmp_path):
        (tmp_path / "louis").mkdir()
        (tmp_path / "louis" / "__init__.py").write_text("")
        alone = run("-c", WAYS, "other", cwd=tmp_path)
        assert (alone.returncode, alone.stderr) == (0, "True\n")
        assert alone.stdout == run("-c", WAYS, "binding").stdout

    def test_without_it_a_sentence_names_its_packages(self, tmp_path):
        script = (
            "import ctypes, sys; sys.modules['louis'] = None; own = ctypes.CDLL.__init__\n"
            "def none(self, name, *rest, **more):\n"
            "    if 'louis' in str(name): raise OSError(name)\n"
            "    own(self, name, *rest, **more)\n"
            "ctypes.CDLL.__init__ = none\n"
            "from vbraille.cli.app import main; sys.exit(main(['page', 'a.txt']))\n"
        )
        (tmp_path / "a.txt").write_text("text")
        done = run("-c", script, cwd=tmp_path)
        assert done.returncode == 1
        assert done.stderr.count("\n") == 1
        for package in ("apt", "dnf", "pacman", "brew"):
            assert package in done.stderr


ENDLESS = "— - —https://example.org"


class TestEndless:
    @pytest.mark.parametrize(
        ("name", "text"),
        [
            ("de-g1.ctb", ENDLESS),
            ("de-g2.ctb", ENDLESS),
            ("de-g2.ctb", "Mail an a.b -x@y.org oder so."),
            ("lv.tbl", "*1,000.5(x)2.(x)', x@y.org. "),
            ("no-no-g2.ctb", " – %ihttps://example.org]--.3-4["),
        ],
    )
    def test_a_text_that_never_ends_is_translated_word_by_word(self, name, text):
        table = BrailleTable(name)
        before = time.process_time()
        cells = translate(table, text)
        assert time.process_time() - before < 1.5
        # Each word is there, and knows its place.
        for place, character in enumerate(text.rstrip()):
            if not character.isspace():
                first, after = cells.of_source(place)
                assert cells.masks[first:after].any(), (place, character)
        words = [translate(table, word).masks.tobytes() for word in text.split()]
        assert cells.masks.tobytes().replace(b"\0", b"") == b"".join(words).replace(b"\0", b"")
        assert table.take_endless()
        assert not table.take_endless()

    def test_the_rest_of_the_book_is_read_and_it_is_said_once(self):
        table = BrailleTable("de-g2.ctb")
        text = f"Guten Tag\n\n{ENDLESS}\n\nund weiter\n\n{ENDLESS} nochmal\n\nEnde"
        book = Book(Document.from_text(text), table)
        found = []
        notes = []
        while (pair := book.block(len(found))) is not None:
            found.append(pair[1])
            notes += book.notes()
        assert len(found) == 5
        assert found[0].to_unicode() == translate(table, "Guten Tag").to_unicode()
        assert found[2].to_unicode() == translate(table, "und weiter").to_unicode()
        assert found[4].to_unicode() == translate(table, "Ende").to_unicode()
        assert len(notes) == 1
        assert "does not come to an end" in notes[0]

    def test_others_who_wait_get_their_cells(self):
        table, german = BrailleTable("en-ueb-g2.ctb"), BrailleTable("de-g1.ctb")
        expected = translate(table, "child").to_unicode()
        found = []
        others = [
            Thread(target=lambda: found.append(translate(table, "child").to_unicode()))
            for _ in range(4)
        ]
        stuck = Thread(target=lambda: translate(german, ENDLESS))
        for thread in (stuck, *others):
            thread.start()
        for thread in (stuck, *others):
            thread.join()
        assert found == [expected] * 4

    def test_a_word_of_that_kind_is_marked(self, tmp_path):
        path = tmp_path / "endless.utb"
        path.write_text(ENDLESS_TABLE)
        table = BrailleTable(str(path))
        text = "ab a-b-x@y ba " + " ".join(f"a-b-x@{'y' * n}" for n in range(2, 20))
        before = time.process_time()
        cells = translate(table, text)
        assert time.process_time() - before < 2
        marker = translate(table, table.marker).to_dots()
        assert cells[:10].to_dots() == f"1 1-2 0 {marker} 0 1-2 1 0"
        assert cells.of_source(6) == (3, 6)
        assert "a-b-x@y" in table.endless
        unknown = Unknown(table, Undefined.MARK)
        assert "does not come to an end with 19 words" in unknown.sentence
        before = time.process_time()
        assert translate(table, "a-b-x@y").to_dots() == marker
        assert time.process_time() - before < 0.5

    def test_faults_are_passed_on(self):
        with pytest.raises(ZeroDivisionError):
            call(lambda: 1 // 0)
        assert call(lambda: call(lambda: 3)) == 3


# Hyphens are blanks; a rule that takes one along has liblouis go back to the word before.
ENDLESS_TABLE = """
space \\s 0
space - 36
lowercase a 1
lowercase b 12
lowercase x 1346
lowercase y 13456
punctuation @ 4
punctuation [ 246
punctuation ] 12456
punctuation ? 236
always -x 36-1346
compbrl @
"""
