"""Reading a book and feeling a picture: one loop, one table of commands, outputs."""
