"""Word processors' files: DOCX, ODT and RTF, read by anydoc and passed on as HTML.

`officexml` writes into the file's own XML what anydoc's model has no place for, by `docxmarks` and
`odtmarks`, as `annotations` that `officehtml` takes out again.
"""
