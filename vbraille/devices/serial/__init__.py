"""A device on a serial line: the port, the conversation with it, and what is compiled of that."""
