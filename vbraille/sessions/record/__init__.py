"""The files of a session on the disk, and the tables that are made from them."""
