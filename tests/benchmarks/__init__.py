"""What the tables of docs/measured.md are measured with; `make bench` prints the first.

Every figure is a ratio within one run, the two sides in turn and the median of
the pairs, since machines differ and are noisy.
"""
