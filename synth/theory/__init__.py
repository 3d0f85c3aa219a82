"""What theory gives: dyads, cognates, all linkages through nine points."""
