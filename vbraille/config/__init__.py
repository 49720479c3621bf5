"""Options and settings: one schema, from which command line, files and documents follow."""
