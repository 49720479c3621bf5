"""What a terminal sends for keys, to the names of keys, however it is cut into reads.

A terminal sends characters, and escape sequences for the keys that are none. Both may come in
pieces: what is unfinished is kept until the rest comes.
"""

from __future__ import annotations

import codecs
import re

PASTE = "paste:"  # before the first line of a pasted text, the two of which stand for one key
PASTE_REST = "paste, rest:"  # before more of that line, which comes when it was taken for all
ESC, ESCAPE = "\x1b", "escape"
PASTE_ON, PASTE_OFF = b"\x1b[?2004h", b"\x1b[?2004l"  # switch marks around pasted text on and off
# An Escape that nothing follows for so long is the key Escape: a slow line may take as long to
# bring the rest of an arrow, and readline waits as long (keyseq-timeout).
ESCAPE_S = 0.5
_ALT_S = 0.05  # what comes later than this after an Escape, and goes on no sequence, is a key alone
BROKEN_S = 1.0  # the rest of a sequence or of a paste does not come so long after its last byte
# So many different characters in one read are no typing: they are a paste that is not marked.
BURST = 20
_BURST_S = 0.1  # what comes so soon after such a paste belongs to it
_LONGEST = 64  # characters of a sequence; a longer one is none
_LONGEST_PASTE = 1_000  # characters that are kept of one
_LINE_END = re.compile(r"[\n\r]")

# The one table of sequences (ECMA-48 5.4, xterm, the Linux console, tmux, PuTTY, rxvt). The end of
# a sequence names the key, or the number before a ~ does; a number after a semicolon says what was
# held with it.
_LETTERS = {
    "A": "up",
    "B": "down",
    "C": "right",
    "D": "left",
    "F": "end",
    "H": "home",
    "P": "f1",
    "Q": "f2",
    "R": "f3",
    "S": "f4",
    "Z": "backtab",
    **{f"[{letter}": f"f{n}" for n, letter in enumerate("ABCDE", 1)},
}
_NUMBERS = {
    **dict(enumerate(("home", "insert", "delete", "end", "pageup", "pagedown", "home", "end"), 1)),
    **{number: f"f{n}" for n, number in enumerate((*range(11, 16), *range(17, 22), 23, 24), 1)},
    **{number: f"f{n}" for n, number in enumerate((25, 26, 28, 29, 31, 32, 33, 34), 13)},
}
_ARROWS = frozenset("ABCD")
# After ESC O only: what PuTTY sends as a VT100+ for more function keys, and rxvt with Ctrl.
_SINGLE = {
    **{letter: f"f{n}" for n, letter in enumerate("TUVWXYZ", 5)},
    **{letter.lower(): f"ctrl-{_LETTERS[letter]}" for letter in "ABCD"},
}
_PASTE_BEGINS, _PASTE_ENDS = 200, "\x1b[201~"
HELD = ("shift-", "alt-", "ctrl-", "meta-")  # one for each bit of the number less 1

NAMED = frozenset((*_LETTERS.values(), *_NUMBERS.values(), ESCAPE))  # keys that have words

_KEY = re.compile(
    r"\x1b(?:\[(?P<first>[0-9]{0,4})(?:;(?P<held>[0-9]{1,4}))?(?P<end>\[[A-E]|[@-Z\\-~])"
    r"|O(?P<letter>[!-~])"
    r"|\[[0-?]*[ -/]*[@-Z\\-~]"  # other sequences, as a whole
    r"|(?P<alt>[^\x1b\[O]))"
    r"|(?P<character>[^\x1b])",
    re.DOTALL,
)
_BEGUN = re.compile(r"\x1b(?:\[(?:\[|[0-?]*[ -/]*)|O)?")


def pasted(key: str) -> str | None:
    """First line of a pasted text, or the rest of that; None for a key that was typed."""
    for prefix in (PASTE, PASTE_REST):
        if key.startswith(prefix):
            return key.removeprefix(prefix)
    return None


class _FirstLine:
    """First line of a text that comes in pieces; no more than anybody types is kept of it."""

    def __init__(self) -> None:
        self.text = ""
        self._ended = False

    def add(self, piece: str) -> str:
        """Take a piece of the text, and give what of it belongs to the line."""
        if self._ended:
            return ""
        line = _LINE_END.split(piece, maxsplit=1)
        self._ended = len(line) > 1
        more = line[0][: _LONGEST_PASTE - len(self.text)]
        self.text += more
        return more


