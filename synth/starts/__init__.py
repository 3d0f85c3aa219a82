"""Where solves begin: linkages drawn or computed, improved, screened and chosen."""
