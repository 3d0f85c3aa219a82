"""Results of a search: the designs chosen for the list, or why it is empty."""
