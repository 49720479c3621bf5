"""Legibility sessions: planned, run, kept on the disk, and made into tables.

`docs/session-format.md` describes the files that a session leaves behind.
"""
