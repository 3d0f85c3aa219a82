"""The search for six-bars."""
