"""Problems in the frame of the search, kinds of linkage, and formulas of their quantities."""
