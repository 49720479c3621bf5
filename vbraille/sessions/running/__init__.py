"""Running of a session: runner, presenters, responses, console, live view, markers."""
