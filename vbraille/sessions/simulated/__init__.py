"""A simulated reader, for pilots and tests."""
