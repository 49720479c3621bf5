"""Keys out of a terminal's bytes, however they are cut into reads."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from vbraille.reading.keys import BURST, PASTE, PASTE_REST, Keys, pasted

NAMES = {
    "\x1b[A": "up",
    "\x1b[B": "down",
    "\x1b[C": "right",
    "\x1b[D": "left",
    "\x1b[H": "home",
    "\x1bOF": "end",
    "\x1b[1~": "home",
    "\x1b[3~": "delete",
    "\x1b[5~": "pageup",
    "\x1b[6~": "pagedown",
    "\x1bOP": "f1",
    "\x1b[[A": "f1",
    "\x1b[[E": "f5",
    "\x1b[15~": "f5",
    "\x1b[21~": "f10",
    "\x1b[24~": "f12",
    "\x1b[Z": "backtab",
    "\x1b[1;5C": "ctrl-right",
    "\x1b[5D": "ctrl-left",
    "\x1b[25~": "f13",
    "\x1bOT": "f5",
    "\x1b[1;2A": "shift-up",
    "\x1b[3;4~": "shift-alt-delete",
    "\x1bx": "alt-x",
    "n": "n",
    "T": "T",
    " ": " ",
    "é": "é",
    "字": "字",
    "😀": "😀",
    "\x04": "\x04",
    "\x1b[99~": None,
    "\x1b[24;80R": None,
    "\x1b[?1;2c": None,
    "\x1b[I": None,
    "\x1b[201~": None,
    "\x1b[200~n\nq\x1b[31mé\x1b[201~": PASTE + "n",
    "\x1b[200~an é\x1b[31m\x1b[201~": PASTE + "an é\x1b[31m",
}


FS = [f"f{n}" for n in range(1, 13)]
TURNED = ["ctrl-up", "ctrl-down", "ctrl-right", "ctrl-left"]
_TILDE = " ".join(f"\x1b[{n}~" for n in (15, 17, 18, 19, 20, 21, 23, 24))
_XTERM_FS = f"\x1bOP \x1bOQ \x1bOR \x1bOS {_TILDE}"
_XTERM_TURNED = "\x1b[1;5A \x1b[1;5B \x1b[1;5C \x1b[1;5D"
# What terminals send, by their terminfo and manuals: home, end, page up and down, F1 to F12, and
# arrows with Ctrl, which the Linux console sends as without.
SENT = {
    "xterm": ("\x1b[H \x1b[F", _XTERM_FS, _XTERM_TURNED),
    "xterm, application": ("\x1bOH \x1bOF", _XTERM_FS, _XTERM_TURNED),
    "linux": ("\x1b[1~ \x1b[4~", f"\x1b[[A \x1b[[B \x1b[[C \x1b[[D \x1b[[E {_TILDE[6:]}", ""),
    "tmux": ("\x1b[1~ \x1b[4~", _XTERM_FS, _XTERM_TURNED),
    "putty": (
        "\x1b[1~ \x1b[4~",
        f"\x1b[11~ \x1b[12~ \x1b[13~ \x1b[14~ {_TILDE}",
        "\x1bOA \x1bOB \x1bOC \x1bOD",
    ),
    "rxvt": (
        "\x1b[7~ \x1b[8~",
        f"\x1b[11~ \x1b[12~ \x1b[13~ \x1b[14~ {_TILDE}",
        "\x1bOa \x1bOb \x1bOc \x1bOd",
    ),
}


@pytest.mark.parametrize("terminal", SENT)
def test_what_terminals_send(terminal):
    ends, functions, turned = (sent.replace(" ", "").encode() for sent in SENT[terminal])
    keys = Keys()
    assert keys.feed(ends + b"\x1b[5~\x1b[6~", 0.0) == ["home", "end", "pageup", "pagedown"]
    assert keys.feed(functions, 0.1) == FS
    assert keys.feed(b"\x1b[A\x1b[B", 0.2) == ["up", "down"]
    assert keys.feed(turned, 0.3) == (TURNED if turned else [])


def test_arrows_of_a_terminal_that_always_sends_them_in_the_other_way_are_arrows():
    keys = Keys()
    for n in range(3):
        assert keys.feed(b"\x1bOA\x1bOD", n) == ["up", "left"]


@pytest.mark.parametrize("sent", NAMES, ids=repr)
def test_the_table(sent):
    keys = Keys()
    assert keys.feed(sent.encode() + b"q", 0.0) == [*filter(None, [NAMES[sent]]), "q"]
    assert keys.wait(9.0) == []


@given(st.lists(st.sampled_from(list(NAMES)), max_size=BURST // 2 - 1), st.data())
def test_it_does_not_matter_where_reads_end(sent, data):
    typed = "".join(sent).encode()
    cuts = data.draw(st.lists(st.integers(0, len(typed)), max_size=8))
    keys, pressed, last = Keys(), [], 0
    for cut in [*sorted(cuts), len(typed)]:
        pressed += keys.feed(typed[last:cut], 0.0)
        pressed += keys.wait(0.04)
        last = cut
    assert pressed == [name for key in sent if (name := NAMES[key])]


def test_an_escape_alone_is_one_after_half_a_second():
    keys = Keys()
    assert keys.feed(b"\x1b", 1.0) == []
    assert keys.wait(1.499) == []
    assert keys.wait(1.501) == ["escape"]
    assert keys.feed(b"[A", 1.51) == ["[", "A"]
    assert keys.feed(b"\x1b\x1b[A", 2.0) == ["escape", "up"]


@pytest.mark.parametrize("sent", [sent for sent in NAMES if sent[0] == "\x1b" and len(sent) > 2])
def test_a_slow_line_may_bring_a_key_in_bytes_that_are_100_ms_apart(sent):
    keys, pressed = Keys(), []
    for n, byte in enumerate(sent.encode()):
        pressed += keys.feed(bytes([byte]), n / 10)
        pressed += keys.wait(n / 10 + 0.099)
    assert pressed + keys.wait(n / 10 + 9) == [*filter(None, [NAMES[sent]])]


@pytest.mark.parametrize(
    ("then", "pressed"),
    [("n", ["n"]), ("é", ["é"]), ("O", ["O"]), ("[", ["["]), ("O2", ["O", "2"]), ("\n", ["\n"])],
)
def test_keys_pressed_soon_after_an_escape_are_no_part_of_it(then, pressed):
    keys, found = Keys(), []
    for n, key in enumerate(["\x1b", *then]):
        found += keys.feed(key.encode(), n / 5)
        found += keys.wait(n / 5 + 0.199)
    assert found + keys.wait(n / 5 + 0.51) == ["escape", *pressed]


def test_a_sequence_that_does_not_go_on_is_given_up():
    keys = Keys()
    assert keys.feed(b"\x1b[1;", 0.0) == []
    assert keys.wait(0.9) == []
    assert keys.wait(1.1) == []
    assert keys.feed(b"n", 1.2) == ["n"]
    assert keys.feed(b"\x1b[1\x1b[B", 2.0) == ["down"]
    assert keys.feed(b"\x1b[" + b";" * 70, 3.0) == []
    assert keys.feed(b"n", 3.1) == ["n"]  # so long a sequence is none


@given(st.lists(st.binary(max_size=40), max_size=20))
def test_no_bytes_are_a_fault_and_all_are_over_after_a_second(pieces):
    keys = Keys()
    for n, piece in enumerate(pieces):
        assert all(keys.feed(piece, n / 100))
    keys.wait(9.0)
    assert keys.feed(b" q", 9.1)[-1] == "q"


def test_a_paste_is_one_key_however_long_and_ends():
    keys = Keys()
    assert keys.feed(b"t\x1b[200~nq", 0.0) == ["t"]
    for n in range(100):
        assert keys.feed(b"nq\n\x1b[A" * 500, 0.1 * n) == []
    assert keys.feed(b"q\x1b[20", 10.0) == []
    assert keys.feed(b"1~n", 10.1) == [PASTE + "nqnq", "n"]
    assert keys.feed(b"\x1b[200~nq", 11.0) == []
    assert keys.wait(12.1) == [PASTE + "nq"]  # its end never came
    assert keys.wait(19.1) == []
    assert keys.feed(b"n", 12.2) == ["n"]


def test_a_burst_of_characters_is_a_paste_that_nobody_has_marked():
    keys = Keys()
    assert keys.feed(b"n" * 100, 0.0) == ["n"] * 100  # a key held down
    assert keys.feed(b"\x1b[B" * 100, 0.2) == ["down"] * 100
    assert keys.feed(b"nnnppptttq", 0.4) == [*"nnnppptttq"]
    assert keys.feed(b"a text that was pasted, and q", 0.6) == [
        PASTE + "a text that was pasted, and q"
    ]
    assert keys.feed(b"uit\nno", 0.65) == [PASTE_REST + "uit"]  # the rest of its first line
    assert keys.feed(b"more", 0.7) == []
    assert keys.feed(b"n", 0.9) == ["n"]


def test_no_more_of_a_paste_is_kept_than_anybody_types():
    keys = Keys()
    (key,) = keys.feed(b"\x1b[200~" + b"a" * 5_000 + b"\x1b[201~", 0.0)
    assert pasted(key) == "a" * 1_000
    assert [pasted(key) for key in ("n", "escape", "p", PASTE)] == [None, None, None, ""]
