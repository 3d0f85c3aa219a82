"""Function generators: what they put out, those through a few pairs, least errors, their limits."""
