"""
Lids and doors
==============

Six bodies moved by hand: their positions are known, and their hinges have to fit into the little room beside
them.
"""

# %%
# Problems of the catalogue are loaded by name. The first is a jewellery box cut by a laser: two links on each
# side, in place of hinges, lift its lid and stand it upright behind the box. ``enough=1`` ends a search with
# its first verified design; a larger number lists more, best first.

from grashof import load, plot_linkage, synthesize

box = load("jewellery-box-lid")
best = synthesize(box, enough=1).best
plot_linkage(best, box)
print(box.source)
assert best.verdict.ok

# %%
# The lid of a container, from its front up, over and onto its top. ``keep_out`` keeps the lid out of the
# container on the whole way.

container = load("container-lid")
best = synthesize(container, enough=2).best
plot_linkage(best, container)
print(container.source)
assert best.verdict.ok

# %%
# The trunk lid of a car, whose front edge has to stay clear of the rear window while the lid rises.

trunk = load("trunk-lid")
best = synthesize(trunk, enough=1).best
plot_linkage(best, trunk)
print(trunk.source)
assert best.verdict.ok

# %%
# A garage door whose top runs in a track under the ceiling, on an arm of the jamb. A closed leaf is at
# right angles to the track, which is a dead position of the arm if both brackets are equally deep. With a
# deeper one for the roller a few degrees remain.

garage = load("garage-door-track")
best = synthesize(garage, enough=6).best
plot_linkage(best, garage)
print(garage.source)
assert best.verdict.ok

# %%
# The lid of a tool chest has to pass over the carrying handle at its back edge. Only two poses and the area
# of chest and handle are stated; the links of the best designs cross on the way.

chest = load("tool-chest-lid")
best = synthesize(chest, enough=6).best
plot_linkage(best, chest)
print(chest.source)
assert best.verdict.ok

# %%
# The door of a table greenhouse, roof and front wall in one piece, folds up and back. Of the second and third
# pose only the position of its lower corner is stated.

greenhouse = load("greenhouse-door")
best = synthesize(greenhouse, enough=6).best
plot_linkage(best, greenhouse)
print(greenhouse.source)
assert best.verdict.ok
