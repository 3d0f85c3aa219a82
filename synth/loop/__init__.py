"""A linkage in the search: dyads, instants, and numbers with derivatives."""
