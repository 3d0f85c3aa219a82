"""Problems in the frame of the search, kinds of linkage, and what can be asked of them as formulas."""
