"""What a linkage has to do: a table of targets, stated in the words of each kind of task."""
