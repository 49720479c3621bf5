"""Keys and buttons of a reader's own."""

from pathlib import Path

import pytest

from tests.reading.test_reader import TEXT, Bench
from vbraille.config.options import OPTIONS
from vbraille.config.settings import parse_settings
from vbraille.errors import InputError
from vbraille.reading.commands.table import KEY_SETS, bound_by
from vbraille.reading.device import SETTLED_S, KnobTurns
from vbraille.reading.keys import Bindings, Context
from vbraille.reading.outputs import Echo
from vbraille.translate import Book, BrailleTable
from vbraille.translate.documents.html import HtmlBook
from vbraille.translate.documents.markup.tree import read_tree

NVDA = """<p>First.<h1>A heading</h1><h2>A lower heading</h2><ul><li>An item<li>Another item</ul>
<table><tr><td>A cell</table><blockquote>A quotation</blockquote><p><img src="p.png"
alt="A picture"><p><a href="#x">A link</a><p><a href="#x">Another link</a>"""


def bench_with(keys=None, buttons=None, **options):
    bound = bound_by(Bindings(keys or {}, buttons or {}))
    return Bench(TEXT, bound=bound, **options)


def test_a_key_is_moved_to_another_command_and_help_says_so():
    bench = bench_with({"LNDN": ("j",), "PAUSE": ("space", "P"), "SPEAK_CURR_WORD": ("n",)})
    assert bench.press("jn") == ["line: 2", "word: none here"]
    assert bench.press(["down"]) == ["no command: down; h says the keys"]
    assert bench.press("P ") == ["paused", "reading"]
    said = bench.press("h")
    assert "j: next line" in said
    assert "space or shift-p: rest the array at once, or go on" in said
    assert "n: say the word under the finger" in said


def test_a_key_that_is_taken_leaves_its_command_the_others():
    bench = bench_with({"HELP": ("n",)})
    assert bench.press(["down"]) == ["line: 2"]
    assert bench.press("é") == ["no command: é; n says the keys"]
    assert bench.reader.bound.keys_of("LNDN") == ("down",)


def test_a_key_of_reading_is_still_typed_and_enter_still_ends_a_text():
    bench = bench_with({"LNDN": ("enter",)})
    assert bench.press("\n") == ["line: 2"]
    assert bench.press("/seven\n")[1:] == ["text: seven", "line: 3"]


@pytest.mark.parametrize(
    ("keys", "buttons", "sentence"),
    [
        ({"LNDWN": ("n",)}, {}, "there is no command 'LNDWN'; the nearest is LNDN"),
        ({"lndn": ("n",)}, {}, "there is no command 'lndn'; the nearest is LNDN"),
        ({"LNDN": ("x",), "LNUP": ("x",)}, {}, "key x calls both LNDN and LNUP"),
        ({"LNDN": ("x", "x")}, {}, "key x calls both LNDN and LNDN"),
        ({"LNDN": ("n", "dowm")}, {}, "there is no key 'dowm'; the nearest is down"),
        ({"LNDN": ("ctrl-dwn",)}, {}, "there is no key 'ctrl-dwn'; the nearest is down"),
        ({"LNDN": ("",)}, {}, "there is no key ''"),
        ({"QUIT": ()}, {}, "no key calls QUIT"),
        ({}, {"1": "LNDWN"}, "there is no command 'LNDWN'; the nearest is LNDN"),
        ({}, {"one": "LNDN"}, "'one' is no button; write a number"),
        ({}, {"knob 1": "CONTRST"}, "there is no value of the tuning 'CONTRST'; the nearest is"),
    ],
)
def test_what_cannot_be_is_one_sentence(keys, buttons, sentence):
    with pytest.raises(InputError, match="settings: ") as raised:
        bound_by(Bindings(keys, buttons))
    assert sentence in str(raised.value)
    assert "\n" not in str(raised.value)


def test_a_fault_among_keys_says_its_line():
    def where(*keys):
        return f"settings.toml line {1 if keys == ('keys', 'LNDN') else 2}"

    with pytest.raises(InputError, match=r"^settings\.toml line 2: key x calls both"):
        bound_by(Bindings({"LNDN": ("x",), "LNUP": ("x",)}, {}, where))
    with pytest.raises(InputError, match=r"^settings\.toml line 1: there is no key 'spcae'"):
        bound_by(Bindings({"LNDN": ("spcae",)}, {}, where))


@pytest.mark.parametrize(
    ("written", "sent"),
    [
        ("Down", "down"),
        ("F12", "f12"),
        ("ctrl-shift-left", "shift-ctrl-left"),
        ("alt-x", "alt-x"),
        ("alt-space", "alt- "),
        ("ctrl-d", "\x04"),
        ("shift-tab", "backtab"),
        ("escape", "escape"),
        ("full stop", "."),
        ("Shift-A", "A"),
        ("shift-é", "É"),
        ("alt-comma", "alt-,"),
        ("ctrl-i", "\t"),
        ("ctrl-backslash", "\x1c"),
    ],
)
def test_a_key_is_written_as_people_say_it(written, sent):
    bench = bench_with({"LNDN": (written,)})
    assert bench.press([sent]) == ["line: 2"]


