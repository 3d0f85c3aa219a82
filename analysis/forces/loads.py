"""Loads on a linkage: gravity, forces, moments, springs, friction; and the wrench that acts on each link."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import NamedTuple, TypeAlias

import numpy as np
import numpy.typing as npt

from grashof.analysis.forces.joints import Joint, joint_motion, joints_of, slides_of
from grashof.analysis.mechanism.kinematics import Kinematics, PointMotion
from grashof.problems import Linkage, ProblemError
from grashof.problems.values.arrays import FloatArray
from grashof.problems.values.errors import wrong_value

Varying: TypeAlias = npt.ArrayLike | Callable[[Kinematics], npt.ArrayLike]
Pair: TypeAlias = tuple[float, float]


@dataclass(frozen=True, slots=True)
class AppliedForce:
    """A force on a point of a link.

    Parameters
    ----------
    link : int
        2, 3 or 4; of a six-bar 2 to 6.
    at : pair of float, length
        (u, v) in the link's frame; of a slider from B or E, u along the slide.
    force : array_like, shape (..., 2), N; or callable
        Constant, or a function of the `Kinematics`: ``lambda state: ... state.theta2 ...``.
    turning : bool
        The force is given in the link's frame and turns with it; else in global axes.
    """

    link: int
    at: Pair
    force: Varying
    turning: bool = False


@dataclass(frozen=True, slots=True)
class AppliedMoment:
    """A moment on a link, counter-clockwise.

    Parameters
    ----------
    link : int
        2, 3 or 4; of a six-bar 2 to 6. One on link 2 adds to the drive torque.
    moment : array_like, shape (...), N length; or callable
    at : pair of float, length, optional
        Where it enters the link, (u, v) in its frame, which matters to section forces alone. By default
        P on the link that carries it, the origin of the frame (such as the shaft, O2 or O4) on others.
    """

    link: int
    moment: Varying
    at: Pair | None = None


@dataclass(frozen=True, slots=True)
class Spring:
    """A straight spring, with a damper beside it, between points of two links.

    Parameters
    ----------
    first_link, second_link : int
        1 (the ground, whose frame is the global one) to 4; of a six-bar to 6.
    first_at, second_at : pair of float, length
    stiffness : float, N/length
    free_length : float, length
    damping : float, N s/length
    """

    first_link: int
    first_at: Pair
    second_link: int
    second_at: Pair
    stiffness: float
    free_length: float = 0.0
    damping: float = 0.0


@dataclass(frozen=True, slots=True)
class TorsionSpring:
    """A spring that turns the two links of a joint towards each other.

    Parameters
    ----------
    joint : Joint
    stiffness : float, N length/rad
    free_angle : float, rad
        Angle of the second link less that of the first where it is slack (the ground's is 0: O2
        joins links 1 and 2, A 2 and 3, B 3 and 4, O4 1 and 4; C a host and 5, E 5 and 6, D a host and 6). It
        is wound by less than half a turn.
    """

    joint: Joint
    stiffness: float
    free_angle: float = 0.0

    def wound(self, angle: FloatArray) -> FloatArray:
        """The angle by which it is wound, in [-pi, pi), rad, at an angle between the links."""
        wound: FloatArray = (angle - self.free_angle + np.pi) % (2 * np.pi) - np.pi
        return wound


@dataclass(frozen=True, slots=True)
class Friction:
    """Friction in the joints O2, A, B, O4, of six-bars C, E, D, too; a single number holds for each.

    Parameters
    ----------
    viscous : float or sequence of 4 or 7, N length s/rad
        Moment for each unit of relative angular velocity.
    coulomb : float or sequence of 4 or 7, N length
        Moment of constant size against the relative rotation.
    radius : float or sequence of 4 or 7, length
        Radius of the friction circle, coefficient times pin radius: moment for each unit of the
        joint's force.
    slide_viscous : float, N s/length
        Of a slide: force along it for each unit of velocity.
    slide_coulomb : float, N
        Force of constant size against the travel.
    slide_mu : float
        Force for each unit of that across the slide.
    slide_length : float, length
        Of the guide on which a slide's moment presses at both ends: the force across it counts as
        max(|N|, 2 |M| / slide_length), the sum of both ends. Without it the moment M does not count.
    """

    viscous: npt.ArrayLike = 0.0
    coulomb: npt.ArrayLike = 0.0
    radius: npt.ArrayLike = 0.0
    slide_viscous: float = 0.0
    slide_coulomb: float = 0.0
    slide_mu: float = 0.0
    slide_length: float = 0.0

    def each(self, name: str, count: int | None = None) -> FloatArray:
        """One of the three for every joint, shape (count,); by default as many as are given, or four."""
        values = np.asarray(getattr(self, name), dtype=np.float64)
        counts = tuple(_COUNTS) if count is None else (count,)
        fits = values.shape in ((), *((each,) for each in counts))
        if not fits or not np.isfinite(values).all() or np.any(values < 0):
            words = " or ".join(("one", *(_COUNTS[each] for each in counts)))
            raise ProblemError(f"{name} friction is {values}; it must be {words} numbers from zero")
        return np.broadcast_to(values, values.shape or counts[0])

    def of(self, linkage: Linkage, name: str) -> FloatArray:
        """The same for the joints of a linkage: where one is a slide, that of slides is in its place.

        Raises
        ------
        ProblemError
            A slide that the linkage has not, or friction of a pin where it has one.
        """
        kind, slides = linkage.mechanism, slides_of(linkage)
        each = self.each(name, len(kind.every_joint))
        given = getattr(self, _OF_SLIDES[name])
        if not np.isfinite(given) or given < 0:
            raise wrong_value(_OF_SLIDES[name], given, "a number from zero")
        if not slides:
            if given:
                raise ProblemError(f"{_OF_SLIDES[name]} friction is {given}; a {kind.word} has no slide")
            return each
        for slide in slides:
            if np.ndim(getattr(self, name)) and each[slide]:
                raise ProblemError(
                    f"{name} friction in {slide.name} is {each[slide]:g}; that joint of a {kind.word} is a "
                    f"slide, so it must be 0, and {_OF_SLIDES[name]} states that of slides"
                )
        found = each.copy()
        found[list(slides)] = given
        return found


# How many joints linkages have.
_COUNTS = {4: "four", 7: "seven"}
# By the name of the friction of pins.
_OF_SLIDES = {"viscous": "slide_viscous", "coulomb": "slide_coulomb", "radius": "slide_mu"}


@dataclass(frozen=True, slots=True)
class Loads:
    """All that acts on the links besides the drive.

    Parameters
    ----------
    gravity : array_like, shape (2,), length/s^2
        Its direction and size, (0, -9.80665) in metres.
    forces : tuple of AppliedForce
    moments : tuple of AppliedMoment
    springs : tuple of Spring
    torsion_springs : tuple of TorsionSpring
    friction : Friction
    """

    gravity: npt.ArrayLike = (0.0, 0.0)
    forces: tuple[AppliedForce, ...] = ()
    moments: tuple[AppliedMoment, ...] = ()
    springs: tuple[Spring, ...] = ()
    torsion_springs: tuple[TorsionSpring, ...] = ()
    friction: Friction = field(default_factory=Friction)

    @property
    def any(self) -> bool:
        """Whether anything but weight and friction acts."""
        return bool(self.forces or self.moments or self.springs or self.torsion_springs)

    def gravity_vector(self) -> FloatArray:
        """Gravity, shape (2,)."""
        gravity = np.asarray(self.gravity, dtype=np.float64)
        if gravity.shape != (2,) or not np.isfinite(gravity).all():
            raise wrong_value("gravity", self.gravity, "a pair of finite numbers")
        return gravity


@dataclass(slots=True, eq=False)
class Wrench:
    """Force (..., 2), and moment about the origin of its frame (of the ground O2), of all loads on a link."""

    force: FloatArray
    moment: FloatArray


class PlacedLoad(NamedTuple):
    """A force (..., 2) in global axes and a moment on a link, at a place (u, v) of its frame."""

    link: int
    at: npt.ArrayLike
    force: FloatArray
    moment: FloatArray


def cross(first: FloatArray, second: FloatArray) -> FloatArray:
    """First x second in the plane, shape (...)."""
    turning: FloatArray = first[..., 0] * second[..., 1] - first[..., 1] * second[..., 0]
    return turning


def turned(at: FloatArray, theta: FloatArray) -> FloatArray:
    """A vector of a link's frame in global axes, shape (..., 2)."""
    cosine, sine = np.cos(theta), np.sin(theta)
    x, y = at[..., 0], at[..., 1]
    return np.stack([cosine * x - sine * y, sine * x + cosine * y], axis=-1)


