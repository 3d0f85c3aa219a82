"""
Forces and motor torque of a design
===================================

A linkage lifts boxes of 25 kg from a conveyor, tilts them and sets them down, twenty times a minute. Which
motor does it need, and which forces act on the pins?
"""

# %%
# Three poses are the task. The links are steel bars of 2.4 kg/m, the box is carried at P. The motor goes on
# turning, so that the transmission angle has to be good over the full turn: the way back counts, too.

from dataclasses import replace

import numpy as np

from grashof import plot_dynamics, plot_linkage, synthesize
from grashof.problems import DynamicsSpec, MotionTask, Objective, Problem, Requirements

box = [[-200, 0], [200, 0], [200, 250], [-200, 250]]
problem = Problem(
    title="Tilting lift",
    length_unit="mm",
    task=MotionTask.from_degrees([[0, 0, 0], [250, 300, 20], [600, 450, 70]], body=box),
    requirements=Requirements(
        link_length=(100, 900), coupler_arms=(0, 900), transmission_min_deg=30, transmission_over="cycle"
    ),
    dynamics=DynamicsSpec(speed_rpm=20, mass_per_length=0.0024, payload=25, gravity=(0, -9.80665)),
)
by_angle = synthesize(problem, seed=0, enough=20).best
by_torque = synthesize(replace(problem, objective=Objective(0, torque=1)), seed=0, enough=20).best
plot_linkage(by_torque, problem)

# %%
# The same task twice, ranked by the worst transmission angle and by the peak of the drive torque between
# first pose and last.

omega2 = 20 * 2 * np.pi / 60
for name, design in {"by transmission": by_angle, "by torque": by_torque}.items():
    values = design.values
    angle = np.degrees(values["transmission_min_cycle"])
    print(
        f"{name:16} {angle:.0f} deg, peak torque {values['torque_peak']:.0f} N m, "
        f"greatest joint force {values['joint_force_peak']:.0f} N"
    )
assert by_torque.values["torque_peak"] < by_angle.values["torque_peak"]

# %%
# A good transmission angle does not make a small torque: what counts is how much the weights rise for each
# degree of the crank. Over the turn the torque and the forces look like this. On the way back the torque is
# larger still and brakes the box, which is counted there, too: a machine that lets go of it needs less.

plot_dynamics(by_torque, problem, quantities=["torque", "joint force"])

# %%
# Behind a gear of 1 : 70 with an efficiency of 0.85 the motor needs this much for the lift, before any margin
# for friction and for starting:

peak = by_torque.values["torque_peak"]
print(f"{peak / (70 * 0.85):.1f} N m at {20 * 70} rpm, at most {peak * omega2 / 0.85:.0f} W")

# %%
# No linkage can lift with less torque than the work on the box over the crank's rotation:

least = 25 * 9.80665 * 0.45 / by_torque.values["driver_rotation"]
print(f"{least:.0f} N m, had the torque been even all the way")
assert peak > least