class Keys:
    """Names of keys out of a terminal's bytes.

    A character is its own name. Arrows, function keys and the like have words, what was held
    with them before: "up", "ctrl-right", "f5", "alt-x". "escape" is the key alone. A whole pasted
    text is one key that begins with `PASTE`; see `pasted`. Sequences that are not in the table
    give nothing.
    """

    def __init__(self) -> None:
        self._decoder = codecs.getincrementaldecoder("utf-8")("ignore")
        self._tail = ""
        self._pasting = False
        self._pasted = _FirstLine()
        self._plain_arrows = False  # whether an arrow came as ESC [, as it does by itself
        self._apart = False  # whether the rest of a sequence came later than its Escape
        self._fed_s = 0.0
        self._burst_end_s = float("-inf")

    def feed(self, typed: bytes, now_s: float) -> list[str]:
        """Names of the keys that these bytes, which came now, complete."""
        late, self._fed_s = now_s - self._fed_s >= _ALT_S, now_s
        more = self._decoder.decode(typed)
        keys: list[str] = []
        if self._tail == ESC and more:
            self._apart = late
            if late and more[0] not in "[O":
                keys, self._tail = [ESCAPE], ""
        self._tail += more
        keys += self._take()
        plain = [key for key in keys if len(key) == 1]
        within = now_s < self._burst_end_s
        if not within and (len(plain) < BURST or len(set(plain)) == 1):
            return keys
        self._burst_end_s = now_s + _BURST_S
        if not within:
            self._pasted = _FirstLine()
        more = self._pasted.add("".join(plain))
        if not within:
            return [PASTE + more]
        return [PASTE_REST + more] if more else []

    def wait(self, now_s: float) -> list[str]:
        """Keys that are complete because nothing has come until now."""
        since_s = now_s - self._fed_s
        if self._tail == ESC and not self._pasting and since_s >= ESCAPE_S:
            self._tail = ""
            return [ESCAPE]
        if self._apart and self._tail in (f"{ESC}[", f"{ESC}O") and since_s >= ESCAPE_S:
            after, self._tail = self._tail[1], ""
            return [ESCAPE, after]  # two keys that somebody pressed quickly
        if since_s >= BROKEN_S:
            ended, self._pasting = self._pasting, False
            tail, self._tail = self._tail, ""
            if ended:  # the mark of its end was lost
                self._pasted.add(tail)
                return [PASTE + self._pasted.text]
        return []

    def _take(self) -> list[str]:
        """Take complete keys off the bytes that wait."""
        keys: list[str] = []
        while self._tail:
            if self._pasting:
                text, ends, after = self._tail.partition(_PASTE_ENDS)
                if not ends:  # the end's mark may have come in part
                    cut = max(len(text) + 1 - len(_PASTE_ENDS), 0)
                    self._pasted.add(text[:cut])
                    self._tail = text[cut:]
                    break
                self._pasted.add(text)
                self._pasting, self._tail = False, after
                keys.append(PASTE + self._pasted.text)
                continue
            found = _KEY.match(self._tail)
            begun = _BEGUN.match(self._tail)
            if found is not None:
                self._tail = self._tail[found.end() :]
                key = self._name(found)
                if not key and self._apart and found["letter"]:
                    keys += [ESCAPE, "O"]
                    key = found["letter"]
                self._apart = False
            elif begun is not None and begun.end() == len(self._tail) < _LONGEST:
                break
            else:  # an Escape before another key, or an unknown sequence
                assert begun is not None, "whatever does not begin with Escape is a key"
                self._tail = self._tail[begun.end() :]
                key = ESCAPE if begun.end() == 1 else ""
            if key:
                keys.append(key)
        return keys

    def _name(self, found: re.Match[str]) -> str:
        if found["character"]:
            return found["character"]
        if found["alt"]:
            return f"alt-{found['alt']}"
        if found["letter"]:
            return self._single(found["letter"])
        if found["end"] is None:
            return ""
        if found["end"] == "~":
            number = int(found["first"] or 0)
            if number == _PASTE_BEGINS:
                self._pasting, self._pasted = True, _FirstLine()
                return ""
            name = _NUMBERS.get(number, "")
            held = int(found["held"] or 1) - 1
        else:
            first, held = int(found["first"] or 1), int(found["held"] or 1) - 1
            if found["end"] in _ARROWS and first > 1 and not held:
                first, held = 1, first - 1  # as older terminals say what was held
            self._plain_arrows |= found["end"] in _ARROWS and not held
            name = _LETTERS.get(found["end"], "") if first == 1 else ""
        prefix = "".join(word for bit, word in enumerate(HELD) if held >> bit & 1)
        return f"{prefix}{name}" if name else ""

    def _single(self, letter: str) -> str:
        """Name of a key that is ESC O and a letter.

        A terminal sends arrows so if another program left it in that mode, or always (Emacs); but
        if arrows come as ESC [, this is PuTTY's way to say that Ctrl was held.
        """
        name = _SINGLE.get(letter) or _LETTERS.get(letter, "")
        return f"ctrl-{name}" if letter in _ARROWS and self._plain_arrows else name
