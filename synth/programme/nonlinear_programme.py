"""The nonlinear programme of a kind of linkage: built once for each form, solved by Ipopt from a start."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import lru_cache
from typing import Any

import casadi as ca
import numpy as np

from grashof.analysis.judge.design import Constraint, OwnObjective, one_at_a_time
from grashof.synth.programme.builder import STOPPED, Builder, Programme, always
from grashof.synth.programme.constraints import (
    Targets,
    bound_transmission,
    close_at_points,
    close_at_poses,
    keep_out,
    own_goal,
    require_modes,
    require_own,
    stand_nearest,
)
from grashof.synth.programme.errors import bound_error, square
from grashof.synth.programme.instants import bound_second_loop, overlooked_instants
from grashof.synth.programme.limit_positions import stand_at_limits
from grashof.synth.programme.limits import ADDED, cost_of_goals, peak_unit, require_limits
from grashof.synth.programme.second_loop import SecondLoop
from grashof.synth.programme.start import Start
from grashof.synth.programme.structure import Form
from grashof.synth.programme.unknowns import FAR, Unknowns, interleaved
from grashof.synth.programme.user_functions import numpy_on_symbols
from grashof.synth.quantities.along_motion import overlooked
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.quantities.target_constraints import AtTarget
from grashof.synth.theory.stopping import StopRequested, raise_if_stopped, stop_requested

LONG = 40  # targets: programmes of more can be stopped, and are not begun after a request to stop
MOST_ITERATIONS = 150
MENDING = 60  # iterations of a near miss mended in place, which takes a dozen where it succeeds
PATIENCE = (150, 400)  # iterations where the error is bounded: for trade-offs, and where the user requires it
# Most violation of constraints on the way from a feasible start: solves that exceed it rarely return.
NEAR = 1.0
SLIGHT = 1e-6  # weight of the error beside the slack
SOLVED = ("Solve_Succeeded", "Solved_To_Acceptable_Level")
EXCHANGES = 4  # most repetitions of a solve


@dataclass(frozen=True, slots=True)
class Solve:
    """Outcome of one solve in the frame of the search; the solver's status is recorded, not trusted."""

    points: tuple[complex, complex, complex, complex, complex]  # O2, O4, and A, B, P at the first target
    theta2: tuple[float, ...]  # in the order of visit, rad, as theta3
    theta3: tuple[float, ...]
    body_angle: float  # rad, see `Start`
    status: str  # Ipopt's return status
    iterations: int
    # the greatest magnitude along the motion, by the key of each quantity in the programme; `Problem.scale`
    peaks: Mapping[str, float] = field(default_factory=dict)
    second: SecondLoop | None = None  # of a six-bar

    @classmethod
    def unchanged(cls, start: Start, status: str) -> Solve:
        """One that leaves its start as it is."""
        points = (start.o2, start.o4, start.a, start.b, start.p)
        return cls(points, start.theta2, start.theta3, start.body_angle, status, 0, second=start.second)


@one_at_a_time
def solve(scaled: ScaledProblem, start: Start, max_iter: int | None = None) -> Solve:
    """Run Ipopt from one start, by default with more iterations than usual where the error is bounded."""
    long = start.terms.bounded and start.second is None
    patience = PATIENCE[scaled.bounded] if long else MOST_ITERATIONS
    if start.terms.stay and not scaled.every_constraint:
        patience = MENDING
    form = Form.of(scaled, start)
    most = patience if max_iter is None else max_iter
    try:
        if form.targets > LONG:
            raise_if_stopped()
        programme = _programme(form, most, scaled.every_constraint, scaled.own_objective)
    except StopRequested:
        return Solve.unchanged(start, STOPPED)
    given = programme.arguments(scaled, start)
    fixed = sum(np.count_nonzero(given[f"lb{kind}"] == given[f"ub{kind}"]) for kind in "xg")
    if (given["lbx"] > given["ubx"]).any() or fixed > len(given["lbx"]):  # nothing is left to solve for
        return Solve.unchanged(start, "Contradictory_Limits")
    answer = np.asarray(programme.solver(**given)["x"]).ravel()
    stats = programme.solver.stats()
    status = str(stats["return_status"])
    if programme.callback is not None and programme.callback.ended_by_another(status):
        raise KeyboardInterrupt
    found = {name: answer[place] for name, place in programme.places.items()}
    pivots = {name: complex(*found[name]) for name in form.kind.linkage.mechanism.pivots}
    p, theta3 = complex(scaled.targets[0]), start.theta3
    if not form.poses:
        theta3 = tuple(found["theta3"].tolist())
        turned = complex(np.exp(1j * theta3[start.visit.index(0)]))
        p = pivots["a"] + complex(*found["arm"]) * turned
        pivots |= form.kind.completed(pivots, turned, {name: float(one[0]) for name, one in found.items()})
    second = None if start.second is None else start.second.solved(found)
    done = Solve(
        points=(pivots["o2"], pivots["o4"], pivots["a"], pivots["b"], p),
        theta2=tuple(found["theta2"].tolist()),
        theta3=theta3,
        body_angle=float(found["body_angle"][0]) if "body_angle" in found else start.body_angle,
        status=status,
        iterations=int(stats["iter_count"]),
        peaks={key: float(found[key][0]) * peak_unit(form, scaled, start, key) for key in form.along},
        second=second,
    )
    if second is None:
        return done
    p = begun_from(start, done).track[2][start.visit.index(0)]
    return replace(done, points=(*done.points[:4], complex(p)))


