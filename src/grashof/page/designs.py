"""Designs as the page's scripts move them: the linkage, its driver's travel, torque over it."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import asdict
from typing import Any, NamedTuple

import numpy as np

from grashof.analysis import (
    Verdict,
    driver_ranges,
    full_rotation,
    function_curves,
    inverse_dynamics,
    solve_kinematics,
    stated_loads,
    stated_masses,
)
from grashof.analysis.judge.over_task import driver_law, motion_ends
from grashof.analysis.mechanism.mobility import range_index
from grashof.drawing.scene import bodies_of
from grashof.page.render import compact, plain
from grashof.problems import Cylinder, DynamicsSpec, Linkage, Problem
from grashof.problems.values.arrays import TURN, FloatArray
from grashof.problems.values.dynamics.dynamics_spec import metres
from grashof.problems.values.linkages.linkage import by_kind
from grashof.problems.values.linkages.mechanism import Mechanism
from grashof.study.sweep import INSET, dead_positions_unwarned, driver_angles
from grashof.synth import Candidate
from grashof.synth.designs.table import Row

STEPS = 180
_ROUNDING = 1e-12  # of a turn


class Travel(NamedTuple):
    """How far a driver goes: a whole turn, or a range between dead positions, rad.

    The ends are NaN where nothing can be assembled.
    """

    low: float
    high: float
    turns: bool

    def angles(self, inset: float = 0.0) -> FloatArray:
        """Driver angles of `driver_angles`, as the page's scripts have them, `inset` from dead positions."""
        inset = 0.0 if self.turns else inset
        return driver_angles(self.low + inset, self.high - inset, STEPS, even=self.turns)

    def ahead(self, first: float) -> float:
        """The whole turns by which the angles of a motion, which begins at `first`, are ahead, rad."""
        return TURN * float(np.round((first - (self.low + self.high) / 2) / TURN))


def driver_travel(linkage: Linkage, theta2: FloatArray) -> Travel:
    """Turn from 0, or range between dead positions, of a single linkage, that the first target lies in.

    The driver angles at the targets (N,), rad, are unwrapped along the motion.
    """
    if full_rotation(linkage):
        return Travel(0.0, TURN, True)
    index, _ = range_index(linkage, theta2[0])
    low, high = driver_ranges(linkage)[max(int(index), 0)].tolist()
    return Travel(low, high, False)


def moves(design: Candidate) -> bool:
    """Whether there is any position of it that could be drawn."""
    theta2 = design.verdict.theta2
    return bool(np.isfinite(theta2).all()) and not np.isnan(driver_travel(design.linkage, theta2).low)


def legend(kinds: Iterable[Mechanism], cylinders: Iterable[Cylinder | None] = ()) -> list[tuple[str, str]]:
    """Style and words of each link in drawings of linkages of some kinds, and of their cylinders.

    >>> from grashof.problems import SliderCrank
    >>> legend([SliderCrank.mechanism])
    [('driver', 'driver O2-A'), ('coupler', 'coupler A-B-P'), ('output', 'slider B')]
    """
    found: dict[str, list[str]] = {}
    for body in (body for kind in kinds for body in bodies_of(kind)):
        found.setdefault(body.role, []).append(body.words)
    words = [(style, ", ".join(dict.fromkeys(names))) for style, names in found.items()]
    return words + [("cylinder", "cylinder")] * any(each is not None for each in cylinders)


def linkage_data(linkage: Linkage) -> dict[str, Any]:
    """A linkage as the scripts have it: its kind, and what it is stated by in full precision."""
    return {"mechanism": linkage.mechanism.word, **linkage.stated}


class _Drawn(NamedTuple):
    """A design, its linkage on the assembly that meets the first target, and how far its driver goes."""

    design: Candidate
    linkage: Linkage
    travel: Travel

    @classmethod
    def of(cls, design: Candidate) -> _Drawn:
        """A design as it is drawn."""
        linkage = design.linkage.changed(assembly=design.verdict.assembly[0])
        return cls(design, linkage, driver_travel(linkage, design.verdict.theta2))


