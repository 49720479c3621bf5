"""Choice of the next question by the answers so far; it knows no file, no device and no clock."""
