"""Figures of results, each with what it shows in words."""
