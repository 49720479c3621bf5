"""Search in a whole book, by a process of its own."""
