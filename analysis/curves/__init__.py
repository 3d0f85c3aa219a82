"""Coupler curves: their shape, special points and approximations."""
