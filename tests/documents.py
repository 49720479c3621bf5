"""Tables of documents that follow from the program; `python -m tests.documents` writes them."""

import inspect
import json
import re
import textwrap
from pathlib import Path
from typing import get_args

from msgspec import inspect as info

from tests.commandline import commands
from tests.scene import keyspage
from vbraille.braille.geometry import Geometry
from vbraille.cli.options import SHARED
from vbraille.reading.commands import Where, keys_of, spoken, table
from vbraille.render import Tuning
from vbraille.sessions.planning.protocol import Protocol, ProtocolFile
from vbraille.sessions.record.events import (
    OTHER,
    AnyEvent,
    AnyTime,
    InTrial,
    Presented,
    WithStimulus,
)

DOCS = Path(__file__).parents[1] / "docs"


def _row(*parts):
    return f"| {' | '.join(part.replace('|', chr(92) + '|') for part in parts)} |"


def _settings():
    yield _row("option", "what it does")
    told = {}
    for _, command in commands():
        for param in command.params:
            if param.name in SHARED and param.name not in told:
                told[param.name] = param.help
    for name, does in sorted(told.items()):
        yield _row(f"`{name}`", does)


def _keys(where):
    yield _row("command", "keys", "NVDA's keys", "buttons", "what it does")
    for each in table(where):
        keys = [" or ".join(map(spoken, keys_of(each, name))) for name in ("usual", "nvda")]
        buttons = ", ".join(spoken(key) for key in each.also)
        yield _row(f"`{each.name}`", *keys, buttons, each.help)


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


_KINDS = {
    info.IntType: "whole number", info.FloatType: "number", info.StrType: "text",
    info.BoolType: "`true` or `false`",
}  # fmt: skip
_CELLS = {"Mask": "cell", "Masks": "cells", "SpellingKeys": "table of cells"}


def _kinds(kind):
    """Words for what a key of a protocol may be."""
    match kind:
        case info.UnionType():
            return " or ".join(filter(None, map(_kinds, kind.types)))
        case info.NoneType():
            return ""
        case info.LiteralType():
            return " or ".join(f'`"{value}"`' for value in kind.values)
        case info.VarTupleType():
            return f"list of {_kinds(kind.item_type)}"
        case info.StructType():
            return "list" if kind.array_like else "table"
        case info.DictType():
            return "table"
        case info.CustomType():
            return _CELLS[kind.cls.__name__]
        case _:
            return _KINDS[type(kind)]


def _usual(field):
    """Value of a key that is left out, as a file would have it."""
    if field.required:
        return "needed"
    match field.default:
        case bool() | int() | float():
            return f"`{json.dumps(field.default)}`"
        case str() if field.default:
            return f'`"{field.default}"`'
        case _:
            return ""


def _told(kind):
    """Descriptions of the fields of a class in its docstrings, by name."""
    bases = [base for base in reversed(kind.__mro__) if "Parameters" in (base.__doc__ or "")]
    texts = [pair for base in bases for pair in described(base)[1].items()]
    own = {name: told for names, told in texts for name in names.split(", ")}
    for name, told in own.items():
        if found := re.match(r"These are described at `(\w+)`", told):
            own[name] = _told({"Tuning": Tuning, "Geometry": Geometry}[found[1]])[name]
    return own


def _holds(told):
    """Sentence on a key for people who write files, and not Python."""
    told = told.replace("Dot masks of the ", "The ").replace("Dot masks of ", "Cells of ")
    told = re.sub(r"[,;] or None for|[.;] None for", "; without it,", told)
    told = re.sub(r"[.;] None if", "; left out if", told)
    return re.sub(r"[.;] None where", "; left out where", told).replace("``", "`").rstrip(".")


def _keys_of(title, kind, fields, given):
    """Table of the keys of a table, without those that another one has alike."""
    told, rows = _told(kind), {}
    for field in fields:
        cells = _kinds(field.type), _holds(told[field.name]), _usual(field)
        if (field.encode_name, cells) not in given:
            rows.setdefault(cells, []).append(f"`{field.encode_name}`")
            given.add((field.encode_name, cells))
    if rows:
        yield _row(f"key of {title}", "may be", "holds", "usual")
        for cells, names in rows.items():
            yield _row(", ".join(names), *cells)


