"""How a four-bar linkage moves: position, velocity, acceleration, jerk, mobility."""
