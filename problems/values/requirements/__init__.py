"""Quantities that may be limited, weighed and listed; requirements and objectives."""
