"""Tables of documents that follow from the program; `python -m tests.documents` writes them."""

import inspect
import re
import textwrap
from pathlib import Path
from typing import get_args

from vbraille.config.options import BOOK, FILE, PROFILE, held_in
from vbraille.reading.commands.scene import COMMANDS as FEELING
from vbraille.reading.commands.table import COMMANDS as READING
from vbraille.sessions.record.events import OTHER, AnyEvent, AnyTime, InTrial, WithStimulus

DOCS = Path(__file__).parents[1] / "docs"


def _value(option):
    """The value of an option, in words."""
    if option.choices:
        return " or ".join(f"`{name}`" for name in option.choices)
    words = {bool: "true or false", int: "a whole number", float: "a number"}
    bounds = "" if option.low is None else f", {option.low:g} to {option.high:g}"
    return f"{words.get(option.kind, 'a text')}{bounds} {option.unit}".rstrip()


def _row(*parts):
    return f"| {' | '.join(part.replace('|', chr(92) + '|') for part in parts)} |"


def _read():
    yield _row("key", "value", "what it does", "usual", "kept with a book")
    for option in held_in(FILE):
        kept = "yes" if BOOK in option.holds else ""
        usual = option.usual or "false"
        yield _row(f"`{option.key}`", _value(option), option.does, usual, kept)


def _profile():
    yield _row("value", "what it may be", "what it does", "usual")
    for option in held_in(PROFILE):
        yield _row(f"`{option.key}`", _value(option), option.does, option.usual)


def _keys(commands):
    yield _row("command", "keys", "what it does", "when")
    for command in commands:
        when = ", ".join(context.value for context in command.contexts)
        yield _row(f"`{command.name}`", command.spoken_keys, command.help, when)


def described(kind):
    """First sentence of a class's docstring, and what it says of each field of its own."""
    text = inspect.cleandoc(kind.__doc__)
    said, _, fields = text.partition("\n\nParameters\n----------\n")
    found = re.findall(r"^(\w.*)\n((?:    .*\n?)+)", fields, re.MULTILINE)
    return " ".join(said.split()), {names: " ".join(told.split()) for names, told in found}


def members(fields):
    """Say fields in a cell of a table."""
    return " ".join(f"`{names.replace(', ', '`, `')}`: {told}" for names, told in fields.items())


def _events():
    yield "| event | what happened | other members |"
    for kind in get_args(AnyEvent):
        said, fields = described(kind)
        given = "with a stimulus" if issubclass(kind, WithStimulus) else ""
        given = given or ("in a trial" if issubclass(kind, InTrial) else "")
        given = given or ("at any time" if issubclass(kind, AnyTime) else "")
        name = f"`{kind.__struct_config__.tag}`" + (" *" if kind.durable else "")
        cells = (name, said + (f" ({given})" if given else ""), members(fields))
        yield "| " + " | ".join(cells) + " |"


def _bytes():
    told = [f"`{kind.__struct_config__.tag}` {kind.code}" for kind in get_args(AnyEvent)]
    said = ", ".join([*told, f"any other {OTHER}"])
    return "\n".join(textwrap.wrap(said, 118, break_on_hyphens=False))


# Each document with its tables, which begin with the first row of each.
TABLES = (
    ("settings.md", list(_read())),
    ("settings.md", list(_profile())),
    ("keys.md", list(_keys(READING))),
    ("feeling.md", list(_keys(FEELING))),
    ("session-format.md", list(_events())),
)
# Each document with its other parts: the words that stand around one, and the part itself.
PARTS = (("session-format.md", "<!-- bytes: begin -->\n", "\n<!-- bytes: end -->", _bytes()),)


def with_table(text, rows):
    """A document in which the table that begins with the first row has these rows."""
    first, *others = rows
    table = "\n".join((first, "|" + "---|" * (first.count("|") - 1), *others, ""))
    start = text.index(f"{first}\n")
    found = re.compile(r"(?:\|.*\n)+").match(text, start)
    return text[:start] + table + text[found.end() :]


def with_part(text, begin, end, part):
    """A document in which a part stands between these words."""
    before, _, rest = text.partition(begin)
    return before + begin + part + end + rest.partition(end)[2]


if __name__ == "__main__":
    for name, rows in TABLES:
        page = DOCS / name
        page.write_text(with_table(page.read_text(encoding="utf-8"), rows), encoding="utf-8")
    for name, *part in PARTS:
        page = DOCS / name
        page.write_text(with_part(page.read_text(encoding="utf-8"), *part), encoding="utf-8")
