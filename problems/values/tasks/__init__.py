"""Tasks: a table of targets, stated in the terms of each kind of task."""
