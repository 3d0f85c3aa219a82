"""
Burmester's curves of four poses
================================

Which points of a body stay on a circle while it passes four poses? They lie on a cubic curve, the
circle-point curve, and the centres of their circles on another one, the centre-point curve (Burmester,
1888). Any two such pairs make a four-bar through the four poses.
"""

# %%
# The poses are those of the box that goes over a staircase. The search works on a task of size one about
# the origin, so the poses are scaled before the curves are traced and scaled back afterwards.

import matplotlib.pyplot as plt
import numpy as np

from grashof import load, synthesize
from grashof.analysis import solve_position
from grashof.figures import plot_task
from grashof.synth.theory import Displacements, radius_error, trace_four_pose_curves

problem = load("luggage")
task = problem.task
size, centre = task.size, (task.positions @ [1, 1j]).mean()
motion = Displacements.from_poses((task.positions @ [1, 1j] - centre) / size, task.angles)
dyads = trace_four_pose_curves(motion, reach=4, lines=400, cell=0.01)
circle_points = dyads.moving * size + centre
centre_points = dyads.ground * size + centre
print(f"{len(dyads)} dyads, on a circle to {radius_error(motion, dyads).max() * size:.1e} m")
assert np.quantile(radius_error(motion, dyads), 0.99) < 1e-6

# %%
# The curves, and the best design of the search: its A and B lie on the circle-point curve, drawn with the
# body in its first pose, O2 and O4 on the centre-point curve.

best = synthesize(problem, seed=0).best
figure, ax = plt.subplots(figsize=(7, 6))
plot_task(problem, ax=ax)
ax.plot(circle_points.real, circle_points.imag, ".", markersize=2, label="circle points")
ax.plot(centre_points.real, centre_points.imag, ".", markersize=2, label="centre points")
first = solve_position(best.linkage, best.verdict.theta2[:1])
for name, place in {"A": first.a[0], "B": first.b[0], "O2": best.linkage.o2, "O4": best.linkage.o4}.items():
    ax.plot(*place, "o", color="black", markersize=5)
    ax.annotate(name, place, xytext=(6, 4), textcoords="offset points")
    curve = circle_points if name in "AB" else centre_points
    gap = np.abs(curve - place @ [1, 1j]).min()
    assert gap < 0.15, f"{name} is {gap:.2f} m off the curve as drawn"
ax.set_aspect("equal", adjustable="box")
ax.set(xlim=(-4, 16), ylim=(-8, 9))
ax.legend(loc="upper right")

# %%
# The curves are drawn as separate points about 0.05 m apart, which is why the pivots are near a point and
# not on one. Five poses leave at most four points of each curve, six in general none.
