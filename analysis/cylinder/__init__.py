"""A cylinder as driver: its lengths, its lever angle and its force."""
