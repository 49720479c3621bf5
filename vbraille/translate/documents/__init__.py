"""Files as paragraphs: encodings, and paragraphs that know their place in the source."""

from vbraille.translate.documents.document import Document
from vbraille.translate.documents.paragraphs import Paragraph

__all__ = ["Document", "Paragraph"]
