"""What an analysis is made of: a linkage with its motion, what varies over it, and what is said of it."""
