"""
Locks over the centre
=====================

A strut of two links that is pushed just past its straight line holds a load without a latch: the load
pushes it further against its stop.
"""

# %%
# The drag brace of a landing gear. ``past_deg`` under ``at`` puts driver and coupler 2 to 5 deg past
# toggle when the leg is down. P is close to the joint of the lower brace and the leg, so that three points
# on a circle about the trunnion state the motion of the leg.

import numpy as np

from grashof import load, plot_linkage, synthesize
from grashof.analysis import solve_position
from grashof.synth import Candidate


def past(design: Candidate) -> float:
    """Angle of driver and coupler from toggle at the last target, deg."""
    at = solve_position(design.linkage, design.verdict.theta2[-1])
    one, two = (at.a - design.linkage.o2) @ [1, 1j], (at.b - at.a) @ [1, 1j]
    angle = abs(np.degrees(np.angle(two / one)))
    return float(min(angle, 180 - angle))


gear = load("drag-brace")
best = synthesize(gear, enough=6).best
plot_linkage(best, gear)
print(gear.source)
print(f"{past(best):.2f} deg past toggle")
assert 2 - 1e-6 <= past(best) <= 5 + 1e-6

# %%
# A hold-down clamp. Its handle is the coupler, its arm link 4; a hand brings the handle from upright to
# level.

clamp = load("toggle-clamp")
best = synthesize(clamp, enough=6).best
plot_linkage(best, clamp)
print(clamp.source)
print(f"{past(best):.2f} deg past toggle")
assert 2 - 1e-6 <= past(best) <= 5 + 1e-6

# %%
# The leg of a folding table has the brace of the landing gear, smaller: folded flat under the top, and locked
# when it is upright.

table = load("folding-table")
best = synthesize(table, enough=6).best
plot_linkage(best, table)
print(table.source)
print(f"{past(best):.2f} deg past toggle")
assert 2 - 1e-6 <= past(best) <= 5 + 1e-6
