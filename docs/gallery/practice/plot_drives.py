"""
Drives and steering
===================

A crank or a wheel turns, and something else has to turn, or be somewhere, at the same time.
"""

# %%
# The wheels of a car turn about one common point if the cotangents of their angles differ by the track over
# the wheelbase. ``mirror_deg`` states where the trapezium is its own mirror image, straight ahead, so that
# both locks are alike. Its error is at most 0.78 deg; only the length and the angle of the arms are free.

from grashof import load, plot_linkage, synthesize

car = load("steering")
best = synthesize(car, enough=6).best
plot_linkage(best, car)
print(car.source)
print(f"arms of {best.linkage.r2:.0f} and {best.linkage.r4:.0f} mm, track rod of {best.linkage.r3:.0f} mm")

# %%
# The coupler of a four-bar turns as twenty measured values say, while the crank makes half a turn.

coupler = load("coupler-angle")
best = synthesize(coupler, enough=6).best
plot_linkage(best, coupler)
print(coupler.source)

# %%
# Twelve points at equal steps of the crank are far more than a four-bar can meet. The best one passes them
# within a hundredth of the loop's size.

loop = load("twelve-timed")
best = synthesize(loop).best
plot_linkage(best, loop)
print(loop.source)

# %%
# The drive of a bus wiper. A parallelogram keeps the blade upright; one of its arms is the rocker of this
# crank-rocker. It is proven that no four-bar within the limits has a worst transmission angle of more than
# 47.44 deg; this one has 47.42 deg.

wiper = load("bus-wiper")
best = synthesize(wiper, enough=6).best
plot_linkage(best, wiper)
print(wiper.source)

# %%
# The intake of a competition robot. A pneumatic cylinder, placed by the search, swings the roller from behind
# the bumper over it, to the height where it meets a ball; at the first pose all joints are within the frame.

robot = load("robot-intake")
best = synthesize(robot, enough=2).best
plot_linkage(best, robot)
print(robot.source)

# %%
# The rear suspension of a bicycle. The inputs are lengths of the shock, from compressed to extended, and
# ``rate`` limits the leverage ratio at both ends, so that the suspension becomes stiffer over its travel. The
# ratio is the arm of the axle, 440 mm, times the rotation of the swingarm for a millimetre of the shock.

import matplotlib.pyplot as plt
import numpy as np

from grashof.analysis import function_curves

bicycle = load("bicycle-suspension")
best = synthesize(bicycle, enough=6).best
plot_linkage(best, bicycle)
print(bicycle.source)

curves = function_curves(best.linkage, bicycle.task, best.verdict)
ratio = 440 * np.gradient(np.abs(curves.generated), curves.inputs)
figure, ax = plt.subplots()
ax.plot(65 - curves.inputs, ratio)
ax.set(xlabel="travel of the shock (mm)", ylabel="leverage ratio")
assert 1.99 < ratio[0] < 2.21
assert 2.41 < ratio[-1] < 2.66
