"""
Twelve timed points
===================

Twelve points, each with the angle of the crank at which it has to be met, are 24 equations for ten
unknowns. What does a general least-squares solver make of them?
"""

# %%
# The points are taken from a linkage that neither solver knows, so that an error of zero is possible.

import matplotlib.pyplot as plt
import numpy as np
from scipy.optimize import least_squares

from grashof import plot_linkage, synthesize
from grashof.analysis import solve_position
from grashof.problems import FourBar, PathTask, Problem, Requirements

hidden = FourBar(o2=(12, -35), o4=(118, 22), r2=31, r3=96, r4=74, coupler_point=(52, 61))
turn = np.radians(np.arange(0, 360, 30.0))
points = solve_position(hidden, np.radians(40) + turn).p
wanted = points @ [1, 1j]


# %%
# The general way: residuals of a four-bar in complex numbers, and scipy from random starts in a box that
# holds the solution. Where the loop does not close, the root is cut off at zero.
def errors(x: np.ndarray) -> np.ndarray:
    """Errors of P at the points, mm: O2, O4, r2, r3, r4, coupler point, start angle."""
    o2, o4, arm = x[0] + 1j * x[1], x[2] + 1j * x[3], x[7] + 1j * x[8]
    r2, r3, r4, start = x[4], x[5], x[6], x[9]
    a = o2 + r2 * np.exp(1j * (start + turn))
    s = np.abs(o4 - a)
    along = (s * s + r3 * r3 - r4 * r4) / (2 * s)
    across = np.sqrt(np.maximum(r3 * r3 - along * along, 0))
    gap = a + arm / r3 * (along + 1j * across) * (o4 - a) / s - wanted
    return np.concatenate([gap.real, gap.imag])


rng = np.random.default_rng(0)
low = [-150, -150, -150, -150, 10, 10, 10, -150, -150, 0]
high = [200, 200, 200, 200, 150, 150, 150, 150, 150, 2 * np.pi]
found = [least_squares(errors, rng.uniform(low, high), max_nfev=300) for _ in range(40)]
rms = np.sort([np.sqrt(2 * each.cost / len(turn)) for each in found])
figure, ax = plt.subplots()
ax.semilogy(np.arange(1, len(rms) + 1), np.maximum(rms, 1e-14), "o")
ax.set(xlabel="start, best first", ylabel="error, root mean square (mm)")
print(
    f"{np.sum(rms < 1e-6)} of {len(rms)} starts find the linkage; the median ends at {np.median(rms):.1f} mm"
)
assert np.sum(rms < 1e-6) <= 5

# %%
# Most starts end in a local minimum, and nothing distinguishes such a design from the best one. Grashof
# searches over the proportions and places each linkage best on the points by linear algebra, thousands at
# once, so that few unknowns are left to guess.

problem = Problem(
    length_unit="mm",
    task=PathTask(points, timing=turn, closed=True),
    requirements=Requirements(rotatability="crank-rocker"),
)
result = synthesize(problem, seed=0)
columns = ["r1", "r2", "r3", "r4", "error_rms"]
print(result.to_frame()[columns].round(4).to_string(index=False))
plot_linkage(result.best, problem)
assert result.best.verdict.error_max < 1e-3

# %%
# Two linkages come out: the hidden one and a cognate, which traces the same curve with the same timing. A
# general solver is not wrong here, only blind: with enough starts and an eye on the error it finds the
# linkage, too.
