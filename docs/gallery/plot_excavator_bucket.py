"""
Bucket of an excavator
======================

The cylinder of an excavator's arm turns a rocker, and a link turns the bucket. The bucket has to turn much
further than the rocker, from digging to holding its load.
"""

# %%
# That is a function: 90 deg of the rocker (the input) give 150 deg of the bucket (the output), and 62 deg
# at half way. Three pairs can be met exactly with freedom left. The pins of rocker and bucket are 420 mm
# apart on the arm.

import matplotlib.pyplot as plt
import numpy as np

from grashof import plot_linkage, synthesize
from grashof.analysis import solve_kinematics
from grashof.problems import FunctionTask, Problem, Requirements

problem = Problem(
    title="Bucket linkage",
    length_unit="mm",
    task=FunctionTask.from_degrees([0, 45, 90], [0, 62, 150]),
    requirements=Requirements(r1=(420, 420), link_length=(250, 700), transmission_min_deg=25),
)
result = synthesize(problem, seed=0, enough=20)
best = result.best
columns = ["r1", "r2", "r3", "r4", "mechanical_advantage_min", "transmission_min_task_deg"]
print(result.to_frame()[columns].head(5).round(2).to_string(index=False))
plot_linkage(best, problem).get_legend().set_loc("upper right")

# %%
# The moment at the bucket over that at the rocker is the mechanical advantage, the speed of the rocker over
# that of the bucket. It falls while the bucket curls: such a linkage breaks out with its greatest force at
# the start and is quick at the end.

theta2 = best.verdict.theta2[0] + best.verdict.direction * np.radians(np.linspace(0, 90, 181))
advantage = 1 / np.abs(solve_kinematics(best.linkage, theta2).omega4)
figure, ax = plt.subplots()
ax.plot(np.linspace(0, 90, 181), advantage)
ax.set(xlabel="rotation of the rocker (deg)", ylabel="moment at the bucket / at the rocker", ylim=(0, None))
print(f"advantage {advantage[0]:.2f} at the start, {advantage.min():.2f} at its least")
assert best.verdict.structural_error_max < np.radians(10)

# %%
# The pairs are met exactly, but between them the bucket may lead or lag by some degrees
# (``structural_error_max_deg``); nobody minds that on a bucket. The cylinder is not part of this task:
# ``[driver]`` finds one for motions, and for a rocker a lever of its length is found by hand.
