"""Commands of a reader: a table, and a function for each."""