def designs_of(problem: Problem, designs: Sequence[Candidate], rows: Sequence[Row]) -> list[dict[str, Any]]:
    """Designs that can be assembled as JSON in full precision; the rows are those of `rows_of`."""
    drawn = list(map(_Drawn.of, designs))
    return [
        {
            "id": design.id,
            "linkage": linkage_data(linkage),
            **travel._asdict(),
            "direction": design.verdict.direction,
            "theta2": (design.verdict.theta2 - ahead).tolist(),
            "assemblies": design.verdict.assembly.tolist(),
            "task": [end - ahead for end in motion_ends(problem.task, design.verdict)]
            if design.verdict.branch_ok
            else None,
            "torque": torque,
            **cylinder_data(design.verdict.cylinder, design.values["cylinder_closed"]),
            **_function(problem, linkage, design),
            "figures": {key: plain(value) for key, value in figures.items()},
        }
        for (design, linkage, travel), torque, figures in zip(
            drawn, _torques(problem, drawn), rows, strict=True
        )
        for ahead in [travel.ahead(design.verdict.theta2[0])]
    ]


def cylinder_data(driven: Cylinder | None, closed: float) -> dict[str, Any]:
    """A cylinder of some closed length, which may be unknown, as the scripts draw it; nothing without one."""
    if driven is None:
        return {}
    return {"cylinder": {**driven.stated, "closed": closed if np.isfinite(closed) else 0.0}}


def _function(problem: Problem, linkage: Linkage, design: Candidate) -> dict[str, Any]:
    """Wanted and generated output of a function over the range, as files have it; nothing for other tasks."""
    if not problem.task.has_output.any():
        return {}
    curves = function_curves(linkage, problem.task, design.verdict, count=181)
    if curves is None:
        return {"function": None}
    columns, shown = asdict(curves), problem.task.counted_in.shown
    columns = {name: shown * values for name, values in columns.items()} | {
        "turned": np.degrees(curves.turned)
    }
    names = {"title": problem.task.output_words, "unit": problem.task.counted_in.of(problem.length_unit)}
    return {"function": names | {name: compact(values.tolist()) for name, values in columns.items()}}


def _torques(problem: Problem, drawn: Sequence[_Drawn]) -> list[list[float | None] | None]:
    """Drive torque over the travel of each linkage, N m; None for each without dynamics.

    Of a driver that starts and stops, over the task alone.
    """
    found: list[list[float | None] | None] = [None] * len(drawn)
    if problem.dynamics is None:
        return found
    for rows in by_kind([each.linkage for each in drawn]):
        torques = _of_one_kind(problem, problem.dynamics, [drawn[row] for row in rows])
        for row, torque in zip(rows, torques, strict=True):
            found[row] = torque
    return found


def _of_one_kind(problem: Problem, spec: DynamicsSpec, drawn: Sequence[_Drawn]) -> list[list[float | None]]:
    metre = metres(problem.length_unit)
    batch = drawn[0].linkage.stacked([each.linkage for each in drawn])[:, None]
    laws = [driver_law(problem, *motion_ends(problem.task, each.design.verdict)) for each in drawn]
    theta2 = np.stack([_angles_of_motion(each.travel, each.design.verdict) for each in drawn])
    ways = list(zip(laws, theta2, strict=True))
    motion = zip(*(law.at_angle(angles) for law, angles in ways), strict=True)
    with dead_positions_unwarned():
        state = solve_kinematics(batch, *map(np.stack, motion))
        time = np.stack([law.time_at(angles) for law, angles in ways])
        loads = stated_loads(spec, metre, lambda _: time)
        torque = metre**2 * inverse_dynamics(state, stated_masses(batch, spec, metre), loads).torque
    if spec.motor is not None and not spec.motor.steady:
        torque = np.where([law.holds(angles) for law, angles in ways], torque, np.nan)
    return [compact(row) for row in torque.tolist()]


def _angles_of_motion(travel: Travel, verdict: Verdict) -> FloatArray:
    """Driver angles over the travel, counted as those of the motion are."""
    angles = travel.angles(INSET) + travel.ahead(verdict.theta2[0])
    least = float(verdict.theta2.min())
    return angles + TURN * np.ceil((least - angles) / TURN - _ROUNDING) if travel.turns else angles
