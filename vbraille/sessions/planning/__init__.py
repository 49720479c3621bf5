"""What is planned before a session: protocols, designs, questions, and the plan of its trials."""
