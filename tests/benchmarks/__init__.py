"""What the README's table of speeds is measured with; `make bench` prints it.

Every figure is a ratio within one run, the two sides in turn and the median of
the pairs, since machines differ and are noisy.
"""
