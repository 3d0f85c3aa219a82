"""From solves to a list: designs judged, ranked, chosen, explained."""
