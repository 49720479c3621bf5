"""The serial protocol: a table of messages, and their bytes, without a port and without time."""
