"""Word processors' files: DOCX, ODT and RTF, each made into a tree of HTML."""
