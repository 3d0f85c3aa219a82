"""
Luggage over a staircase
========================

A box has to pass four poses on its way over a staircase.
"""

# %%
# The problem is in the catalogue.

from grashof import load, plot_linkage, synthesize

result = synthesize(load("luggage"), seed=0)
plot_linkage(result.best, result.problem)
