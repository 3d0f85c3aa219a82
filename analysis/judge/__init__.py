"""The judge: does a linkage do a task under its requirements? From the linkage alone."""
