"""The terminal, and the files of a run."""
