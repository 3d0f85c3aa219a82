"""Forces inside bars and pins, stresses and safety factors."""
