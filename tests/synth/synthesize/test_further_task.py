"""A kind of task that the package does not have takes its value and a row of the judge."""

from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np
import pytest

from grashof import synthesize
from grashof.analysis import verify
from grashof.analysis.judge.how_met import HOW_MET
from grashof.problems import FunctionTask, Problem, Requirements, Task
from grashof.problems.files.problem_writing import problem_toml
from grashof.problems.values.arrays import FloatArray, IntArray
from grashof.wording.problem import summary


@dataclass(frozen=True, slots=True, eq=False)
class Dwell(Task):
    """Link 4 turns by an angle while the driver turns by `rise`, and rests over `rest` more; all in rad."""

    kind: ClassVar[str] = "dwell"
    target: ClassVar[str] = "place"
    usual_rotatability: ClassVar[str] = "any"
    in_degrees: ClassVar[tuple[str, ...]] = ("turn", "rise", "rest")

    turn: float
    rise: float
    rest: float

    @property
    def timing(self) -> FloatArray:  # type: ignore[override]
        return np.linspace(0, self.rise + self.rest, 9)

    @property
    def closed(self) -> bool:  # type: ignore[override]
        return False

    @property
    def within(self) -> None:  # type: ignore[override]
        return None

    @property
    def positions(self) -> FloatArray:
        return np.full((9, 2), np.nan)

    @property
    def outputs(self) -> FloatArray:
        share = np.minimum(self.timing / self.rise, 1.0)
        return np.asarray(self.turn * (share - np.sin(2 * np.pi * share) / (2 * np.pi)))

    @property
    def angle_length(self) -> float:
        return 1.0

    def exact_for(self, freedoms: int) -> bool:
        return False

    def some(self, index: IntArray, positions: FloatArray, angles: FloatArray) -> "Dwell":
        return self


def test_a_dwell_is_searched_judged_and_described(monkeypatch: pytest.MonkeyPatch) -> None:
    assert isinstance(HOW_MET, dict)
    monkeypatch.setitem(HOW_MET, Dwell, HOW_MET[FunctionTask])
    task = Dwell(*np.radians([40, 120, 40]).tolist())
    problem = Problem(task=task, requirements=Requirements(transmission_min_deg=20))
    found = synthesize(problem, seed=0, effort=0.2, workers=1)
    pairs = FunctionTask(task.timing, task.outputs)
    assert len(found) > 2
    for one in found.candidates:
        assert verify(one.linkage, pairs, problem.requirements).ok
        assert one.error(problem) == pytest.approx(one.error(replace(problem, task=pairs)), rel=1e-12)
    assert "turn_deg = 40.0\n" in problem_toml(problem)
    assert "dwell through 9 places" in summary(problem)[0] + summary(problem)[1]
