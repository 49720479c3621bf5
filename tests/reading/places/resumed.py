"""Plain texts that are opened where they were left."""

from types import SimpleNamespace

from vbraille.reading.library import last_book, resume
from vbraille.translate import Document


def open_kept(places, file, options=None):
    """Open a text, or the last one for None; None also has it open as it was."""
    kept = last_book(places) if file is None else None
    if options is None and kept is None:
        kept = places.book(file)
    options = kept.options if options is None else options
    path = str(kept.path) if file is None else file
    source = Document.open(path, options["encoding"], keep_lines=options["keep_lines"])
    kept = kept or places.book(path)
    place, note = resume(source, kept, options)
    return SimpleNamespace(source=source, kept=kept, options=options, place=place, note=note)
