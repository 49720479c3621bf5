"""Legibility sessions: protocols, trials, the journal, traces."""
