"""
Chebyshev's straight line
=========================

Before straight guides could be made well, linkages traced straight lines. They are still used where a guide
would rust, stick or cost too much. How straight is the best known crank-rocker, and is there a better one?
"""

# %%
# Chebyshev's linkage has a ground link of 4, arms of 5 that cross, and a coupler of 2 with P at its middle.
# It is a double rocker. Its cognate with a crank that turns fully, which traces the same curve, is known as
# Hoeken's linkage: crank, ground, coupler and rocker of 1 : 2 : 2.5 : 2.5, P at twice the coupler's length.
# Over half a turn of the crank P moves along a line of four crank lengths.

import matplotlib.pyplot as plt
import numpy as np

from grashof import load, plot_linkage, synthesize
from grashof.analysis import solve_position, straightest_half_turn, straightness
from grashof.problems import FourBar
from grashof.synth.theory import cognate_points

hoeken = FourBar(o2=(0, 0), o4=(100, 0), r2=50, r3=125, r4=125, coupler_point=(250, 0))
start, line = straightest_half_turn(hoeken)
print(f"Hoeken: {line.length:.0f} mm long, {line.width:.3f} mm wide over 180 deg of the crank")
plot_linkage(hoeken, theta2=start + np.radians([0, 90, 180]))
assert line.width / line.length < 0.003

# %%
# The cognates of Hoeken's linkage, from one position of it: there is Chebyshev's 4 : 5 : 2 : 5.

at = solve_position(hoeken, 1.0)
pivots = np.array([hoeken.o2, hoeken.o4, at.a, at.b, at.p]) @ [1, 1j]
for o2, o4, a, b, p in cognate_points(pivots, timed=False)[:2]:
    r1, r2, r3, r4 = np.abs([o4 - o2, a - o2, b - a, b - o4]) / 50
    print(f"{r1:.1f} : {r2:.1f} : {r3:.1f} : {r4:.1f}, P at {((p - a) / (b - a)).real:.1f} of the coupler")
assert np.allclose([r1, r2, r3, r4], [4, 5, 2, 5])

# %%
# Now nine points on a line of 100 mm are required, more than a coupler curve can meet, so that the least
# squared error decides. The limits of the problem leave room for Hoeken's linkage.

problem = load("straight-line")
result = synthesize(problem, seed=0, effort=0.2)
best = result.best
turned = np.degrees(abs(best.verdict.theta2[-1] - best.verdict.theta2[0]))
found = straightness(best.linkage, best.verdict.theta2[0], best.verdict.theta2[-1])
print(f"found:  {found.length:.0f} mm long, {found.width:.4f} mm wide over {turned:.0f} deg of the crank")
plot_linkage(best, problem)
assert found.width < 0.01

# %%
# The line found is far straighter, but it also takes a smaller part of the turn. A fair comparison is with
# as much of Hoeken's line.

share = np.linspace(20, 180, 60)
width = []
for turn in np.radians(share):
    part = straightness(hoeken, start + np.pi / 2 - turn / 2, start + np.pi / 2 + turn / 2)
    width.append(part.width / part.length)
figure, ax = plt.subplots()
ax.semilogy(share, width, label="Hoeken's linkage")
ax.plot(turned, found.width / found.length, "o", label="found")
ax.set(xlabel="crank rotation (deg)", ylabel="width / length of the line")
ax.legend()
gain = np.interp(turned, share, width) * found.length / found.width
print(f"{gain:.0f} times as straight over the same rotation")
assert gain > 50

# %%
# Hoeken's linkage has another advantage: P moves along its line at a nearly constant speed. And a width of
# 4 micrometres is that of exact links; what tolerances leave of it is another matter.
