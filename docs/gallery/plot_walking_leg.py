"""
Leg of a walking machine
========================

While a foot is on the ground it has to go back in a straight line at an even speed, or the body bobs and
the feet slip. Then it is lifted and brought forward. A leg that does this with one motor is a coupler point
of a crank-rocker.
"""

# %%
# The stance is given point by point with the turn of the crank for each: 160 mm in 150 deg. On the way
# back one point is stated, 40 mm above the ground and 105 deg later. Both pivots are on the body, above the
# ground.

import matplotlib.pyplot as plt
import numpy as np

from grashof import plot_linkage, synthesize
from grashof.analysis import solve_position
from grashof.problems import Box, PathTask, Problem, Requirements

stance = [[x, 0] for x in np.linspace(80, -80, 7)]
timing = [*np.linspace(0, 150, 7), 255]
body = Box((-300, 300), (120, 500))
problem = Problem(
    title="Walking leg",
    length_unit="mm",
    task=PathTask.from_degrees([*stance, [0, 40]], timing_deg=timing),
    requirements=Requirements(
        exact=False,
        rotatability="crank-rocker",
        link_length=(30, 400),
        coupler_arms=(0, 700),
        transmission_min_deg=35,
        transmission_over="cycle",
        o2=body,
        o4=body,
    ),
)
result = synthesize(problem, seed=0, effort=0.2)
best = result.best
columns = ["best_at", "error_rms", "error_max", "size", "transmission_min_cycle_deg"]
print(result.to_frame()[columns].head(5).round(2).to_string(index=False))
plot_linkage(best, problem)

# %%
# The height of the foot over a turn, counted from the first target, shows how much the body bobs, how high
# the foot is lifted, and for how long it is near the ground. Three such legs on each side, a third of a
# turn apart, carry a machine.

turn = np.linspace(0, 2 * np.pi, 361)
theta2 = best.verdict.theta2[0] + best.verdict.direction * turn
height = solve_position(best.linkage, theta2).p[:, 1]
figure, ax = plt.subplots()
ax.plot(np.degrees(turn), height)
ax.axvspan(0, 150, color="0.93")
ax.set(xlabel="crank angle from touch-down (deg)", ylabel="height of the foot (mm)", xticks=range(0, 361, 60))
bob = np.ptp(height[:151])
print(f"the body bobs by {bob:.1f} mm; the foot is lifted by {height.max():.0f} mm")
assert bob < 14
assert height.max() > 25

# %%
# Along the stride the foot is up to 4 mm early or late, and slips by that much; it touches down and lifts off
# a little too high. Points without timing would give a straighter line at an uneven speed.
