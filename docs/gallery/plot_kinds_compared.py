"""
Three kinds of linkage in one list
==================================

The pusher of the example before this one once more: six points of an arc. This time it is left open which
kind of linkage does it.
"""

# %%
# ``mechanism`` names the kinds; each is searched for, all are judged alike and stand in one list.

import matplotlib.pyplot as plt

from grashof import plot_linkage, synthesize
from grashof.problems import PathTask, Problem, Requirements

points = [[0, 0], [30, 34], [75, 55], [130, 58], [185, 43], [230, 12]]
problem = Problem(
    title="Pusher",
    length_unit="mm",
    mechanism=("four-bar", "slider-crank", "inverted-slider-crank"),
    task=PathTask(points),
    requirements=Requirements(link_length=(20, 300), coupler_arms=(0, 300), transmission_min_deg=40),
)
result = synthesize(problem, seed=0, enough=12)
table = result.to_frame()
first = table.groupby("mechanism").first()
print(first[["rank", "size", "transmission_min_task_deg"]].round(1).to_string())
assert set(first.index) == set(problem.mechanism)

# %%
# The best of each kind, drawn to scales of their own: driver orange, output green, coupler or rod blue.

figure, axes = plt.subplots(1, 3, figsize=(13, 4.8))
for ax, (kind, rank) in zip(axes, first["rank"].items(), strict=True):
    plot_linkage(result.candidates[rank - 1], problem, ax=ax).set_title(kind)
    ax.get_legend().remove()

# %%
# Inverted slider-cranks lead with 90 deg, and that deserves a remark: without an offset the block always
# pushes perpendicular to its rod, so that this number says nothing of the friction in the block, nor of a rod
# that is longer than the rest of the linkage. Compare kinds by size and by what their parts cost as well; the
# transmission angle compares designs of one kind.

assert first.loc["inverted-slider-crank", "transmission_min_task_deg"] > 80
