"""How a linkage moves: position, velocity, acceleration, jerk, mobility."""
