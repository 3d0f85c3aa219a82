"""The requirements of a problem that have forms, and those that have none."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import combinations
from typing import Any

import numpy as np

from grashof.problems import Box, Problem, Requirements, Rotatability, TransmissionOver
from grashof.problems.values.arrays import TURN, FloatArray, Limits
from grashof.problems.values.requirements.requirements import LIMITS
from grashof.synth.proof.curve.curve import Curve, poles
from grashof.synth.proof.forms.loop import LoopLimits
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.theory.burmester import Displacements

# Limits are inclusive: the judge overlooks 1e-9 (sizes, rad or ratio), and so do proofs, with a margin.
SLACK = 2e-9
LEAST = float(np.radians(0.01))  # rad: designs below it count as none
TOGETHER = 1e-9  # sizes, and unit rotations: poses closer are the same one
ONE_POINT = 1e-6  # sizes: poles closer are the same one
THREE, POSES = 3, 4
# Fields of the requirements that have forms.
_FORMS = (
    "transmission_min_deg",
    "link_length", "r1", "r2", "r3", "r4", "link_ratio_max", "coupler_arms",
    "o2", "o4", "a", "b", "a_on_body", "b_on_body",
    "driver_sense", "driver_rotation_deg", "theta2_start_deg", "ground_angle_deg",
)  # fmt: skip
_GROUND = {"o2", "o4"}  # pivots for which areas kept out have a form
_OF_ORDER = ("driver_sense", "driver_rotation_deg")  # these have forms where the poses are met in order
ANY_LENGTH = (0.0, np.inf)


@dataclass(frozen=True, slots=True)
class Dyad:
    """The requirements on one of the two dyads, in the frame of a `Curve`, in sizes."""

    length: Limits  # limits of the distance from its ground pivot to its moving pivot
    arm: Limits  # limits of the distance from its moving pivot to P
    ground: Box  # where the ground pivot may be
    moving: Box  # where the moving pivot may be, at every pose
    on_body: Box  # the same in the frame of the body
    keep_out: tuple[FloatArray, ...] = ()  # areas (m, 2) in which the ground pivot must not be


@dataclass(frozen=True, slots=True)
class Required:
    """All requirements that have forms, widened by the slack of the judge."""

    curve: Curve
    origin: complex  # sizes, of the frame of the curve, in the frame of the search
    first_turn: float  # rad, angle of the body in the first pose
    driver: Dyad
    driven: Dyad
    loop: LoopLimits
    ordered: bool
    over_turn: bool  # whether the transmission angle counts over the full turn
    sense: int  # of the driver; 0 for either
    rotation: Limits  # rad, of the driver from the first pose to the last
    theta2_start: float | None  # rad
    ground_angle: Limits | None  # rad
    floor: float  # rad, transmission angle below which no design counts

    @classmethod
    def of(cls, scaled: ScaledProblem, at_least: float | None = None) -> Required:
        """The requirements on the first four (or three) poses; `at_least` is a greater angle (deg)."""
        motion, wanted = scaled.motion, scaled.wanted
        if motion is None:
            raise TypeError("only whole poses that are met exactly have a curve of dyads")
        origin = complex(scaled.targets[0])
        r1, r2, r3, r4 = (_widened(limits) for limits in wanted.link_lengths)
        over_turn = wanted.transmission_over is TransmissionOver.CYCLE or scaled.closed
        turns = over_turn or wanted.rotatability is not Rotatability.ANY
        margin = 0.0 if wanted.rotatability is Rotatability.ANY else wanted.rotatability_margin
        senses = LIMITS["driver_sense"].words[wanted.driver_sense]
        rotation = np.radians(wanted.driver_rotation_deg or (0.0, 360.0))
        return cls(
            curve=Curve.of(Displacements(motion.rotation[:POSES], motion.shift[:POSES]), origin),
            origin=origin,
            first_turn=motion.first_turn,
            driver=_dyad(wanted, "o2", "a", r2, origin),
            driven=_dyad(wanted, "o4", "b", r4, origin),
            loop=LoopLimits(
                lengths=(r1, r2, r3, r4),
                ratio=wanted.link_ratio_max * (1 + SLACK),
                turns=turns,
                margin=margin - SLACK,
                longer_ground=_SIGNS.get(wanted.rotatability, (1, -1)),
                # Without a motion on one branch nothing is transmitted over the task.
                one_branch=wanted.same_branch or not over_turn,
            ),
            ordered=wanted.order,
            over_turn=over_turn,
            sense=int(np.sign(sum(senses))) if wanted.order else 0,
            rotation=_widened((float(rotation[0]), float(rotation[1]))) if wanted.order else (0.0, TURN),
            theta2_start=wanted.angle_of("theta2_start_deg"),
            ground_angle=_directions(wanted),
            floor=max(LEAST, float(np.radians(max(wanted.transmission_min_deg, at_least or 0.0))) - SLACK),
        )

    @classmethod
    def within(cls, motion: Displacements, reach: float, least: float = 0.0) -> Required:
        """Dyads alone: with arms and lengths from `least` up to `reach`, sizes."""
        limits = _widened((least, reach))
        dyad = Dyad(limits, limits, Box(), Box(), Box())
        return cls(
            curve=Curve.of(Displacements(motion.rotation[:POSES], motion.shift[:POSES]), 0j),
            origin=0j,
            first_turn=0.0,
            driver=dyad,
            driven=dyad,
            loop=LoopLimits((ANY_LENGTH, limits, ANY_LENGTH, limits), np.inf, False, 0.0, (1, -1), False),
            ordered=False,
            over_turn=False,
            sense=0,
            rotation=(0.0, TURN),
            theta2_start=None,
            ground_angle=None,
            floor=LEAST,
        )

    @property
    def longest(self) -> float:
        """Of both dyads, sizes."""
        return max(self.driver.length[1], self.driven.length[1])


_SIGNS = {Rotatability.CRANK_ROCKER: (1,), Rotatability.DOUBLE_CRANK: (-1,)}


def _dyad(wanted: Requirements, ground: str, moving: str, length: Limits, origin: complex) -> Dyad:
    return Dyad(
        length=length,
        arm=_widened(wanted.coupler_arms or ANY_LENGTH),
        ground=_moved(getattr(wanted, ground), origin),
        moving=_moved(getattr(wanted, moving), origin),
        on_body=_moved(getattr(wanted, f"{moving}_on_body"), 0j),
        keep_out=tuple(area - [origin.real, origin.imag] for area in wanted.keep_out)
        if ground in wanted.keep_out_for
        else (),
    )


def _widened(limits: Limits) -> Limits:
    return limits[0] - SLACK, limits[1] + SLACK


def _moved(box: Box | None, origin: complex) -> Box:
    box = box or Box()
    x, y = (_widened((side[0] - begin, side[1] - begin))
            for side, begin in ((box.x, origin.real), (box.y, origin.imag)))  # fmt: skip
    return Box(x, y)


def _directions(wanted: Requirements) -> Limits | None:
    """Directions of the ground line that are allowed; None where it is all of them."""
    given: Any = wanted.ground_angle_deg
    if given is None:
        return None
    low, high = np.radians(given if isinstance(given, tuple) else (given, given))
    return _widened((float(low), float(high))) if high - low < np.pi else None


def left_out(scaled: ScaledProblem, forms: Sequence[str] = _FORMS) -> tuple[str, ...]:
    """Fields of the stated requirements that have no form, or only one for a part of them.

    `forms` are the fields that have some; of four-bars by default.

    >>> from grashof import load
    >>> problem = load("luggage")
    >>> compact = replace(problem, requirements=replace(problem.requirements, size=(0, 13)))
    >>> left_out(ScaledProblem.of(problem)), left_out(ScaledProblem.of(compact))
    ((), ('size',))
    """
    wanted = scaled.problem.requirements
    without = [name for name in wanted.limited if name not in forms and not _says_nothing(wanted, name)]
    if not wanted.order:
        without += [name for name in wanted.limited if name in _OF_ORDER and not _says_nothing(wanted, name)]
    moving = wanted.keep_out and not set(wanted.keep_out_for) <= _GROUND
    without += ["keep_out"] * bool(moving) + ["constraints"] * bool(scaled.constraints)
    without += [name for name in wanted.regions if name in forms]  # the box around a region has one
    without += ["at"] * bool(wanted.at)
    return tuple(without)


def _says_nothing(wanted: Requirements, name: str) -> bool:
    limit = LIMITS[name]
    return bool(limit.words) and getattr(wanted, name) == limit.widest


def with_forms(scaled: ScaledProblem, forms: Sequence[str] = _FORMS) -> ScaledProblem:
    """The problem without the requirements that have no form."""
    wanted = scaled.problem.requirements
    changed: dict[str, Any] = {
        name: LIMITS[name].widest if LIMITS[name].words else None
        for name in left_out(scaled, forms)
        if name in LIMITS
    }
    changed |= {name: Box(each.x, each.y) for name, each in wanted.regions.items() if name in forms}
    for_ground = tuple(name for name in wanted.keep_out_for if name in _GROUND)
    if for_ground:
        changed["keep_out_for"] = for_ground
    else:
        changed["keep_out"] = ()
    problem = replace(scaled.problem, requirements=replace(wanted, **changed))
    return ScaledProblem.of(problem)


def _transmits_nothing(scaled: ScaledProblem) -> str:
    """The requirement that allows a transmission angle of zero; empty where none does."""
    wanted = scaled.wanted
    over_turn = wanted.transmission_over is TransmissionOver.CYCLE
    if not wanted.same_branch and not over_turn and not scaled.closed:
        return "same_branch = false"
    if over_turn and wanted.rotatability is Rotatability.ANY:
        return 'rotatability = "any", with the transmission angle over the turn,'
    return ""


def refusal(scaled: ScaledProblem, poses: int = POSES) -> str | None:
    """Why there is no proof for this number of poses; empty where there can be one, None for other problems.

    >>> from grashof import load
    >>> refusal(ScaledProblem.of(load("luggage"))), refusal(ScaledProblem.of(load("straight-line")))
    ('', None)
    """
    if scaled.motion is None or len(scaled.targets) != poses or scaled.kind.dyad.bars < 2:
        return None
    return not_bounded(scaled) or unusable(scaled)


def not_bounded(scaled: ScaledProblem) -> str:
    """Why the requirements of a problem bound no transmission angle; empty where they do."""
    problem = scaled.problem
    if scaled.objective is None or set(scaled.objective.goals) != {"transmission"}:
        return "the objective has no forms; transmission alone has"
    if problem.driver is not None:
        return "a cylinder drives it, through dead positions of link 2, perhaps"
    if (without := _transmits_nothing(scaled)) and not scaled.wanted.transmission_min_deg:
        return f"{without} allows designs that transmit nothing"
    return ""


def unusable(scaled: ScaledProblem) -> str:
    """Why the poses themselves leave no curve of dyads, or three no plane; empty where they leave one."""
    motion = scaled.motion
    if motion is None:
        raise TypeError("only whole poses that are met exactly have a curve of dyads")
    for i, j in combinations(range(len(scaled.targets)), 2):
        apart = abs(motion.rotation[i] - motion.rotation[j]) + abs(scaled.targets[i] - scaled.targets[j])
        if apart < TOGETHER:
            return f"poses {i + 1} and {j + 1} are equal"
    first = Displacements(motion.rotation[:POSES], motion.shift[:POSES])
    if len(first.rotation) == THREE:
        return _degenerate(first)
    if Curve.of(first, complex(scaled.targets[0])).degenerate:
        return "the poses have a plane of dyads (translations, or a rotation about one point)"
    return ""


def _degenerate(motion: Displacements) -> str:
    """Why three poses leave each pivot no other one, or each the same."""
    if np.abs(motion.rotation - 1).max() < TOGETHER:
        return "the poses are translations"
    places = poles(motion)[1]
    if len(places) == len(motion.rotation) and np.abs(places - places[0]).max() < ONE_POINT:
        return "the poses are a rotation about one point"
    return ""


def enclosed(problem: Problem) -> str:
    """A note that the search of a problem encloses all linkages, or can; else empty.

    >>> from grashof import load
    >>> print(enclosed(load("luggage")))
    all four-bars through four poses are enclosed: seed and effort change nothing where that finds enough
    """
    if not problem.task.is_whole:
        return ""
    scaled = ScaledProblem.of(problem.for_kind(problem.mechanism[0]))
    if refusal(scaled, THREE) == "":
        return "--prove encloses all four-bars through three poses, and bounds what they transmit"
    if refusal(scaled) != "":
        return ""
    why = "all four-bars through four poses are enclosed"
    return f"{why}: seed and effort change nothing where that finds enough"
