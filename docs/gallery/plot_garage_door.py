"""
Up-and-over garage door
=======================

A door of 2.1 m in one piece stands in the opening when closed and lies under the ceiling when open. It must
not touch the lintel on its way.
"""

# %%
# P is the middle of the door, and the angle that of the door from its lower edge to its upper one: 90 deg
# closed, 180 deg open. In between the door is at 130 deg with its middle just inside the opening. The
# ground pivots are on the walls beside the opening, where nobody walks; the moving ones on brackets on the
# inside of the door. ``keep_out`` keeps the door itself (``body``) out of lintel and ceiling over the full
# motion, not at the three poses only.

import numpy as np

from grashof import plot_linkage, synthesize
from grashof.analysis import solve_position
from grashof.problems import Box, MotionTask, Problem, Requirements

door = np.array([[-1.05, -0.02], [1.05, -0.02], [1.05, 0.02], [-1.05, 0.02]])
lintel = [[-3, 2.25], [0.2, 2.25], [0.2, 2.6], [-3, 2.6]]
wall, inside = Box((-1.2, -0.06), (0.3, 2.1)), Box((-1.0, 1.0), (0.04, 0.2))
problem = Problem(
    title="Garage door",
    length_unit="m",
    task=MotionTask.from_degrees([[0, 1.06, 90], [-0.15, 1.36, 130], [-0.75, 2.08, 180]], body=door),
    outlines=(lintel,),
    requirements=Requirements(
        rotatability="any",
        link_length=(0.2, 1.6),
        o2=wall,
        o4=wall,
        a_on_body=inside,
        b_on_body=inside,
        keep_out=(lintel,),
        keep_out_for=("body",),
    ),
)
result = synthesize(problem, seed=0, enough=8)
best = result.best
columns = ["r1", "r2", "r3", "r4", "transmission_min_task_deg", "size"]
print(result.to_frame()[columns].head(5).round(3).to_string(index=False))
plot_linkage(best, problem)

# %%
# The drawing does not show how far the lower edge swings out into the drive, where a car may stand.

theta2 = np.linspace(best.verdict.theta2[0], best.verdict.theta2[-1], 200)
position = solve_position(best.linkage, theta2)
angle = position.theta3 + best.linkage.body_angle
corners = (position.p @ [1, 1j])[:, None] + np.exp(1j * angle)[:, None] * (door @ [1, 1j])
print(f"the door swings out by {corners.real.max():.2f} m, and reaches {corners.imag.max():.2f} m up")
assert corners.imag.max() < 2.251

# %%
# Such a door is heavy, and the spring that carries it is missing here. With ``[[springs]]`` or
# ``[[torsion_springs]]`` and a mass per length the problem shows the remaining moment for the hand.