def placed_loads(state: Kinematics, loads: Loads) -> Iterator[PlacedLoad]:
    """All forces, moments and springs that act on the links, the ground with them, at their places."""
    nothing, still, kind = np.zeros(()), np.zeros(2), state.linkage.mechanism
    for force in loads.forces:
        theta, value = state.frame_angle(force.link), _value(force.force, state)
        if force.turning:
            value = turned(value, theta)
        yield PlacedLoad(force.link, force.at, value, nothing)
    for moment in loads.moments:
        state.angular(moment.link)  # raises for a link that the linkage has not
        entry = state.linkage.coupler_point if moment.link == kind.carries else (0.0, 0.0)
        at = entry if moment.at is None else moment.at
        yield PlacedLoad(moment.link, at, still, _value(moment.moment, state))
    for spring in loads.springs:
        pull = spring_pull(spring, *spring_ends(state, spring))
        yield PlacedLoad(spring.first_link, spring.first_at, pull, nothing)
        yield PlacedLoad(spring.second_link, spring.second_at, -pull, nothing)


def wrenches(state: Kinematics, loads: Loads) -> dict[int, Wrench]:
    """Wrench on every link, 1 to 4, of a six-bar to 6, of forces, moments and springs, without weight."""
    found = {link.number: Wrench(np.zeros(2), np.zeros(())) for link in state.linkage.mechanism.links}
    for load in placed_loads(state, loads):
        wrench = found[load.link]
        if load.force.any():
            place = state.point(load.link, load.at).position
            wrench.force = wrench.force + load.force
            wrench.moment = wrench.moment + cross(place - state.origin(load.link).position, load.force)
        wrench.moment = wrench.moment + load.moment
    return found


