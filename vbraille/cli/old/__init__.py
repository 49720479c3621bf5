"""The command ``vbraille``: parse, build, call, print."""
