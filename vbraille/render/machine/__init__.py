"""The machine that shows compiled scenes: the words that it can be told, and its kernels."""
