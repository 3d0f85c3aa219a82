"""What is asked and what a linkage is, as values."""
