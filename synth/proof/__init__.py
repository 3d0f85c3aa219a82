"""Proofs: upper bounds of the transmission angle of all linkages through four poses, by branch and bound."""
