"""
Bed lifter: a deliberate parallelogram
======================================

A mattress frame is to rise and come forward without tilting, so that somebody can look into the box below
and make the bed standing upright. Poses that differ in place but not in angle ask for a parallelogram
linkage.
"""

# %%
# Three places on a circle of 450 mm, all at 0 deg. Any two parallel links of 450 mm do that, so the pivots
# only have to be well apart: ``r1`` asks for 600 mm. A parallelogram has change points, where all links are
# in line and it may fold over; ``rotatability="any"`` admits it, and the judge only makes sure that the
# motion from first pose to last meets none.

import numpy as np

from grashof import plot_linkage, synthesize
from grashof.problems import Box, MotionTask, Problem, Requirements

mattress = [[-1000, 0], [1000, 0], [1000, 180], [-1000, 180]]
lift = np.radians([15, 45, 75])
poses = [[-450 * np.cos(angle), 450 * np.sin(angle), 0] for angle in lift]
below, frame = Box((-900, 1400), (-300, 0)), Box((-900, 900), (-60, 0))
problem = Problem(
    title="Bed lifter",
    length_unit="mm",
    task=MotionTask.from_degrees(poses, body=mattress),
    requirements=Requirements(
        rotatability="any",
        r1=(600, 1200),
        o2=below,
        o4=below,
        a_on_body=frame,
        b_on_body=frame,
    ),
)
result = synthesize(problem, seed=0, enough=10)
best = result.best
linkage = best.linkage
columns = ["grashof_class", "r1", "r2", "r3", "r4", "transmission_min_task_deg"]
print(result.to_frame()[columns].head(5).round(1).to_string(index=False))
plot_linkage(best, problem)

# %%
# All are parallelograms: r1 = r3 and r2 = r4.

assert np.isclose(linkage.r1, linkage.r3)
assert np.isclose(linkage.r2, linkage.r4)
assert np.isclose(linkage.r2, 450)

# %%
# The transmission angle is that between the arms and the frame. With the pivots nearly level it is about 15
# deg when the bed is closed: the arms lie almost flat, the second one hardly guides, and the force to lift
# is greatest there. Tilting the line of the pivots would help, had the frame the height for it. Bed makers
# live with it, and put gas springs beside the arms.

assert np.degrees(best.verdict.transmission_min_task) < 30
