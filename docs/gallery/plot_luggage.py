"""
Luggage over a staircase
========================

A box has to be carried over a staircase: taken from the upper floor, moved out, let down the steps and set
down. Four poses say where it has to be.
"""

# %%
# The problem is in the catalogue, with links of 0.3 to 8 m. Through four poses there is a one-parameter
# family of dyads on each side, so that the designs form continuous families, of which the list has the best
# members.

from grashof import load, plot_design_space, plot_linkage, synthesize

problem = load("luggage")
result = synthesize(problem, seed=0)
best = result.best
plot_linkage(best, problem)

# %%
# The list. The first transmission angle counts from the first pose to the last, the second over the full
# turn of the crank.

columns = [
    "r1",
    "r2",
    "r3",
    "r4",
    "transmission_min_task_deg",
    "transmission_min_cycle_deg",
    "size",
    "torque_peak",
]
print(f"{len(result)} distinct verified designs")
print(result.to_frame()[columns].head(5).round(2).to_string(index=False))
assert best.verdict.error_max < 1e-9
assert best.values["transmission_min_task"] > 0.47

# %%
# Every design against two goals, coloured by the peak torque; those that are not beaten in every goal by
# another one are ringed. A smaller linkage costs transmission angle: 11 m instead of 13.7 m takes nearly 4
# deg.

plot_design_space(result)

# %%
# 27 deg is a poor transmission angle, and the drawing shows where it comes from: links of 8 m, the longest
# allowed, are what limits it. Some of the linkage also passes through the stairs, which are drawn only.
# ``keep_out`` keeps pivots or links out of them, and the remaining designs are worse.
