"""A linkage in the search: dyads, instants, and the numbers they are written for."""
