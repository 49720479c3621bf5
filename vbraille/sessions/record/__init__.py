"""The file of a session, and the tables that are made from it."""
