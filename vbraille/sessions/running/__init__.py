"""A session being run: the console, the course of the trials, what is felt and heard."""