@pytest.mark.parametrize(
    ("sent", "name"),
    [
        (".", "full stop"),
        ("'", "apostrophe"),
        ("\x0c", "ctrl-l"),
        ("\x00", "ctrl-space"),
        ("\x1f", "ctrl-underscore"),
        ("A", "shift-a"),
        ("É", "shift-é"),
        ("alt-.", "alt-full stop"),
        ("alt-\x0c", "alt-ctrl-l"),
        ("-", "minus"),
        ("é", "é"),
        ("ß", "ß"),
        ("\u200b", "character 200b"),
    ],
)
def test_keys_are_named_in_words_that_speech_says(sent, name):
    bench = bench_with(stay=True)
    assert bench.press(["?", sent])[1].startswith(f"{name}: ")


def test_options_and_settings_know_the_ready_sets():
    assert tuple(KEY_SETS) == OPTIONS["keys"].choices
    for keys in KEY_SETS:
        settings = parse_settings(f'[read]\nkeys = "{keys}"\n', Path("settings.toml"))
        assert settings.read["keys"] == keys


@pytest.mark.parametrize("keys", KEY_SETS)
def test_every_key_has_a_name_that_speech_says_and_settings_take(keys):
    bound = bound_by(Bindings(), keys)
    for command in bound.commands:
        names = bound.keys_of(command.name)
        assert names
        assert not any(set(name) & set("!\"#$%&'()*+,./:;<=>?@[\\]^_`{|}~") for name in names)
        if command.keys != ("any key",):
            again = bound_by(Bindings({command.name: names}), keys)
            assert again.find(command.keys[-1], command.contexts[0]).name == command.name


def test_nvda_s_letters_go_where_its_users_expect():
    root, _ = read_tree(NVDA.encode(), "book.html", xml=False, encoding="utf-8")
    book = Book(HtmlBook(root, "book.html", "0" * 64), BrailleTable("en-ueb-g1.ctb"))
    bound = bound_by(Bindings(), "nvda")
    bench = Bench(book=book, width=40, echo=Echo.TEXT, bound=bound)
    for keys, text in {
        "h": "A heading",
        "2": "A lower heading",
        "l": "• An item",
        "i": "• Another item",
        "I": "• An item",
        "t": "A cell",
        "q": "A quotation",
        "g": "A picture",
        "k": "A link",
        "\t": "Another link",
        "L": "• An item",
        "H": "A lower heading",
        "p": "• An item",
    }.items():
        assert bench.press(keys)[-1] == f"text: {text}", keys
    assert bench.press("Q")[-1] == "quotation: none before this"
    assert not bench.reader.done
    assert bench.press(["f7"])[-1].startswith("contents: type a number")
    bench.press(["escape", "\x04"])
    assert bench.reader.done


def test_keys_of_somebody_s_own_come_before_a_ready_set():
    bound = bound_by(Bindings({"LNDN": ("h",), "NXHEADING": ("n",)}), "nvda")
    assert bound.keys_of("LNDN") == ("h",)
    assert bound.keys_of("NXHEADING") == ("n",)
    assert bound.keys_of("PRHEADING") == ("shift-h",)
    assert bound.find("h", Context.READING).name == "LNDN"


def test_a_button_does_what_its_command_does():
    bench = bench_with(buttons={"1": "LNDN", "button 2": "NXSEARCH"})
    bench.reader.press_button(1)
    assert bench.said == ["line: 2"]
    bench.reader.press_button(2)
    bench.reader.press_button(1)
    assert bench.said[1:] == ["search: type the text, Enter", "button 1: not now; answer first"]
    bench.press(["escape"])
    bench.reader.press_button(3)
    assert bench.said[-1] == "button 3: no command; the settings file can give it one"


def test_a_knob_gives_its_value_once():
    bench, turns = bench_with(buttons={"knob 2": "CONTRAST"}), KnobTurns()
    for number, share in ((2, 0.504), (2, 0.501), (1, 0.3)):
        turns.turn(bench.reader, number, share, 0.0)
        turns.settle(bench.reader, SETTLED_S)
    assert bench.said == ["contrast: 0.5"]
    assert bench.reader.style.tuning.contrast == 0.5


def test_a_knob_is_felt_while_it_is_turned_and_said_when_it_is_left():
    bench, turns = bench_with(buttons={"knob 2": "CONTRAST"}), KnobTurns()
    for step in range(50):
        turns.turn(bench.reader, 2, 0.5 + step / 100, step / 50)
        turns.settle(bench.reader, step / 50)
        assert bench.reader.style.tuning.contrast == pytest.approx(0.5 + step / 100)
    assert bench.said == []
    for later_s in (SETTLED_S - 0.01, SETTLED_S, 1.0):
        turns.settle(bench.reader, 49 / 50 + later_s)
    assert bench.said == ["contrast: 0.99"]


def test_learning_a_key_says_what_it_does_and_does_nothing():
    bench = bench_with(buttons={"1": "LNUP"})
    for ends in ("?", "q"):
        assert bench.press("?") == ["learn: a key says what it does; this key again or q ends it"]
        assert bench.press("n é") == [
            "n: next line",
            "space: rest the array at once, or go on",
            "é: no command",
        ]
        bench.reader.press_button(1)
        assert bench.said[-1] == "button 1: previous line"
        assert bench.reader.line.number == 1
        assert not bench.engine.paused
        assert bench.press(ends) == ["learn: off"]
        assert bench.reader.context is Context.READING
        assert not bench.reader.done
    assert bench.press("n") == ["line: 2"]
