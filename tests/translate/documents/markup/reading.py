"""HTML read into passages, for tests."""

from vbraille.translate.documents.markup.reader import MarkupReader, title_and_language
from vbraille.translate.documents.markup.tree import read_tree


def passages(markup, *, xml=False, language="", **reader):
    """Passages of a short text of markup."""
    root, _ = read_tree(markup.encode(), "test", xml=xml)
    language = language or title_and_language(root)[1]
    return list(MarkupReader(language=language, **reader).read(root))


def outline(markup, **options):
    """Kind with level, and text of each passage, as one word and a string."""
    return [(f"{p.kind.value}{p.level or ''}", p.text) for p in passages(markup, **options)]


def marked(passage):
    """Marks of a passage with the text that each marks."""
    return [
        (mark.kind.value, passage.text[mark.start : mark.end], mark.target)
        for mark in passage.marks
    ]
