"""The elements of an analysis: a linkage with its motion, quantities that vary over it, sections as data."""
