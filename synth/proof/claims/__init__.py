"""Results of proofs: bounds, and claims about a list."""
