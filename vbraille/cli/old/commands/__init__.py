"""The commands: a module with the name of each, imported only when it is called."""
