"""Braille as it is shown: profile, mapping, tuning and style, and the twin in plain numpy."""
