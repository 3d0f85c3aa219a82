"""What a search comes to: what is chosen of its designs, or why there is none."""
