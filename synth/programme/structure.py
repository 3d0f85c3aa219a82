"""What a nonlinear programme contains, its unknowns and its parameters, as CasADi symbols."""

from __future__ import annotations

from dataclasses import dataclass

import casadi as ca
import numpy as np

from grashof.problems import Box, Rotatability, TransmissionOver
from grashof.synth.programme.scaled_problem import ScaledProblem
from grashof.synth.programme.screening import GROUPS
from grashof.synth.programme.start import Start

BOXES = ("o2", "o4", "a", "b")
LOADS = 10  # numbers that drive the torque
ADDED = 8  # driver angles, at most, that are added to the grid
STEPS = 24  # in every half turn, between driver angles at which the torque is bounded
PLANES = 4  # half-planes that bound a free region


@dataclass(frozen=True, slots=True)
class Form:
    """What the programme contains; one is built, and kept, for each form.

    Parameters
    ----------
    targets : int
    poses : bool
        Targets are whole poses, met exactly: A, B and P move with the body.
    positions, angles : tuple of bool
        Which targets, in the order of visit, have a position, and a body angle.
    exact : bool
        Every target is met; otherwise the squared distances are the objective.
    timed : bool
        Driver rotations from the first target are prescribed.
    crank : bool
        The driver turns fully.
    same_branch : bool
    over_task : bool
        Transmission is judged over the task, not over the turn.
    ratio, box_a, box_b, compact : bool
        Whether these requirements, and the size, have a part in it.
    torque : int
        At how many driver angles the torque is bounded; 0 where it has no part in it.
    closed : bool
        The task motion is a whole turn.
    keep_out : tuple of str
        Of o2, o4, a, b, p: which are held in free regions, the moving ones at every target.
    stay : bool
        The distance from the start is the objective.
    elastic : bool
        Requirements may be missed; how far is the objective.
    nearest : tuple of bool
        At which targets, in the order of visit, the driver stands where the miss is least, as the
        judge has it; of timed targets, that of all together.
    most_error, zoned : bool
        The error as a whole, or that at every target, is bounded, and the problem's objective decides.
    """

    targets: int
    poses: bool
    positions: tuple[bool, ...]
    angles: tuple[bool, ...]
    exact: bool
    timed: bool
    crank: bool
    same_branch: bool
    over_task: bool
    ratio: bool
    box_a: bool
    box_b: bool
    compact: bool
    torque: int
    closed: bool
    keep_out: tuple[str, ...]
    stay: bool
    elastic: bool
    nearest: tuple[bool, ...]
    most_error: bool
    zoned: bool

    @property
    def fits(self) -> bool:
        """Whether the objective is the error, which comes before all others."""
        return not (self.exact or self.most_error or self.zoned)

    @classmethod
    def of(cls, scaled: ScaledProblem, start: Start) -> Form:
        """The form that a problem and a start call for."""
        wanted, closed = scaled.wanted, scaled.closed
        low = min(limits[0] for limits in wanted.link_lengths)
        high = max(limits[1] for limits in wanted.link_lengths)
        plain = start.stay or bool(start.relaxed) or not (scaled.exact or start.bounded)
        return cls(
            targets=len(start.visit),
            poses=scaled.motion is not None,
            positions=tuple((scaled.weights > 0)[list(start.visit)].tolist()),
            angles=tuple((scaled.turn_weights > 0)[list(start.visit)].tolist()),
            exact=scaled.exact,
            timed=scaled.timed,
            crank=wanted.rotatability is not Rotatability.ANY,
            same_branch=wanted.same_branch,
            over_task=wanted.transmission_over is TransmissionOver.TASK and not closed,
            ratio=bool(start.relaxed) or high > low * wanted.link_ratio_max,
            box_a=wanted.a != Box() and wanted.a is not None,
            box_b=wanted.b != Box() and wanted.b is not None,
            compact=start.objective.compactness > 0 and not plain,
            torque=0 if plain or start.objective.torque == 0 else _grid_size(start, closed),
            closed=closed,
            keep_out=_held(scaled),
            stay=start.stay,
            elastic=bool(start.relaxed),
            nearest=_nearest(scaled, start),
            most_error=bool(np.isfinite(start.most_error)),
            zoned=start.zoned,
        )

    def places_of(self, name: str) -> int:
        """At how many places a point is held in free regions."""
        return 1 if name in ("o2", "o4") else self.targets


def _grid_size(start: Start, closed: bool) -> int:
    """At how many driver angles the torque is bounded."""
    long = closed or abs(start.theta2[-1] - start.theta2[0]) > np.pi
    return (2 if long else 1) * STEPS + 1


