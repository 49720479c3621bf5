"""What a reader asks of a whole book, answered by a process of its own."""
