"""
Bucket of an excavator
======================

The cylinder of an excavator's arm turns a rocker, and a link turns the bucket. The bucket has to turn much
further than the rocker, from digging to holding its load.
"""

# %%
# That is a function: 90 deg of the rocker (the input) give 150 deg of the bucket (the output), and 62 deg
# at half way. Three pairs can be met exactly with freedom left. The pins of rocker and bucket are 420 mm
# apart on the arm, at (0, 0) and (420, 0); the cylinder begins on the arm behind them.

import matplotlib.pyplot as plt
import numpy as np

from grashof import plot_linkage, synthesize
from grashof.analysis import cylinder_state, solve_position
from grashof.problems import Box, CylinderSpec, FunctionTask, Problem, Requirements

problem = Problem(
    title="Bucket linkage",
    length_unit="mm",
    task=FunctionTask.from_degrees([0, 45, 90], [0, 62, 150]),
    requirements=Requirements(
        o2=Box((0, 0), (0, 0)),
        o4=Box((420, 420), (0, 0)),
        link_length=(250, 700),
        transmission_min_deg=25,
        rotatability="any",
    ),
    driver=CylinderSpec(closed=(600, 1100), on=["driver"], base=Box((-1500, -500), (0, 400))),
)
result = synthesize(problem, seed=0, enough=20)
best = result.best
columns = ["r2", "r3", "r4", "transmission_min_task_deg", "cylinder_closed", "cylinder_stroke"]
print(result.to_frame()[columns].head(5).round(2).to_string(index=False))
plot_linkage(best, problem).get_legend().set_loc("upper right")

# %%
# The moment at the bucket over the force of the cylinder is the rate of the cylinder, the change of its
# length for a radian of the bucket. It falls while the bucket curls: such a linkage breaks out with its
# greatest force near the start and is quick at the end.

theta2 = best.verdict.theta2[0] + best.verdict.direction * np.radians(np.linspace(0, 90, 181))
found = cylinder_state(best.verdict.cylinder, best.linkage, solve_position(best.linkage, theta2))
figure, ax = plt.subplots()
ax.plot(found.length - found.length[0], np.abs(found.output_rate))
ax.set(xlabel="lengthening of the cylinder (mm)", ylabel="rate (mm/rad)", ylim=(0, None))
start, end = best.values["cylinder_rate_start"], best.values["cylinder_rate_end"]
print(f"rate {start:.0f} mm/rad at the start, {end:.0f} mm/rad at the end")
assert best.verdict.structural_error_max < np.radians(10)

# %%
# The pairs are met exactly, but between them the bucket may lead or lag by some degrees
# (``structural_error_max_deg``); nobody minds that on a bucket. A limit of ``cylinder_rate`` keeps the force
# up over the whole motion.
