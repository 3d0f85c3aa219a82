"""
Pick and place with room for error
==================================

A gripper is to pass five poses, with links of at most 400 mm and a transmission angle of 35 deg that a
motor can work with.
"""

# %%
# Only a few four-bars meet five poses exactly, and here none of them fits. Grashof names the requirements
# to relax.

from dataclasses import replace

from grashof import plot_linkage, synthesize
from grashof.problems import MotionTask, Problem, Requirements

poses = [[0, 0, 0], [60, 90, 15], [180, 140, 40], [300, 90, 70], [360, 0, 90]]
problem = Problem(
    title="Pick and place",
    length_unit="mm",
    task=MotionTask.from_degrees(poses),
    requirements=Requirements(link_length=(30, 400), transmission_min_deg=35),
)
exact = synthesize(problem, seed=0)
print(exact.note)
assert not exact.candidates

# %%
# Few grippers need every pose to the last micrometre. With zones of 12 mm and 3 deg about each pose there
# are designs, and the objective, the transmission angle, uses that freedom. The list begins with a linkage
# that transmits well over the entire turn; the greatest angle over the poses is that of another one.

zones = MotionTask.from_degrees(poses, within=12, angle_within_deg=3)
roomy = replace(problem, task=zones)
result = synthesize(roomy, seed=0)
best = max(result.candidates, key=lambda one: one.values["transmission_min_task"])
columns = ["r1", "r2", "r3", "r4", "error_max", "angle_error_max_deg", "transmission_min_task_deg"]
print(result.to_frame()[columns].round(2).to_string(index=False))
plot_linkage(best, roomy)
assert best.values["transmission_min_task"] > 0.8  # rad

# %%
# It uses its zones up to their limit, as it should. Where the first and last pose matter more
# than those between, give ``within`` a number for each: pick and place exactly, pass the rest loosely.

sharp = MotionTask.from_degrees(poses, within=[1, 20, 20, 20, 1], angle_within_deg=[0.5, 5, 5, 5, 0.5])
ends = synthesize(replace(problem, task=sharp), seed=0, effort=0.2)
print(ends.to_frame()[columns].head(3).round(2).to_string(index=False) if ends.candidates else ends.note)
