"""Running a session: the runner, its commands, presenters and sources of answers."""
