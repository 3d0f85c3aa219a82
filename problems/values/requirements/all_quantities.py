"""All quantities of a design: those that are measured, and those that fields of requirements declare."""

from __future__ import annotations

from grashof.problems.values.requirements.limiting import advantage
from grashof.problems.values.requirements.quantities import MEASURED, Needs, Quantity, Scope
from grashof.problems.values.requirements.requirements import LIMITS
from grashof.problems.values.units import Unit

_DERIVED = (
    advantage(
        "mechanical_advantage_min", about="|omega2 / omega4| where it is least over the task motion",
        full="least mechanical advantage",
    ),
    Quantity(
        "structural_error_at", "worst at", Unit.ANGLE, Scope.TASK, needs=Needs.OUTPUTS,
        about="driver rotation from the first pair to the greatest structural error",
        full="driver rotation to the greatest structural error",
    ),
)  # fmt: skip
# All quantities of a design, by key; those that are listed in the order of the columns.
QUANTITIES = MEASURED | {
    each.key: each for each in (*(limited.quantity for limited in LIMITS.values()), *_DERIVED)
}
