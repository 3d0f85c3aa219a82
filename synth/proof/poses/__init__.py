"""Linkages through four poses between bounds, and all dyads of five."""
