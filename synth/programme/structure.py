"""The form of a nonlinear programme: one programme is built, and kept, for each form."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from grashof.problems import Rotatability, TransmissionOver
from grashof.problems.values.dynamics.motor import MotorSpec
from grashof.problems.values.linkages.mechanism import Mechanism
from grashof.problems.values.requirements.all_quantities import QUANTITIES
from grashof.problems.values.requirements.quantities import Needs, Scope
from grashof.problems.values.requirements.requirements import LIMITS
from grashof.synth.programme.start import Start
from grashof.synth.quantities.along_motion import ALONG
from grashof.synth.quantities.formulas import Formulas, of_six_bars
from grashof.synth.quantities.kind import Kind
from grashof.synth.quantities.loading import Loading
from grashof.synth.quantities.regions import pairs_of
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.quantities.screening import points_kept_out
from grashof.synth.quantities.wanted_torque import DEVIATIONS, WantedCurve

MOST_SIDES = 64  # half-planes that bound a convex piece of a region
PLANES = 4  # half-planes that bound a free region
STEPS = 24  # of the driver in every half turn, at whose ends quantities along the motion are bounded


@dataclass(frozen=True, slots=True)
class Form:
    """The contents of a programme."""

    kind: Kind  # of the first loop
    row: Mechanism
    targets: int
    poses: bool  # targets are whole poses, met exactly: A, B and P move with the body
    positions: tuple[bool, ...]  # which targets, in the order of visit, have a position
    angles: tuple[bool, ...]  # which have a body angle
    exact: bool  # every target is met; otherwise the squared distances are the objective
    timed: bool  # driver rotations from the first target are prescribed
    at_limits: bool  # targets are the limit positions of a swing or stroke
    crank: bool  # the driver turns fully
    same_branch: bool
    over_task: bool  # transmission is judged over the task, not over the turn
    limited: tuple[str, ...]  # fields of the requirements with limits that can bind
    goals: tuple[str, ...]  # keys of the quantities weighed; none where another objective comes first
    own_goal: bool  # the user's own objective decides
    grid: int  # number of instants at which quantities along the motion are bounded
    loading: Loading | None  # that causes the torque and forces that are bounded; None without them
    motor: MotorSpec | None  # drive law where anything is bounded along the motion
    torque: WantedCurve | None  # wanted, where the deviation from it counts
    closed: bool  # the task motion is a full turn
    keep_out: tuple[str, ...]  # of o2, o4, a, b, p those in free regions, the moving ones at every target
    # Fields with regions, and the number of half-planes of each, 0 for a segment; segments along an axis need
    # only bounds.
    regions: tuple[tuple[str, int], ...]
    stay: bool  # the distance from the start is the objective
    elastic: bool  # requirements may be missed; the amount is the objective
    # Targets, in the order of visit, at which the driver has the angle of the least miss, as for the judge;
    # of timed targets, that of all together.
    nearest: tuple[bool, ...]
    most_error: bool  # the total error is bounded, and the problem's objective decides
    zoned: bool  # the error at every target is bounded, and the problem's objective decides

    @property
    def fits(self) -> bool:
        """Whether the objective is the error, which precedes all others."""
        return not (self.exact or self.most_error or self.zoned)

    @property
    def two_loops(self) -> bool:
        """Whether a second dyad carries P."""
        return len(self.row.loops) > 1

    @property
    def formulas(self) -> Formulas:
        """Quantities of the design."""
        return of_six_bars(self.row.lengths) if self.two_loops else self.kind.formulas

    @property
    def along(self) -> tuple[str, ...]:
        """Keys of the quantities bounded along the motion; of two loops the judge alone knows them."""
        if self.two_loops:
            return ()
        limited = [LIMITS[name].quantity.key for name in self.limited]
        return tuple(key for key in ALONG if key in limited or key in self.goals)

    @property
    def deviations(self) -> tuple[str, ...]:
        """Keys of the deviations from a wanted torque that are bounded or improved."""
        limited = [LIMITS[name].quantity.key for name in self.limited]
        found = (key for key in DEVIATIONS if key in limited or key in self.goals)
        return () if self.torque is None else tuple(found)

    @classmethod
    def of(cls, scaled: ScaledProblem, start: Start) -> Form:
        """The form for a problem and a start."""
        wanted, closed = scaled.wanted, scaled.closed
        plain = start.terms.stay or bool(start.terms.relaxed) or not (scaled.exact or start.terms.bounded)
        made = cls(
            kind=scaled.kind,
            row=scaled.kind.linkage.mechanism if start.second is None else start.second.row,
            targets=len(start.visit),
            poses=scaled.motion is not None,
            positions=tuple((scaled.weights > 0)[list(start.visit)].tolist()),
            angles=tuple((scaled.turn_weights > 0)[list(start.visit)].tolist()),
            exact=scaled.exact,
            timed=scaled.timed,
            at_limits=scaled.problem.task.at_limits,
            crank=wanted.rotatability is not Rotatability.ANY,
            same_branch=wanted.same_branch,
            over_task=wanted.transmission_over is TransmissionOver.TASK and not closed,
            limited=_limited(scaled, start),
            goals=() if plain else tuple(start.terms.goals),
            own_goal=not plain and start.terms.objective is None,
            grid=_grid_size(start, closed),
            loading=scaled.loading,
            motor=scaled.drive[0],
            torque=scaled.wanted_torque if start.second is None else None,
            closed=closed,
            keep_out=points_held(scaled),
            regions=_regions(scaled, start),
            stay=start.terms.stay,
            elastic=bool(start.terms.relaxed),
            nearest=held_nearest(scaled, start),
            most_error=bool(np.isfinite(start.terms.most_error)),
            zoned=start.terms.zoned,
        )
        if not made.deviations and not (made.torque is not None and made.torque.weight):
            made = replace(made, torque=None)
        # One programme serves short and long motions, whatever loads act.
        if not made.along:
            return replace(made, grid=0, loading=None, motor=None)
        heavy = any(QUANTITIES[key].needs is Needs.DYNAMICS for key in made.along)
        return made if heavy else replace(made, loading=None)


def _limited(scaled: ScaledProblem, start: Start) -> tuple[str, ...]:
    """Fields whose limits can bind; the ratio of links cannot where lengths are close enough."""
    wanted, names = scaled.wanted, list(scaled.wanted.limited)
    low = min(limits[0] for limits in wanted.link_lengths)
    high = max(limits[1] for limits in wanted.link_lengths)
    if not start.terms.relaxed and high <= low * wanted.link_ratio_max:
        names.remove("link_ratio_max")
    return tuple(names)


def _regions(scaled: ScaledProblem, start: Start) -> tuple[tuple[str, int], ...]:
    formulas = scaled.kind.formulas if start.second is None else of_six_bars(())
    return tuple(
        (name, min(len(region.corners), MOST_SIDES) if region.on is None else 0)
        for name, region, *_ in pairs_of(scaled.wanted, formulas)
        if not region.is_upright
    )


def _grid_size(start: Start, closed: bool) -> int:
    """Number of driver angles at which quantities along the motion are bounded."""
    long = closed or abs(start.theta2[-1] - start.theta2[0]) > np.pi
    return (2 if long else 1) * STEPS + 1


def held_nearest(scaled: ScaledProblem, start: Start) -> tuple[bool, ...]:
    """Targets at which a limit, or the objective, depends on the driver angle that the judge finds."""
    wanted, count = scaled.wanted, len(start.visit)
    if scaled.exact or start.terms.relaxed or start.terms.loose or start.second is not None:
        return (False,) * count
    moving = (
        set(wanted.keep_out_for) - set(scaled.kind.linkage.mechanism.ground) if wanted.keep_out else set()
    )
    placed = any(
        limit.quantity.over is Scope.TARGETS and name != "theta2_start_deg"
        for name, limit in wanted.limited.items()
    )
    torque = scaled.problem.torque
    placed = placed or (torque is not None and torque.over == "target")
    own = scaled.constraints or (start.terms.bounded and start.terms.objective is None)
    every = bool(placed or moving or own)
    if scaled.timed:
        return (bool(every or scaled.at_targets) and wanted.theta2_start_deg is None,) * count
    over_task = wanted.transmission_over is TransmissionOver.TASK and not scaled.closed
    ends = bool(over_task and (wanted.transmission_min_deg > 0 or start.terms.bounded))
    # where the first angle is given, the judge meets poses by least squares, whatever their zones
    zoned = start.terms.zoned and scaled.has_angles and wanted.theta2_start_deg is not None
    nearest = np.full(count, every or zoned)
    nearest[[0, -1]] |= ends or torque is not None
    nearest[[limit.k for limit in scaled.at_targets]] = True
    if wanted.theta2_start_deg is not None:  # a pose is met where it is nearest, a point where it is given
        nearest[start.visit.index(0)] = scaled.has_angles
    return tuple(nearest.tolist())


def points_held(scaled: ScaledProblem) -> tuple[str, ...]:
    """Points that the programme can keep in free regions, except a P that exact targets fix."""
    held = (name for name in points_kept_out(scaled.wanted) if name in scaled.kind.linkage.mechanism.points)
    return tuple(name for name in held if name != "p" or not scaled.exact)
