"""
Lifting arm driven by a cylinder
================================

A hydraulic cylinder between the bench and one of the links lifts a box of 60 kg by a metre and tilts it by
60 deg for emptying. Both are to be found: the linkage, and the place of the cylinder.
"""

# %%
# The problem is in the catalogue. The cylinder may be 300 to 700 mm long when closed and at most 1.6 times
# that when extended, and pushes with at most 6 kN. Its lever must not fall below 25 deg. Here it acts on
# the output link; the catalogue leaves driver and coupler open, too, and takes longer.

from dataclasses import replace

import matplotlib.pyplot as plt
import numpy as np

from grashof import load, plot_linkage, synthesize
from grashof.analysis import cylinder_forces, cylinder_state, solve_position

problem = load("lifting-arm")
problem = replace(problem, driver=replace(problem.driver, on=("output",)))
result = synthesize(problem, seed=0, starts=8, enough=4)
best = result.best
plot_linkage(best, problem)

# %%
# The lever angle is that between the cylinder and the arm that it pushes: 90 deg is best, and at 0 deg the
# arm is stuck.

columns = ["cylinder_closed", "cylinder_stroke", "cylinder_angle_min_deg", "cylinder_force_max"]
table = result.to_frame()
print(table[columns].round(1).to_string(index=False))
assert (table["cylinder_force_max"] <= 6000).all()
assert (table["cylinder_angle_min_deg"] >= 25).all()

# %%
# The force over the stroke, with the weights of box and links. The area under the curve is the work of one
# lift: for any linkage it is at least the energy that the box gains.

theta2 = np.linspace(best.verdict.theta2[0], best.verdict.theta2[-1], 181)
length = cylinder_state(best.verdict.cylinder, best.linkage, solve_position(best.linkage, theta2)).length
force = cylinder_forces(best.linkage, problem, best.verdict, theta2)
figure, ax = plt.subplots()
ax.fill_between(length, force, alpha=0.2)
ax.plot(length, force)
ax.set(xlabel="length of the cylinder (mm)", ylabel="force (N)", ylim=(0, None))
work = np.trapezoid(force, length) / 1000
gained = 60 * 9.81 * np.ptp(problem.task.positions[:, 1]) / 1000
print(f"work of the cylinder {work:.0f} J, gained by the box {gained:.0f} J, the rest by the links")
assert work > gained

# %%
# The designs are ranked by transmission; the force is only limited. ``maximise = "cylinder_force_max"``
# under ``[objective]`` makes the force small instead.
