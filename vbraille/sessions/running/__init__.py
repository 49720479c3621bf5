"""What runs a session: console, presenters, and where answers come from."""
