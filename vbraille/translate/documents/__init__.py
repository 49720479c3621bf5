"""Files as blocks of text: how they are encoded, and where their paragraphs begin and end."""

from vbraille.translate.documents.document import Document

__all__ = ["Document"]
