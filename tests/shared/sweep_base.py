"""Shared by tests of sweeps: a problem that is solved in no time."""

BASE = """\
kind = "path"
length_unit = "mm"
[path]
points = [[0, 0], [1, 1], [2, 0]]
[search]
starts = 1
enough = 1
effort = 0.2
"""
