"""HTML read into passages, for tests."""

from functools import partial
from io import BytesIO

from vbraille.translate.documents.html import Rewound
from vbraille.translate.documents.markup.parsing import Parsing
from vbraille.translate.documents.markup.reader import MarkupReader


def passages(markup, *, xml=False, **reader):
    """Passages of a short text of markup."""
    opened = partial(Rewound, BytesIO(markup.encode()))
    return Parsing(opened, 1, "test", partial(MarkupReader, **reader), xml=xml).part(0)


def outline(markup, **options):
    """Kind with level, and text of each passage, as one word and a string."""
    return [(f"{p.kind.value}{p.level or ''}", p.text) for p in passages(markup, **options)]


def marked(passage):
    """Marks of a passage with the text that each marks."""
    return [
        (mark.kind.value, passage.text[mark.start : mark.end], mark.target)
        for mark in passage.marks
    ]
