"""Proofs: bounds of the transmission angle of all linkages through poses or pairs, and all dyads of five."""
