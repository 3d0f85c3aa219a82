"""Six-bars through five poses, by theory."""
