"""Braille itself: cells as dot masks, how they are spelled, and where their dots stand."""
