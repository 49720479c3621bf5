"""Markup as passages: what the parser of HTML or XML tells, made into what a reader reads.

`pieces` has the file's characters, `parsing` gives them to a parser piece by piece, `reader` takes
the parser's events; `flow` folds a block's text, `lists` and `tables` know the two by name, and
`asides` has what is not read as text: titles, drawings, formulas.
"""
