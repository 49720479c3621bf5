"""The command ``vbraille``: a module for each of its commands, and options that they share."""
