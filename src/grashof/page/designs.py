"""Data that the scripts of a page draw: the scene of a problem, moving designs, torque over their travel."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import asdict
from functools import lru_cache
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
from grashof.analysis.effort.case import EffortCase
from grashof.analysis.judge.effort_travel import effort_of_design
from grashof.analysis.judge.over_task import driver_law, motion_ends
from grashof.analysis.judge.wanted_torque import places_of
from grashof.analysis.mechanism.mobility import range_index
from grashof.drawing.scene import Scene, bodies_of
from grashof.page.regions import regions_of
from grashof.page.render import compact, plain
from grashof.page.struts import effort_data, strut_data
from grashof.problems import Cylinder, DynamicsSpec, Linkage, Problem, Task, catalogue, load
from grashof.problems.files.published import published
from grashof.problems.values.arrays import TURN, FloatArray
from grashof.problems.values.dynamics.dynamics_spec import metres
from grashof.problems.values.dynamics.effort import EffortSpec
from grashof.problems.values.linkages.linkage import by_kind
from grashof.problems.values.linkages.mechanism import Mechanism
from grashof.study.sweep import INSET, dead_positions_unwarned, driver_angles
from grashof.synth import Candidate, Result
from grashof.synth.designs.table import Row

_SAMPLES = 181
STEPS = 180
_ROUNDING = 1e-12  # of a turn


def scene_of(problem: Problem) -> dict[str, Any]:
    """A problem as the scripts draw it: lengths in its unit, angles in rad, null where free."""
    wanted = problem.requirements
    return {
        **_targets_of(problem.task),
        "unit": problem.length_unit,
        "outlines": [corners.tolist() for corners in problem.outlines],
        "keepOut": [corners.tolist() for corners in wanted.keep_out],
        "keptOut": list(wanted.keep_out_for),
        "regions": regions_of(problem),
        "published": _published(problem),
    }


def loci_of(result: Result) -> dict[str, Any] | None:
    """Possible places of the joints, those of the best linkages last; None where they are unknown."""
    loci = result.loci
    if loci is None or not len(loci.transmission) or not result.candidates:
        return None
    order = np.argsort(loci.transmission, kind="stable")
    degrees = np.degrees(loci.transmission[order])
    return {
        "moving": [compact(ends) for ends in loci.moving[order].reshape(-1, 4)],
        "ground": [compact(ends) for ends in loci.ground[order].reshape(-1, 4)],
        "share": [round(float(each), 3) for each in degrees / degrees[-1]],
        "best": round(float(degrees[-1]), 1),
    }


def _targets_of(task: Task) -> dict[str, Any]:
    if not task.has_position.any() and not task.has_angle.any():  # limit positions
        return {"points": [], "closed": task.closed}
    if task.only_points:
        return {"points": task.positions.tolist(), "closed": task.closed}
    poses = np.column_stack([task.positions, task.angles])
    body = None if task.body is None or not task.has_angle.any() else task.body.tolist()
    targets = {"poses": [list(map(plain, pose)) for pose in poses], "body": body, "closed": task.closed}
    return targets | {"bare": True} if task.has_output.any() else targets


def _published(problem: Problem) -> dict[str, Any] | None:
    """Path of the best published design, for a path of the catalogue."""
    if not published(problem.name) or problem.name not in catalogue():
        return None
    points, path = _published_path(problem.name)
    # another problem may have the same name
    return path if np.array_equal(problem.task.positions, points) else None


@lru_cache(maxsize=8)
def _published_path(name: str) -> tuple[FloatArray, dict[str, Any]]:
    """Points of a path of the catalogue, and the path of its best published design."""
    best = published(name)[0]
    low, high = driver_ranges(best.linkage)[0]
    path = Scene(best.linkage).path(np.linspace(low, high, _SAMPLES))
    shown = [compact(point) for point in path if np.isfinite(point).all()]
    return load(name).task.positions, {"label": f"{best.method} {best.year}", "path": shown}


class Travel(NamedTuple):
    """Travel of a driver, rad: a full turn or a range between dead positions; NaN if it closes nowhere."""

    low: float
    high: float
    turns: bool

    def angles(self, inset: float = 0.0) -> FloatArray:
        """The driver angles of the scripts, `inset` from dead positions."""
        inset = 0.0 if self.turns else inset
        return driver_angles(self.low + inset, self.high - inset, STEPS, even=self.turns)

    def ahead(self, first: float) -> float:
        """The full turns by which the angles of a motion that begins at `first` are ahead, rad."""
        return TURN * float(np.round((first - (self.low + self.high) / 2) / TURN))


def driver_travel(linkage: Linkage, theta2: FloatArray) -> Travel:
    """The turn from 0, or the range between dead positions with the first target, of a single linkage.

    The driver angles at the targets (N,), rad, are unwrapped along the motion.
    """
    if full_rotation(linkage):
        return Travel(0.0, TURN, True)
    index, _ = range_index(linkage, theta2[0])
    low, high = driver_ranges(linkage)[max(int(index), 0)].tolist()
    return Travel(low, high, False)


def moves(design: Candidate) -> bool:
    """Whether it can be drawn in any position."""
    theta2 = design.verdict.theta2
    return bool(np.isfinite(theta2).all()) and not np.isnan(driver_travel(design.linkage, theta2).low)


def legend(
    kinds: Iterable[Mechanism],
    cylinders: Iterable[Cylinder | None] = (),
    efforts: Iterable[EffortSpec | None] = (),
) -> list[tuple[str, str]]:
    """Style and words of the links in drawings of some kinds of linkages, and of cylinders and struts.

    >>> from grashof.problems import SliderCrank
    >>> legend([SliderCrank.mechanism])
    [('driver', 'driver O2-A'), ('coupler', 'coupler A-B-P'), ('output', 'slider B')]
    """
    found: dict[str, list[str]] = {}
    for body in (body for kind in kinds for body in bodies_of(kind)):
        found.setdefault(body.role, []).append(body.words)
    words = [(style, ", ".join(dict.fromkeys(names))) for style, names in found.items()]
    words += [("cylinder", "cylinder")] * any(each is not None for each in cylinders)
    drawn = (part for effort in efforts if effort is not None and effort.is_placed for part in effort.parts)
    return words + [("cylinder strut", "strut or spring")] * any(part.places for part in drawn)


def linkage_data(linkage: Linkage) -> dict[str, Any]:
    """A linkage for the scripts: its kind, and its parameters in full precision."""
    return {"mechanism": linkage.mechanism.word, **linkage.stated}


class _Drawn(NamedTuple):
    """A design, its linkage on the assembly of the first target, and the travel of its driver."""

    design: Candidate
    linkage: Linkage
    travel: Travel

    @classmethod
    def of(cls, design: Candidate) -> _Drawn:
        """The design as it is drawn."""
        linkage = design.linkage.changed(assembly=design.verdict.assembly[0])
        return cls(design, linkage, driver_travel(linkage, design.verdict.theta2))


def designs_of(problem: Problem, designs: Sequence[Candidate], rows: Sequence[Row]) -> list[dict[str, Any]]:
    """Designs that can be assembled, as JSON in full precision; the rows are those of `rows_of`."""
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
            **_wanted(problem, design.verdict, ahead),
            **cylinder_data(design.verdict.cylinder, design.values["cylinder_closed"]),
            **strut_data(linkage, design.verdict.effort),
            **effort_data(_effort(problem, design)),
            **_function(problem, linkage, design),
            "figures": {key: plain(value) for key, value in figures.items()},
        }
        for (design, linkage, travel), torque, figures in zip(
            drawn, _torques(problem, drawn), rows, strict=True
        )
        for ahead in [travel.ahead(design.verdict.theta2[0])]
    ]


def cylinder_data(driven: Cylinder | None, closed: float) -> dict[str, Any]:
    """A cylinder for the scripts, whose closed length may be unknown; empty without one."""
    if driven is None:
        return {}
    return {"cylinder": {**driven.stated, "closed": closed if np.isfinite(closed) else 0.0}}


def _effort(problem: Problem, design: Candidate) -> EffortCase | None:
    """The effort of a design with parts."""
    verdict = design.verdict
    return None if verdict.effort is None else effort_of_design(design.linkage, problem, verdict)


def _function(problem: Problem, linkage: Linkage, design: Candidate) -> dict[str, Any]:
    """Wanted and generated output of a function in the units of files; empty for other tasks."""
    if not problem.task.has_output.any():
        return {}
    curves = function_curves(linkage, problem.task, design.verdict, count=181)
    if curves is None:
        return {"function": None}
    columns, shown = asdict(curves), problem.task.counted_in.shown
    columns = {name: shown * values for name, values in columns.items()} | {
        "inputs": problem.task.counted_from.shown * curves.inputs
    }
    names = {
        "title": problem.task.output_words,
        "unit": problem.task.counted_in.of(problem.length_unit),
        "over": problem.task.input_axis(problem.length_unit),
    }
    return {"function": names | {name: compact(values.tolist()) for name, values in columns.items()}}


def _wanted(problem: Problem, verdict: Verdict, ahead: float) -> dict[str, Any]:
    """Driver angles and wanted torques there, counter-clockwise; empty without a wanted torque."""
    if problem.torque is None or not verdict.branch_ok:
        return {}
    theta2 = places_of(problem.torque, problem, verdict) - ahead
    return {"wanted": [theta2.tolist(), (verdict.direction * problem.torque.torques).tolist()]}


def _torques(problem: Problem, drawn: Sequence[_Drawn]) -> list[list[float | None] | None]:
    """Drive torque over the travel of each linkage, N m; None for each without dynamics.

    For a driver that starts and stops it is over the task only.
    """
    found: list[list[float | None] | None] = [None] * len(drawn)
    if problem.dynamics is None:
        return found
    for rows in by_kind([each.linkage for each in drawn]):
        torques = _torques_of_kind(problem, problem.dynamics, [drawn[row] for row in rows])
        for row, torque in zip(rows, torques, strict=True):
            found[row] = torque
    return found


def _torques_of_kind(
    problem: Problem, spec: DynamicsSpec, drawn: Sequence[_Drawn]
) -> list[list[float | None]]:
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
    """Driver angles over the travel, from the first turn of the motion on."""
    angles = travel.angles(INSET) + travel.ahead(verdict.theta2[0])
    least = float(verdict.theta2.min())
    return angles + TURN * np.ceil((least - angles) / TURN - _ROUNDING) if travel.turns else angles