def spring_ends(state: Kinematics, spring: Spring) -> tuple[PointMotion, PointMotion]:
    """How the two ends of a spring move."""
    first, second = (spring.first_link, spring.first_at), (spring.second_link, spring.second_at)
    return state.point(*first), state.point(*second)


def spring_pull(spring: Spring, first: PointMotion, second: PointMotion) -> FloatArray:
    """Force on the first end, towards the second when the spring is stretched; shape (..., 2)."""
    way, rate = second.position - first.position, second.velocity - first.velocity
    length = np.hypot(way[..., 0], way[..., 1])[..., None]
    if spring.free_length == 0 and spring.damping == 0:
        return spring.stiffness * way
    with np.errstate(invalid="ignore", divide="ignore"):
        along = np.where(length > 0, way / length, 0.0)
    tension = spring.stiffness * (length - spring.free_length)
    pull: FloatArray = along * (tension + spring.damping * (along * rate).sum(axis=-1, keepdims=True))
    return pull


def known_joint_moments(state: Kinematics, loads: Loads, senses: FloatArray | None = None) -> FloatArray:
    """Moments (J, ...) of joints on their second links, of slides forces: the part that needs no joint force.

    `senses` (J,) are those in which friction takes the joints to turn, or to slide; by default as they do.
    """
    moments = torsion_moments(state, loads)
    viscous, coulomb = (loads.friction.of(state.linkage, name) for name in ("viscous", "coulomb"))
    for joint in joints_of(state.linkage):
        if viscous[joint] or coulomb[joint]:
            _, rate = joint_motion(state, joint)
            sense = np.sign(rate) if senses is None else senses[joint]
            moments[joint] -= viscous[joint] * rate + coulomb[joint] * sense
    return moments


def torsion_moments(state: Kinematics, loads: Loads) -> FloatArray:
    """The same of torsion springs alone; ProblemError where one is at a slide, whose links do not turn."""
    linkage = state.linkage
    moments = np.zeros((len(joints_of(linkage)), *state.shape))
    for spring in loads.torsion_springs:
        if spring.joint >= len(moments):
            names = ", ".join(each.name for each in joints_of(linkage))
            raise wrong_value("joint of a torsion spring", spring.joint.name, f"one of {names}")
        if spring.joint in slides_of(linkage):
            links = linkage.mechanism.every_joint[spring.joint].links
            raise ProblemError(
                f"a torsion spring is at the slide between links {links}, which do not turn "
                "against each other; it must be at a pin"
            )
        angle, _ = joint_motion(state, spring.joint)
        moments[spring.joint] -= spring.stiffness * spring.wound(angle)
    return moments


def _value(given: Varying, state: Kinematics) -> FloatArray:
    return np.asarray(given(state) if callable(given) else given, dtype=np.float64)
