from .animation import animate, save_animation
from .curves import plot_dynamics, plot_kinematics
from .files import draw_design, draw_motion, save
from .linkage import plot_coupler_curve, plot_design_space, plot_linkage, plot_task
from .section_plots import plot_section

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
