"""Affine forms of a pair of parameters, and the conditions of a loop on them."""
