"""
Lids on gas struts
==================

A lid on a hinge still has to be lifted. Gas struts take its weight, at best so that the hand feels the wanted
effort at every angle, in summer and in winter.
"""

# %%
# The trunk lid of a car is to be lifted with 30 N at first, then rises by itself, and is pulled down by 30 N
# when it is open. Two struts from a table of usual sizes are placed between areas of the body and the lid.

from dataclasses import replace

import matplotlib.pyplot as plt

from grashof import load, plot_linkage, synthesize
from grashof.problems import LinkageSpec, Problem
from grashof.survey import report_on
from grashof.synth import Candidate


def plot_effort(problem: Problem, design: Candidate) -> None:
    """The effort with and without struts, as `grashof analyse` plots it."""
    dynamics = replace(problem.dynamics, effort=design.verdict.effort)
    spec = LinkageSpec(
        design.linkage, design.id, length_unit=problem.length_unit, dynamics=dynamics, problem=problem
    )
    effort = next(each for each in report_on(spec).sections if each.key == "effort")
    plot, (_, axes) = effort.plots[0], plt.subplots(figsize=(8, 4))
    for label, values in plot.series.items():
        axes.plot(plot.places, values, label=label, ls=":" if "°C" not in label else "-")
    axes.set(xlabel=plot.over, ylabel="effort (N)")
    axes.legend()


trunk = load("trunk-lid-struts")
best = synthesize(trunk, enough=1).best
plot_linkage(best, trunk)
print(trunk.source)

# %%
# No strut follows the wanted effort exactly; the greatest deviation, at both temperatures, is as small as
# sizes and places allow. Without struts it would be ten times as large.

plot_effort(trunk, best)
print([part.chosen for part in best.verdict.effort.parts], f"{best.values['effort_deviation']:.1f} N")
assert best.values["effort_deviation"] < 10

# %%
# A kitchen flap that goes up and over its cabinet, and stays where it is left between 20 and 80 deg: the
# effort is between the dotted lines, so that the friction of the struts holds it. Below 10 deg it closes.

flap = load("kitchen-flap")
best = synthesize(flap, enough=2).best
plot_linkage(best, flap)

# %%
plot_effort(flap, best)
print([part.chosen for part in best.verdict.effort.parts])
assert best.values["effort_deviation"] == 0
