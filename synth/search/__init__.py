"""The search itself: solves, rounds and chunks, wherever they are made, recorded and counted."""
