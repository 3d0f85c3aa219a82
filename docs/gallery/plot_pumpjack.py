"""
Pumpjack
========

A linkage need not be searched for to be analysed. The catalogue has the crank-rocker of a pumpjack: the
crank turns at 20 rpm, and the horsehead on the other end of the beam lifts the rods.
"""

# %%
# P is a point of the pitman; the horsehead has a radius of 4.57 m about O4.

import matplotlib.pyplot as plt
import numpy as np

from grashof import plot_dynamics, plot_linkage
from grashof.analysis import grashof_class, output_stroke, solve_kinematics, worst_transmission_cycle
from grashof.problems import load_linkage_spec

spec = load_linkage_spec("pumpjack")
linkage = spec.linkage
plot_linkage(spec)

# %%
stroke = output_stroke(linkage)
worst = np.degrees(worst_transmission_cycle(linkage))
travel = stroke.swing * spec.output_arm
print(f"{grashof_class(linkage)}, worst transmission angle {worst:.1f} deg")
print(f"the beam swings by {np.degrees(stroke.swing):.1f} deg, the rods travel {travel:.2f} m")
print(f"time ratio {stroke.time_ratio:.3f}")
assert str(grashof_class(linkage)) == "crank-rocker"

# %%
# The speed of the rods over a turn. On the down stroke the horsehead must not run ahead of rods that sink
# through oil.

turn = np.radians(np.arange(361.0))
omega2 = 20 * 2 * np.pi / 60
speed = spec.output_arm * solve_kinematics(linkage, turn, omega2).omega4
figure, ax = plt.subplots()
ax.plot(np.degrees(turn), speed)
ax.axhline(0, color="0.6", linewidth=1)
ax.set(xlabel="crank angle (deg)", ylabel="speed of the rods (m/s)", xticks=range(0, 361, 60))
print(f"fastest {np.abs(speed).max():.2f} m/s")
assert 3 < np.abs(speed).max() < 6

# %%
# The drive torque of the bare linkage, without rods and counterweights: weights and inertia only.

plot_dynamics(spec, quantities="torque")

# %%
# 20 rpm is the figure of the student report that the linkage is from, and it is fast: 4 m/s at the rods.
# What of the torque is inertia falls with the square of the speed. ``grashof linkages lufkin-c912d`` prints
# a unit with rod load and counterbalance, which ``grashof analyse`` reports as the API counts them.