def _nearest(scaled: ScaledProblem, start: Start) -> tuple[bool, ...]:
    """At which targets a limit, or the objective, depends on the driver angle that the judge finds."""
    wanted, count = scaled.wanted, len(start.visit)
    if scaled.exact or start.relaxed or start.loose:
        return (False,) * count
    moving = set(wanted.keep_out_for) - {"o2", "o4"} if wanted.keep_out else set()
    boxed = any(box not in (None, Box()) for box in (wanted.a, wanted.b))
    zoned = start.zoned and (scaled.has_angles or scaled.timed)
    every = bool(boxed or moving or scaled.constraints or zoned)
    if scaled.timed:
        return (every and wanted.theta2_start_deg is None,) * count
    over_task = wanted.transmission_over is TransmissionOver.TASK and not scaled.closed
    ends = bool(over_task and (wanted.transmission_min_deg > 0 or start.bounded))
    nearest = np.full(count, every)
    nearest[[0, -1]] |= ends
    if wanted.theta2_start_deg is not None:  # a pose is met where it is nearest, a point where it is told
        nearest[start.visit.index(0)] = scaled.has_angles
    return tuple(nearest.tolist())


def _held(scaled: ScaledProblem) -> tuple[str, ...]:
    """Points that the programme can hold in free regions: P is where the targets have it."""
    if not scaled.wanted.keep_out:
        return ()
    from grashof.synth.programme.keep_out_depth import points_kept_out

    return tuple(name for name in points_kept_out(scaled.wanted) if name != "p" or not scaled.exact)


@dataclass(frozen=True, slots=True)
class Unknowns:
    """The unknowns: pivots and coupler point at the first target, lengths, angles, and what is worst.

    Angles are lifted, so that order is a linear constraint and no arc function is differentiated.
    `theta3` and `arm` (u, v) follow where whole poses are met exactly; `body_angle` is there for others.
    """

    vector: ca.SX
    parts: dict[str, ca.SX]

    @classmethod
    def of(cls, form: Form) -> Unknowns:
        """Symbols for a form."""
        n = form.targets
        sizes = {"o2": 2, "o4": 2, "a": 2, "b": 2, "r": 4, "theta1": 1, "theta2": n, "tau": 1}
        if not form.poses:
            sizes |= {"theta3": n, "arm": 2}
        if any(form.angles) and not form.poses:
            sizes |= {"body_angle": 1}
        if form.compact:
            sizes |= {"low": 2, "high": 2}
        if form.torque:
            sizes |= {"peak": 1}
        if form.elastic:
            sizes |= {"slack": 1}
        parts = {name: ca.SX.sym(name, size) for name, size in sizes.items()}
        return cls(ca.vertcat(*parts.values()), parts)

    def __getitem__(self, name: str) -> ca.SX:
        return self.parts[name]


@dataclass(frozen=True, slots=True)
class Given:
    """The parameters, cut from one vector; targets stand in the order of visit."""

    vector: ca.SX
    rotation: ca.SX
    shift: ca.SX
    targets: ca.SX
    turns: ca.SX
    square_weights: ca.SX
    timing: ca.SX
    at_first: ca.SX
    body: ca.SX
    direction: ca.SX
    assembly: ca.SX
    longer: ca.SX
    margin: ca.SX
    ratio: ca.SX
    least_transmission: ca.SX
    weights: ca.SX
    load: ca.SX
    torque_at: ca.SX
    error_scale: ca.SX
    arms: ca.SX
    lengths: ca.SX
    start: ca.SX
    angles: ca.SX
    relaxed: ca.SX
    most_error: ca.SX
    zones: ca.SX
    origin: ca.SX
    scale: ca.SX
    planes: ca.SX
    box: dict[str, tuple[ca.SX, ca.SX]]

    @classmethod
    def of(cls, form: Form) -> Given:
        """Symbols for a form."""
        n = form.targets
        sizes = {
            "rotation": 2 * n, "shift": 2 * n, "targets": 2 * n, "turns": n,
            "square_weights": 2 * n, "timing": n, "at_first": n, "body": 2,
            "direction": 1, "assembly": 1, "longer": 1, "margin": 1, "ratio": 1, "least_transmission": 1,
            "weights": 3, "load": LOADS, "torque_at": ADDED,
            "error_scale": 1, "arms": 2, "lengths": 8,
            "start": 8, "angles": 2, "relaxed": len(GROUPS), "most_error": 1, "zones": 2 * n,
            "origin": 2, "scale": 1,
            "planes": 3 * PLANES * sum(map(form.places_of, form.keep_out)), "boxes": 16,
        }  # fmt: skip
        parts = {name: ca.SX.sym(name, size) for name, size in sizes.items()}
        vector = ca.vertcat(*parts.values())
        boxes = ca.reshape(parts.pop("boxes"), 2, 8)
        box = {name: (boxes[:, 2 * i], boxes[:, 2 * i + 1]) for i, name in enumerate(BOXES)}
        return cls(vector=vector, box=box, **parts)

    def displaced(self, point: ca.SX, pose: int) -> ca.SX:
        """Where a point of the body at the first pose is at another one."""
        cos, sin = self.rotation[2 * pose], self.rotation[2 * pose + 1]
        turned = ca.vertcat(cos * point[0] - sin * point[1], sin * point[0] + cos * point[1])
        return turned + self.shift[2 * pose : 2 * pose + 2]

    def outward(self, point: ca.SX) -> ca.SX:
        """A point of the frame in the problem's unit."""
        return self.scale * point + self.origin

    def target(self, k: int) -> ca.SX:
        """Where P has to be."""
        return self.targets[2 * k : 2 * k + 2]
