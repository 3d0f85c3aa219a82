"""The effort at a point of a linkage over its travel, by virtual work."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt

from grashof.analysis.cylinder.travel import Travel
from grashof.analysis.effort.parts import PartState, part_state, place_on
from grashof.analysis.forces.from_spec import JOINT_OF, stated_loads, stated_masses
from grashof.analysis.forces.joints import joint_motion, joints_of
from grashof.analysis.forces.loads import Loads
from grashof.analysis.forces.mass import Masses
from grashof.analysis.forces.statics import virtual_power
from grashof.analysis.mechanism.kinematics import Kinematics, virtual_motion
from grashof.problems import DynamicsSpec, Linkage, ProblemError
from grashof.problems.values.arrays import FloatArray, turned_from
from grashof.problems.values.dynamics.effort import SQUARE, EffortSpec

_AT_REST = 1e-12  # share of the greatest speed of the point: no motion
_PIECES, _NARROWINGS = 64, 10  # in which a place is sought, each time in the piece that has it


@dataclass(frozen=True, slots=True, eq=False)
class EffortState:
    """The effort in N places of a travel.

    Parameters
    ----------
    angle_deg : ndarray, shape (N,), deg
        Rotation, from the start of the travel, of the link of the effort or of the driver.
    without : ndarray, shape (N,), N
        The effort without struts and springs, and without friction; infinite where the point is at rest, or
        moves perpendicular to a given direction.
    effort : ndarray, shape (T, N), N
        The effort with struts and springs, at each temperature, without friction.
    per : ndarray, shape (N,), N
        The effort for a unit of power, force in N times a rate, that struts and springs take.
    friction : ndarray, shape (N,), N
        Moving on takes the effort plus friction, moving back the effort minus friction.
    sense : ndarray, shape (N,)
        +1 where a positive effort moves the linkage on, -1 where it moves it back.
    parts : tuple of PartState
    """

    angle_deg: FloatArray
    without: FloatArray
    effort: FloatArray
    per: FloatArray
    friction: FloatArray
    sense: FloatArray
    parts: tuple[PartState, ...]

    @property
    def opening(self) -> FloatArray:
        """The effort in the sense of the travel, shape (T, N), N: positive where it moves the linkage on."""
        return np.asarray(self.sense * self.effort)


@dataclass(frozen=True)
class EffortCase:
    """A linkage with its masses, loads and effort, over a travel; `metre` is its length unit in metres.

    Raises
    ------
    ProblemError
        A load varies over time.
    """

    linkage: Linkage
    dynamics: DynamicsSpec
    metre: float
    travel: Travel

    def __post_init__(self) -> None:
        for index, load in enumerate(self.dynamics.loads):
            if load.values is not None and load.over == "time":
                raise ProblemError(
                    f"loads[{index}].over is 'time'; it does not go with an effort, which has none"
                )

    @property
    def spec(self) -> EffortSpec:
        """The wanted effort, and the parts."""
        if self.dynamics.effort is None:
            raise ProblemError("effort is missing")
        return self.dynamics.effort

    @cached_property
    def _weights(self) -> tuple[Masses, Loads]:
        masses = stated_masses(self.linkage, self.dynamics, self.metre)
        return masses, stated_loads(self.dynamics, self.metre)

    @cached_property
    def _dense(self) -> tuple[FloatArray, FloatArray]:
        """Places from end to end, ascending, and rotations there from the start, rad, unwrapped."""
        places = self.travel.places
        turned = np.unwrap(self._direction(places))
        first = turned[0] if self.travel.start <= self.travel.end else turned[-1]
        return places, turned - first

    @property
    def total_deg(self) -> float:
        """Rotation over the entire travel, deg; positive."""
        turned = self._dense[1]
        return float(np.degrees(abs(turned[-1] - turned[0])))

    @property
    def rises(self) -> bool:
        """Whether this rotation has one sense all the way, so that an angle is a place."""
        step = np.diff(self._dense[1])
        return bool((step > 0).all() or (step < 0).all())

    def angle_deg(self, places: npt.ArrayLike) -> FloatArray:
        """Rotation from the start of the travel, shape (N,), deg; it is positive at the end."""
        dense, turned = self._dense
        place = np.asarray(places, dtype=np.float64)
        near = np.interp(place, dense, turned)
        first = float(self._direction(np.array([self.travel.start]))[0])
        rest = self._direction(place) - first - near
        exact = near + turned_from(rest, 0.0)
        sign = np.sign(turned[-1] + turned[0])  # one of them is 0, at the start
        return np.asarray(np.degrees(sign * exact))

    def place_at(self, angle_deg: float) -> float:
        """The place of a rotation, to rounding; the nearest end of the travel beyond it."""
        low, high = self.travel.start, self.travel.end
        if angle_deg <= 0:
            return low
        if angle_deg >= self.total_deg:
            return high
        for _ in range(_NARROWINGS):
            within = np.linspace(low, high, _PIECES + 1)
            piece = int(np.count_nonzero(self.angle_deg(within[1:-1]) < angle_deg))
            low, high = float(within[piece]), float(within[piece + 1])
        return (low + high) / 2

    def _direction(self, places: FloatArray) -> FloatArray:
        """Direction of the link of the effort, or of the driver, rad."""
        at = self.travel.at(places)
        if self.spec.over == "driver":
            return np.asarray(at.theta2)
        link, _ = place_on(self.linkage, self.spec.on)
        return np.asarray(at.angles[link])

    def motion(self, places: npt.ArrayLike) -> tuple[Kinematics, Kinematics, FloatArray]:
        """Virtual velocities, finite in dead positions; the linkage at rest; and the sense of the travel."""
        at = self.travel.at(np.asarray(places, dtype=np.float64))
        side = np.copysign(1.0, at.margins[0])
        virtual, rest = virtual_motion(self.linkage, at.theta2, side)  # its driver never turns clockwise
        way = 1.0 if self.travel.end >= self.travel.start else -1.0
        return virtual, rest, way * (np.ones(rest.shape) if self.travel.turns else side)

    def joint_turn(self, links: tuple[int, int], places: npt.ArrayLike) -> tuple[FloatArray, FloatArray]:
        """Angle between the links of a joint, deg, and its rate in the motion, rad; shape (N,) each."""
        virtual, rest, sense = self.motion(places)
        joint = JOINT_OF[links]
        return np.degrees(joint_motion(rest, joint)[0]), sense * joint_motion(virtual, joint)[1]

    def at(self, places: npt.ArrayLike) -> EffortState:
        """The effort in some places (N,) of the travel.

        Notes
        -----
        In any small motion the power of the effort, of weights and loads, and of the parts is zero (Norton,
        *Design of Machinery*, sec. 11.10); friction takes power either way.
        """
        places = np.asarray(places, dtype=np.float64)
        virtual, rest, sense = self.motion(places)
        masses, loads = self._weights
        given = self.metre * sense * virtual_power(virtual, rest, masses, loads)
        dry = loads.friction.of(self.linkage, "coulomb")
        joints = (
            self.metre * dry[joint] * np.abs(joint_motion(virtual, joint)[1])
            for joint in joints_of(self.linkage)
        )
        taken = np.sum([np.zeros(rest.shape), *joints], axis=0)
        parts = tuple(
            part_state(part, self.linkage, self.metre, virtual, rest, sense) for part in self.spec.parts
        )
        gained = np.zeros((len(self.spec.temperatures_c), *rest.shape))
        for part, state in zip(self.spec.parts, parts, strict=True):
            warm = np.array([part.warmth(each) for each in self.spec.temperatures_c])
            gained = gained + warm[:, None] * state.force * state.rate
            taken = taken + state.friction * np.abs(state.rate)
        link, point = place_on(self.linkage, self.spec.on)
        velocity = sense[..., None] * virtual.point(link, point).velocity
        speed = np.hypot(velocity[..., 0], velocity[..., 1])
        along = speed if self.spec.direction == SQUARE else velocity @ _unit(self.spec)
        moves = np.abs(along) > _AT_REST * speed.max(initial=0.0)
        with np.errstate(divide="ignore", invalid="ignore"):
            per = np.where(moves, 1 / along, np.inf)
            return EffortState(
                self.angle_deg(places),
                -given * per,
                -(given + gained) * per,
                per,
                taken * np.abs(per),
                np.where(along < 0, -1.0, 1.0),
                parts,
            )


def _unit(spec: EffortSpec) -> FloatArray:
    direction = np.asarray(spec.direction, dtype=np.float64)
    return np.asarray(direction / np.hypot(*direction))
