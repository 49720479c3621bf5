"""Tables of documents that follow from the program; `python -m tests.documents` writes them."""

import re
from pathlib import Path

from tests.commandline import commands
from tests.scene import keyspage
from vbraille.cli.options import SHARED
from vbraille.reading.commands import Where, keys_of, spoken, table

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


# Each document with its tables, which begin with the first row of each.
TABLES = (
    ("settings.md", list(_settings())),
    ("keys.md", list(_keys(Where.BOOK))),
    ("feeling.md", list(_keys(Where.PICTURE))),
    ("playing.md", list(_keys(Where.GAME))),
)


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
RECORDS = ("decisions.md", "measured.md")
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
    for name, words in sorted(words_of_guides().items(), key=lambda pair: -pair[1]):
        print(f"{words:6} {name}")
    print(f"{sum(words_of_guides().values()):6} words in guides")
