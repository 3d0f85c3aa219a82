"""
Windscreen wiper
================

A motor turns a crank all the way round; the wiper arm swings to and fro by 95 deg and takes equally long
both ways.
"""

# %%
# That is a swing and a time ratio of one. Only the proportions matter; the distance of 240 mm from the
# motor to the shaft of the arm sets the scale.

import matplotlib.pyplot as plt
import numpy as np

from grashof import plot_linkage, synthesize
from grashof.analysis import solve_position
from grashof.problems import Problem, Requirements, StrokeTask

problem = Problem(
    title="Wiper",
    length_unit="mm",
    task=StrokeTask.from_degrees(swing_deg=95, time_ratio=1),
    requirements=Requirements(r1=(240, 240), r2=(35, 120)),
)
result = synthesize(problem, seed=0)
best = result.best
columns = ["r1", "r2", "r3", "r4", "output_swing_deg", "time_ratio", "transmission_min_cycle_deg"]
print(result.to_frame()[columns].head(5).round(2).to_string(index=False))
plot_linkage(best, problem)

# %%
# The two limit positions are drawn: crank and coupler are in line in both. The angle of the arm over one
# turn of the crank is nearly a sine, but not quite: the two ends of the swing are not alike.

turn = np.radians(np.arange(361.0))
position = solve_position(best.linkage, turn)
angle = np.degrees(np.unwrap(position.theta4))
figure, ax = plt.subplots()
ax.plot(np.degrees(turn), angle - angle.min())
ax.set(xlabel="crank angle (deg)", ylabel="angle of the arm (deg)", xticks=range(0, 361, 60))
assert abs(np.ptp(angle) - 95) < 0.01

# %%
# A crank-rocker with time ratio 1 and a swing of 95 deg cannot transmit at more than 90 - 95 / 2 = 42.5 deg
# over the turn, and only with an endlessly short crank. That is above the usual 40 deg, but not by much:
# wiper arms that swing further have two linkages one after the other, or a gear.

assert 40 < np.degrees(best.verdict.transmission_min_cycle) < 42.5
