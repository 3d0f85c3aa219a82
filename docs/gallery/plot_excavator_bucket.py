"""
Bucket of an excavator
======================

The cylinder of an excavator's arm turns a rocker, and a link turns the bucket. The operator controls only the
length of the cylinder: the bucket has to turn with it, from digging to holding its load.
"""

# %%
# That is a function of a length: 300 mm of stroke (the input) turn the bucket by 150 deg (the output), the
# first half of it by 62 deg. Base, arm and first length of the cylinder are found together with the linkage.

import matplotlib.pyplot as plt
import numpy as np

from grashof import load, plot_linkage, synthesize
from grashof.analysis import cylinder_state, function_curves, solve_position

problem = load("excavator-bucket")
result = synthesize(problem, seed=0, enough=20)
best = result.best
columns = ["r2", "r3", "r4", "transmission_min_task_deg", "cylinder_closed", "cylinder_stroke"]
print(result.to_frame()[columns].head(5).round(2).to_string(index=False))
plot_linkage(best, problem).get_legend().set_loc("lower left")
assert abs(best.values["cylinder_stroke"] - 300) < 1e-6

# %%
# The pairs are met exactly, but between them the bucket may lead or lag by some degrees
# (``structural_error_max_deg``), which does not matter for a bucket.

curves = function_curves(best.linkage, problem.task, best.verdict)
figure, ax = plt.subplots()
ax.plot(curves.inputs, np.degrees(curves.generated))
ax.plot(problem.task.inputs, np.degrees(problem.task.outputs), "o")
ax.set(xlabel="lengthening of the cylinder (mm)", ylabel="rotation of the bucket (deg)")

# %%
# The moment on the bucket over the force of the cylinder is the rate of the cylinder, the change of its
# length for a radian of the bucket; ``cylinder_rate`` keeps it above 45 mm.

theta2 = np.linspace(best.verdict.theta2[0], best.verdict.theta2[-1], 181)
found = cylinder_state(best.verdict.cylinder, best.linkage, solve_position(best.linkage, theta2))
figure, ax = plt.subplots()
ax.plot(found.length - found.length[0], np.abs(found.output_rate))
ax.set(xlabel="lengthening of the cylinder (mm)", ylabel="rate (mm/rad)", ylim=(0, None))
start, end = best.values["cylinder_rate_start"], best.values["cylinder_rate_end"]
print(f"rate {start:.0f} mm/rad at the start, {end:.0f} mm/rad at the end")
assert np.abs(found.output_rate).min() >= 45
