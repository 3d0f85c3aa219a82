"""Words for problems and numbers, for terminal and pages alike."""
