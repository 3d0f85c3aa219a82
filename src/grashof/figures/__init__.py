"""Figures of linkages and designs for papers and notebooks, and moving ones, with matplotlib.

Every function draws into the axes given as ``ax``, or else into a new figure of pyplot, and returns
the axes; none of them shows or saves anything. A linkage is a `FourBar`, a `LinkageSpec` as
`load_linkage_spec` reads it, or a `Candidate` of a result; with a `Problem` its task is drawn, and
unit, speed and masses are the problem's. Fonts are those of matplotlib's settings; `save` writes text
as text, and the same bytes each time.
"""

from grashof.figures.animation import animate, save_animation
from grashof.figures.curves import plot_dynamics, plot_kinematics
from grashof.figures.files import draw_design, draw_motion, save
from grashof.figures.linkage import plot_coupler_curve, plot_design_space, plot_linkage, plot_task
from grashof.figures.section_plots import plot_section

__all__ = [
    "animate",
    "draw_design",
    "draw_motion",
    "plot_coupler_curve",
    "plot_design_space",
    "plot_dynamics",
    "plot_kinematics",
    "plot_linkage",
    "plot_section",
    "plot_task",
    "save",
    "save_animation",
]
