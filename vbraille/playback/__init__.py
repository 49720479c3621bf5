"""Recordings and traces of sessions, played back in the live view."""
