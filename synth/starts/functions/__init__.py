"""Functions: generators that meet every pair, or err least under limits; each is a design already."""
