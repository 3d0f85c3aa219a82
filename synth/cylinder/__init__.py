"""The best cylinder for a linkage: in closed form on link 2, by search on links 3 and 4."""
