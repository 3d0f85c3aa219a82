"""Function generators: their outputs, those through a few pairs, least errors, their limits."""
