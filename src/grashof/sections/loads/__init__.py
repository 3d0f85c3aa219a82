"""Sections of forces and torques, and of what carries or balances them."""
