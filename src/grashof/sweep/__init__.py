"""Sweeps: one problem with some of its keys varied, a folder of problems, or a table of targets.

`sweep` solves every combination, keeps finished ones, and gives one table; `load_study` reads a study file.
"""

from grashof.sweep.result import Step, Sweep
from grashof.sweep.run import sweep
from grashof.sweep.study import Study, load_study

__all__ = ["Step", "Study", "Sweep", "load_study", "sweep"]
