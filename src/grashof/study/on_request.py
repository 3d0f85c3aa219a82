"""What an analysis holds on request; apart from `Asked`, so that the help of the command loads no arrays."""

# Long sections, which are made when they are requested by name.
ON_REQUEST = ("newton-raphson", "differences", "fits", "equations")
STEP = 0.05  # s, of a history
FIT_POINTS = 13
