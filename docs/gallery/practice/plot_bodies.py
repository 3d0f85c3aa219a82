"""
A flap and a shelf
==================

Two bodies with stated positions, moved by a motor or a bed.
"""

# %%
# The outboard flap of a wing: stowed, for take-off, for landing. ``inside`` keeps all four pivots within the
# profile, O2 and O4 in the wing behind its rear spar, A and B in the flap.

from grashof import load, plot_linkage, synthesize

flap = load("outboard-flap")
best = synthesize(flap, enough=6).best
plot_linkage(best, flap)
print(flap.source)
assert best.verdict.ok

# %%
# The shelf in front of a wall bed stays level while the bed comes down, and ends below it. Three poses with
# one angle ask for a parallelogram; the bed is one of its arms.

bed = load("wall-bed-shelf")
best = synthesize(bed, enough=6).best
plot_linkage(best, bed)
print(bed.source)
assert best.verdict.ok
