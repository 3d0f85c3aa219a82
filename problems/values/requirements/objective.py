"""The objective: weights of quantities, by which designs are ranked."""

from __future__ import annotations

from dataclasses import dataclass

from grashof.problems.values.checks import number_within
from grashof.problems.values.errors import ProblemError, shown_key
from grashof.problems.values.requirements.all_quantities import QUANTITIES
from grashof.problems.values.requirements.quantities import OF_SLIDES, Quantity
from grashof.problems.values.text import hint
from grashof.problems.values.value_bases import set_fields

_HEAVIEST = 1e9
_PLAIN = {"compactness": "size", "torque": "torque_peak"}  # goals that go by a name of their own
# Possible goals, by the names that problem files use.
GOALS: dict[str, Quantity] = {
    name: QUANTITIES[_PLAIN.get(name, name)]
    for name in (
        "transmission",
        *_PLAIN,
        *(
            key
            for key, quantity in QUANTITIES.items()
            if quantity.better and key not in (*_PLAIN.values(), *OF_SLIDES.values())
        ),
    )
}


@dataclass(frozen=True, slots=True, init=False)
class Objective:
    """The criterion that ranks designs; weights are relative.

    Parameters
    ----------
    transmission : float
        Weight of the worst transmission angle, as a share of 90 deg.
    compactness : float
        Weight of the (small) size of the linkage in its motion, in sizes of the task.
    torque : float
        Weight of the (small) peak of the drive torque over the task motion, in reference torques of
        the problem; it needs dynamics.
    **others : float
        Weights of any other quantity that can be better or worse (`GOALS`), such as
        ``joint_force_peak``; see `Problem.scale` for the unit of each.

    Raises
    ------
    ProblemError
        An unknown goal, a weight out of range, or no weight greater than zero.

    Examples
    --------
    >>> Objective(1.0, joint_force_peak=0.2).goals
    {'transmission': 1.0, 'joint_force_peak': 0.2}
    """

    weights: tuple[tuple[str, float], ...]

    def __init__(
        self, transmission: float = 1.0, compactness: float = 0.0, torque: float = 0.0, **others: float
    ) -> None:
        given = {"transmission": transmission, "compactness": compactness, "torque": torque, **others}
        weights = []
        for name, weight in given.items():
            where = f"objective.maximise.{shown_key(name)}"
            if name not in GOALS:
                keys = hint(name, list(GOALS), f"the keys are {', '.join(GOALS)}")
                raise ProblemError(f"{where} is unknown; {keys}")
            weights.append((GOALS[name].key, number_within(weight, 0.0, _HEAVIEST, where)))
        if not any(weight for _, weight in weights):
            raise ProblemError("objective.maximise has no weight greater than zero; one at least is needed")
        set_fields(self, weights=tuple(pair for pair in weights if pair[1]))

    @property
    def goals(self) -> dict[str, float]:
        """Weights greater than zero, by the key of the quantity."""
        return dict(self.weights)

    @property
    def transmission(self) -> float:
        """Weight of the worst transmission angle."""
        return self.goals.get("transmission", 0.0)

    @property
    def compactness(self) -> float:
        """Weight of the size."""
        return self.goals.get("size", 0.0)

    @property
    def torque(self) -> float:
        """Weight of the peak of the drive torque."""
        return self.goals.get("torque_peak", 0.0)

    @property
    def stated(self) -> dict[str, float]:
        """The arguments that give this value, by the names that problem files use."""
        names = {quantity.key: name for name, quantity in GOALS.items()}
        return {"transmission": 0.0} | {names[key]: weight for key, weight in self.weights}

    def __repr__(self) -> str:
        return f"Objective({', '.join(f'{name}={weight!r}' for name, weight in self.stated.items())})"
