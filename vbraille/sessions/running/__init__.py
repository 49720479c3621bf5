"""Running of a session: the console, the course of the trials, stimuli and sounds."""