def _structs(kind):
    """Tables that a key may hold, or that its list has."""
    if isinstance(kind, info.VarTupleType):
        return _structs(kind.item_type)
    parts = kind.types if isinstance(kind, info.UnionType) else [kind]
    return [each for each in parts if isinstance(each, info.StructType) and not each.array_like]


def _tables_of(title, kind, seen, given):
    """Tables of a key: of what it holds, of that of each kind alone, and of tables within."""
    kinds = [each for each in _structs(kind) if each.cls not in seen and each.fields]
    if not kinds:
        return
    seen.update(each.cls for each in kinds)
    everywhere = set.intersection(*({f.encode_name for f in each.fields} for each in kinds))
    shared = [field for field in kinds[0].fields if field.encode_name in everywhere]
    yield list(_keys_of(title, kinds[0].cls, shared, given))
    for each in kinds:
        own = [field for field in each.fields if field.encode_name not in everywhere]
        yield list(_keys_of(f'{title} with `kind = "{each.tag}"`', each.cls, own, given))
    for each in kinds:
        for field in each.fields:
            yield from _tables_of(f"`{field.encode_name}`", field.type, seen, given)


def protocol_tables():
    """Tables of the page of protocols: of the whole file, and of each of its tables."""
    whole = info.type_info(ProtocolFile)
    plain = [field for field in whole.fields if not _structs(field.type)]
    others = [field for field in whole.fields if field.encode_name != "analysis"]  # by hand
    seen, given = set(), set()
    yield list(_keys_of("the whole file", Protocol, plain, given))
    for field in others:
        brackets = "[[{}]]" if isinstance(field.type, info.VarTupleType) else "[{}]"
        title = f"`{brackets.format(field.encode_name)}`"
        yield from filter(None, _tables_of(title, field.type, seen, given))


def _bytes():
    kinds = [kind for kind in get_args(AnyEvent) if kind is not Presented]
    told = [f"`{kind.__struct_config__.tag}` {kind.code}" for kind in kinds]
    said = ", ".join([*told, f"any other {OTHER}"])
    return "\n".join(textwrap.wrap(said, 118, break_on_hyphens=False))


# Each document with its tables, which begin with the first row of each.
TABLES = (
    ("settings.md", list(_settings())),
    ("keys.md", list(_keys(Where.BOOK))),
    ("feeling.md", list(_keys(Where.PICTURE))),
    ("playing.md", list(_keys(Where.GAME))),
    ("session-format.md", list(_events())),
    *(("protocols.md", rows) for rows in protocol_tables()),
)
# Each document with its other parts: the words that stand around one, and the part itself.
PARTS = (("session-format.md", "<!-- bytes: begin -->\n", "\n<!-- bytes: end -->", _bytes()),)


def with_table(text, rows, *, shown=True):
    """A document in which the table that begins with the first row has these rows, or none."""
    first, *others = rows
    table = "\n".join((first, "|" + "---|" * (first.count("|") - 1), *others, "")) * shown
    start = text.index(f"{first}\n")
    found = re.compile(r"(?:\|.*\n)+").match(text, start)
    return text[:start] + table + text[found.end() :]


# Pages that are no guides: specifications that a builder or an author of another program needs, and
# records of what was decided, measured and checked.
SPECIFICATIONS = (
    *("wire-protocol.md", "session-format.md", "recording.md", "latero.md", "live-view.md"),
    "tables.md",
)
RECORDS = ("decisions.md", "measured.md", "validation.md")
_WORD = re.compile(r"\S*\w\S*")


def words_of_guides():
    """Number of words of each guide, without what is made from the program."""
    pages = [DOCS.parent / "README.md", DOCS.parent / "CONTRIBUTING.md", *DOCS.glob("*.md")]
    words = {}
    for page in pages:
        if page.name in SPECIFICATIONS + RECORDS:
            continue
        text = page.read_text(encoding="utf-8")
        for name, rows in TABLES:
            if name == page.name:
                text = with_table(text, rows, shown=False)
        if page.name == keyspage.PAGE.name:
            text = with_part(text, keyspage.BEGIN, keyspage.END, "")
        words[page.name] = len(_WORD.findall(text))
    return words


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
    for name, words in sorted(words_of_guides().items(), key=lambda pair: -pair[1]):
        print(f"{words:6} {name}")
    print(f"{sum(words_of_guides().values()):6} words in guides")
