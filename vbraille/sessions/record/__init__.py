"""What is kept of a session on the disk, and what is made of it."""
