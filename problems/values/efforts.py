"""How hard a search may try; apart from `Search`, so that the help of the command loads no arrays."""

EFFORTS = (0.2, 10_000.0)
