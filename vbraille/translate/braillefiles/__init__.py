"""Files that are in braille already: read as they are, and written."""
