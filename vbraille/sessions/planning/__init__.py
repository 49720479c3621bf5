"""Protocols and plans: what will be shown to whom, in which order, before a session begins."""
