"""What proofs come to: bounds, and what is claimed of a list."""
