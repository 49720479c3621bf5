"""Protocols, designs, questions, and the plan of a session's trials."""
