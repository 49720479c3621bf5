"""What a reader can be told to do: a table of commands, and what each of them does."""
