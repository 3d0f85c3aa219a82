"""
Drives and steering
===================

A crank or a wheel turns, and something else has to turn, or be somewhere, at the same time.
"""

# %%
# The wheels of a car turn about one common point if the cotangents of their angles differ by the track over the
# wheelbase. Arms of one length behind the axle come within half a degree of that between both locks.

from grashof import load, plot_linkage, synthesize

car = load("steering")
best = synthesize(car, enough=6).best
plot_linkage(best, car)
print(car.source)
print(f"greatest error {best['structural_error_max_deg']:.2f} deg")
assert abs(best.linkage.r2 - best.linkage.r4) < 1e-6

# %%
# The coupler of a four-bar turns as twenty measured values say, while the crank makes half a turn.

coupler = load("coupler-angle")
best = synthesize(coupler, enough=6).best
plot_linkage(best, coupler)
print(coupler.source)

# %%
# Twelve points, at equal steps of the crank, are far more than a four-bar can meet: the best one is within a few
# hundredths of the loop's size everywhere.

loop = load("twelve-timed")
best = synthesize(loop).best
plot_linkage(best, loop)
print(loop.source)

# %%
# The drive of a bus wiper. A parallelogram keeps the blade upright; one of its arms is the rocker of this
# crank-rocker, which is not found in four-bars with a greater worst transmission angle: that is proven.

wiper = load("bus-wiper")
result = synthesize(wiper, enough=6)
plot_linkage(result.best, wiper)
print(wiper.source)
