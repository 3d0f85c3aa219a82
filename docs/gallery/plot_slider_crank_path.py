"""
A path by a slider-crank
========================

A pusher is to lift a carton over an edge: six points of an arc 230 mm long. A slider-crank has one
dimension less than a four-bar, yet only one moving pivot on the ground, and a bought linear guide takes the
place of a rocker.
"""

# %%
# Any six points can be met exactly by slider-cranks, with two freedoms left for the transmission angle. Of
# a slider-crank that is the angle between the connecting rod and the normal of the slide's direction.

from grashof import plot_linkage, synthesize
from grashof.problems import PathTask, Problem, Requirements

points = [[0, 0], [30, 34], [75, 55], [130, 58], [185, 43], [230, 12]]
problem = Problem(
    title="Pusher",
    length_unit="mm",
    mechanism="slider-crank",
    task=PathTask(points),
    requirements=Requirements(link_length=(20, 300), coupler_arms=(0, 300), transmission_min_deg=40),
)
result = synthesize(problem, seed=0, enough=20)
best = result.best
plot_linkage(best, problem)

# %%
columns = ["r2", "r3", "offset", "slide_angle_deg", "stroke", "transmission_min_task_deg"]
print(result.to_frame()[columns].head(5).round(1).to_string(index=False))
assert best.verdict.error_max < 1e-6

# %%
# The stroke of the slide is the length of guide to buy. The best design has a short slide, steep to the
# path; the next ones are several times as long and lie nearly along it. A limit on ``stroke`` decides
# between the two.

strokes = result.to_frame()["stroke"]
print(f"guides from {strokes.min():.0f} to {strokes.max():.0f} mm")
assert strokes.iloc[0] < 100 < strokes.max()
