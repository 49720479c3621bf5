"""The commands' options, and the values that are read out of what was typed."""
