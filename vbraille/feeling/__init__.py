"""Feeling a tactile picture: the scene under the hand, what is said of it, and what it costs."""
