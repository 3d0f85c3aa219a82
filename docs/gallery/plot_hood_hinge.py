"""
Hinge of a car's bonnet
=======================

A bonnet on a single pivot needs a wide gap at its rear edge, or the edge digs into the cowl as it turns. A
four-bar hinge lifts the rear edge first and tilts the bonnet afterwards, so that the gap can be small.
"""

# %%
# Three poses state that. P is the rear edge of the bonnet, which reaches from there to the front: closed;
# the edge 33 mm up and 20 mm forward while the bonnet has turned by 10 deg only; open by 50 deg, the edge
# well clear of the windscreen. The ground pivots lie on a bracket under the rear of the bonnet, the moving
# ones on a plate under it. Nothing turns fully, so that ``rotatability`` is any.

from grashof import plot_linkage, synthesize
from grashof.problems import Box, MotionTask, Problem, Requirements

bonnet = [[0, 0], [1050, -50], [1050, -65], [0, -20]]
bracket, plate = Box((-60, 350), (-260, -60)), Box((0, 350), (-100, -10))
problem = Problem(
    title="Bonnet hinge",
    length_unit="mm",
    task=MotionTask.from_degrees([[0, 0, 0], [20, 33, 10], [76, 10, 50]], body=bonnet),
    requirements=Requirements(
        rotatability="any",
        link_length=(60, 260),
        o2=bracket,
        o4=bracket,
        a_on_body=plate,
        b_on_body=plate,
    ),
)
result = synthesize(problem, seed=0, enough=10)
best = result.best
plot_linkage(best, problem)

# %%
# The drawing shows the three poses from light to dark. Designs are ranked by the worst transmission angle
# between the first pose and the last, which says here how firmly the hinge guides the bonnet in spite of
# play in its pins.

columns = ["r1", "r2", "r3", "r4", "transmission_min_task_deg"]
print(result.to_frame()[columns].head(5).round(1).to_string(index=False))
assert best.verdict.error_max < 1e-6

# %%
# Three poses leave much freedom: each moving pivot may be anywhere on the plate. The pivots of real hinges
# are limited by the parts around them, so narrow the boxes to the available room; where no design fits, the
# message names the limit to relax.
