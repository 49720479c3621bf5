"""Carriers of two axes: their arms, where these put the array, and how finely they measure that."""
