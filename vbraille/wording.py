"""Words for counts, durations, and characters that a terminal would obey."""

from __future__ import annotations

TYPE_CHECKING = False  # importing typing, for its constant, takes as long as all the rest
if TYPE_CHECKING:
    from collections.abc import Iterable

_NAMES = {0: "null", 7: "bell", 8: "backspace", 9: "tab", 10: "line feed", 11: "vertical tab"}
_NAMES |= {12: "form feed", 13: "carriage return", 27: "escape", 127: "delete"}
# Settings that a program gives by another name than the command line does.
_OPTIONS = {"folder": "out"}
_CONTROLS = {
    code: f"<{_NAMES.get(code) or (f'control {chr(code + 64)}' if code < 32 else f'{code:02x}')}>"
    for code in (*range(0x20), *range(0x7F, 0xA0))
}


def printable(text: str) -> str:
    r"""Text in which control characters are named, as in "<escape>[2J".

    A book may hold any, and so may a name; a terminal would move its cursor or change how it
    works. A line break, too, is one.

    >>> printable("no\x1b[2J\x07")
    'no<escape>[2J<bell>'
    """
    return text.translate(_CONTROLS)


def setting(name: str) -> str:
    """A setting of the program in a message, by its name alone; `spelled` says how it is given.

    What is below the command line does not know how a user gives it: there, a message names it so,
    and stays readable to callers without a command line.
    """
    return f"\u2039{name}\u203a"


def spelled(message: str) -> str:
    """A message in which the settings are named as a command line has them.

    >>> spelled(f"choose another {setting('model')}")
    'choose another --model'
    """
    import re  # takes longer to load than all else that a command line needs to begin

    return re.sub(
        "\u2039([a-z-]+)\u203a", lambda found: f"--{_OPTIONS.get(found[1], found[1])}", message
    )


def nearest(name: str, names: Iterable[str], most: int = 1, lead: str = "; ") -> str:
    """Sentence part that names what comes near to an unknown name, the nearest first.

    It is empty if nothing comes near enough to be what was meant.

    Parameters
    ----------
    name
        Name that the user wrote.
    names
        All names that there are.
    most
        Largest number of names that are said.
    lead
        What joins the part to the sentence.

    >>> nearest("lenght", ["length", "repeats"])
    '; the nearest is length'
    >>> nearest("lenght", ["length", "repeats", "strength"], 2)
    '; the nearest are length, strength'
    >>> nearest("model", ["grade", "table"])
    ''
    """
    import difflib  # takes long to load, like re

    close = difflib.get_close_matches(name, list(names), most, cutoff=0.5)
    if not close:
        return ""
    return f"{lead}the nearest {'is' if len(close) == 1 else 'are'} {', '.join(close)}"


def count(number: int, noun: str) -> str:
    """A number with its noun.

    >>> count(1, "line"), count(2, "line"), count(1234, "frame")
    ('1 line', '2 lines', '1234 frames')
    """
    return f"{number} {noun}" if number == 1 else f"{number} {noun}s"


def duration(seconds: float) -> str:
    """Words for about how long something takes, in seconds, minutes or hours.

    >>> duration(9.4), duration(754), duration(12_600)
    ('9 s', '13 min', '3.5 h')
    """
    if seconds < 99.5:
        return f"{seconds:.0f} s"
    if seconds < 99.5 * 60:
        return f"{seconds / 60:.0f} min"
    return f"{seconds / 3600:.3g} h"
