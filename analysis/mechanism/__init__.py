"""How a linkage of any kind moves: positions, rates, ranges of the driver, transmission."""
