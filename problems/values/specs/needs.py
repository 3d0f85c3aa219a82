"""Parts of a problem that quantities need: whether they are stated, and the error where they are not."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from grashof.problems.values.requirements.quantities import Needs

NO_OUTPUT = '{kind} states no output; kind = "function" does'
_NO_DWELL = '{kind} states no such dwell; kind = "dwell" does, with swing_deg or stroke'
_NOT_TWO = "{kind} states no two outputs; two tables [[stroke]] do"
OF_OUTPUTS = (Needs.OUTPUTS, Needs.ROTATION, Needs.TRAVEL)
# Test that a problem states the data for a need, and the error otherwise; other needs are always met.
NEEDED: dict[Needs, tuple[Callable[[Any], bool], str]] = {
    Needs.DYNAMICS: (lambda problem: problem.dynamics is not None, "dynamics is missing"),
    Needs.WANTED_TORQUE: (lambda problem: problem.torque is not None, "torque.wanted is missing"),
    Needs.MANUFACTURING: (lambda problem: problem.manufacturing is not None, "manufacturing is missing"),
    Needs.CLOSED: (lambda problem: problem.task.closed, "{kind}.closed is false; it must be true"),
    Needs.LEAST_SQUARES: (
        lambda problem: not problem.requirements.is_exact(problem.task),
        "requirements.exact = false is missing",
    ),
    Needs.ANGLES: (lambda problem: bool(problem.task.has_angle.any()), "{kind} has no angles"),
    Needs.CYLINDER: (lambda problem: problem.driver is not None, "driver.cylinder is missing"),
    Needs.LOADED_CYLINDER: (
        lambda problem: problem.driver is not None and problem.dynamics is not None,
        "{both}",
    ),
    Needs.EFFORT: (
        lambda problem: getattr(problem.dynamics, "effort", None) is not None,
        "effort is missing",
    ),
    Needs.OUTPUTS: (lambda problem: bool(problem.task.has_output.any()), NO_OUTPUT),
    Needs.ROTATION: (
        lambda problem: bool(problem.task.has_output.any()) and not problem.task.travels,
        "function has an output that slides, not one that turns",
    ),
    Needs.TRAVEL: (
        lambda problem: problem.task.travels,
        "function has an output that turns, not one that slides",
    ),
    Needs.TWO_OUTPUTS: (lambda problem: problem.task.swings is not None, _NOT_TWO),
    Needs.DWELL: (lambda problem: problem.task.dwell is not None, _NO_DWELL),
    Needs.DWELL_OF_LINK: (
        lambda problem: problem.task.dwell is not None and problem.task.swing is not None,
        _NO_DWELL,
    ),
    Needs.DWELL_OF_SLIDE: (
        lambda problem: problem.task.dwell is not None and problem.task.stroke is not None,
        _NO_DWELL,
    ),
}
