"""Journals in, tables and figures out. Sees no device and no engine."""
