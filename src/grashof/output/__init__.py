"""What is printed, and what a run writes."""
