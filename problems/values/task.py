"""Tasks: what a linkage is asked to do."""

from __future__ import annotations

from typing import TypeAlias

from grashof.problems.values.motion_task import MotionTask
from grashof.problems.values.path_task import PathTask

Task: TypeAlias = MotionTask | PathTask