_IPOPT = {
    "print_level": 0,
    "sb": "yes",
    "tol": 1e-8,
    "constr_viol_tol": 1e-10,
    "acceptable_iter": 5,
    "acceptable_tol": 1e-6,
    "acceptable_constr_viol_tol": 1e-9,
    "bound_relax_factor": 0.0,
    "bound_push": 1e-6,
    "bound_frac": 1e-6,
    "mu_init": 1e-3,
    "mumps_pivot_order": 0,
    "max_wall_time": 10.0,
}


@lru_cache(maxsize=32)
def _programme(
    form: Form, max_iter: int, constraints: tuple[Constraint, ...], own_objective: OwnObjective | None
) -> Programme:
    with numpy_on_symbols():
        build, cost = _stated(form, constraints, own_objective)
    near = {"theta_max_fact": NEAR} if form.most_error else {}
    options: dict[str, Any] = {
        "print_time": False,
        "show_eval_warnings": False,
        "calc_lam_p": False,
        "ipopt": {**_IPOPT, **near, "max_iter": max_iter},
    }
    return build.programme(cost, options, long=form.targets > LONG)


def _stated(
    form: Form, constraints: tuple[Constraint, ...], own_objective: OwnObjective | None
) -> tuple[Builder, ca.SX]:
    """Unknowns and rows of a programme, and its cost."""
    build = Builder()
    x, targets = Unknowns.of(build, form), Targets.of(build, form)
    if form.elastic:
        build.slack = build.unknown("slack", 1, lambda *_: 1.0, always(0.0, FAR))
    places = close_at_poses(build, form, x) if form.poses else close_at_points(build, form, x, targets)
    require_modes(build, form, x, places)
    stand_at_limits(build, form, x, places)
    stand_nearest(build, form, x, places, targets)
    bound_error(build, form, x, places, targets)
    bound_transmission(build, form, x, places)
    bound_second_loop(build, form, x)
    require_limits(build, form, x, places)
    keep_out(build, form, x, places)
    if form.regions:
        from grashof.synth.programme.regions import require_regions

        require_regions(build, form, x, places)
    concave = [each for each in constraints if isinstance(each, AtTarget) and each.concave is not None]
    if concave:
        from grashof.synth.programme.regions import require_pieces

        require_pieces(build, places, concave)
    require_own(build, form, x, places, constraints)
    cost = cost_of_goals(build, form, x, places)
    if form.own_goal and own_objective is not None:
        cost += own_goal(build, form, x, places, own_objective)
    if form.fits:  # the error comes first; the rest decides only where the error leaves freedom
        cost = targets.error_scale * square(form, x, places, targets) - 1e-8 * x.tau
    if form.stay:
        names = form.kind.linkage.mechanism.pivots
        begun = build.parameter(
            lambda _, start: interleaved(np.array([getattr(start, name) for name in names])), 2 * len(names)
        )
        cost = ca.sumsqr(ca.vertcat(*(getattr(x, name) for name in names)) - begun)
    if build.slack is not None:
        cost = build.slack
        if not form.exact:  # of equal slack the smaller error
            cost += SLIGHT * targets.error_scale * square(form, x, places, targets)
    return build, cost


def solve_by_exchange(scaled: ScaledProblem, start: Start) -> Solve:
    """Solve; add driver angles where a bound is exceeded, and repeat from there; of six-bars exchange them.

    An exchange method for a bound that holds over an interval (Hettich & Kortanek 1993, section 7).
    """
    solved = solve(scaled, start)
    for _ in range(EXCHANGES):
        if solved.status not in SOLVED or stop_requested():
            break
        points, theta2 = np.array(solved.points), np.array(solved.theta2)
        ways = points, theta2, start.direction, start.assembly
        found = {key: overlooked(scaled, key, *ways, bound) for key, bound in solved.peaks.items()}
        if not any(found.values()) and not _overlooked(scaled, start, solved):
            break
        added = {key: (*peaks, *start.terms.peaks_at.get(key, ()))[:ADDED] for key, peaks in found.items()}
        start = begun_from(start, solved).under(peaks_at=added)
        again = solve(scaled, start)
        if again.status not in SOLVED:
            break
        solved = replace(again, iterations=solved.iterations + again.iterations)
    return solved


def _overlooked(scaled: ScaledProblem, start: Start, solved: Solve) -> bool:
    if start.second is None:
        return False
    return overlooked_instants(Form.of(scaled, start), start, begun_from(start, solved))


def begun_from(start: Start, solved: Solve) -> Start:
    """A start where a solve ended."""
    return start.at(solved.points, solved.theta2, solved.theta3, solved.body_angle, solved.second)
