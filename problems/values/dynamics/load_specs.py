"""Loads, springs, dampers, counterweights and friction of a linkage.

`misplaced` checks that the kind of linkage has these links, joints and angles.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from numbers import Integral

import numpy as np

from grashof.problems.values.checks import Rows, bounded, from_zero, one_of, pair, rising_rows
from grashof.problems.values.errors import ProblemError, wrong_value
from grashof.problems.values.linkages.mechanism import MECHANISMS
from grashof.problems.values.value_bases import TableValue, check_fields, set_fields

Pair = tuple[float, float]
TURNING = ("theta2", "theta4", "theta6")  # over angles, in deg: a full turn
OVER = (*TURNING, "travel", "time")
# The joints by the links that they join: of linkages of one loop, and of any; how many a linkage may have.
JOINTS = tuple(joint.links for joint in MECHANISMS[0].every_joint)
ANY_JOINTS = tuple(joint.links for row in MECHANISMS for joint in row.every_joint)
_COUNTS = {len(row.every_joint) for row in MECHANISMS}
# Of friction in a slide, one number each.
SLIDE_KEYS = ("slide_mu", "slide_length", "slide_viscous", "slide_force")


@dataclass(frozen=True, slots=True)
class Place(TableValue):
    """A point of a link.

    Parameters
    ----------
    link : int
        1 (the ground, whose frame is the global one) to 4; of a six-bar to 6.
    at : pair of float, length
        In the link's frame: from O2, A, O4, C or D, u towards A, B, B, E or E, v to its left; of a slider
        from B or E, u along the slide.
    """

    link: int
    at: Pair = (0.0, 0.0)

    def __post_init__(self) -> None:
        check_fields(self, link=_link, at=pair)


@dataclass(frozen=True, slots=True)
class LoadSpec(TableValue):
    """A force on a link at a point, or a moment: constant, or over driver angle, output or time.

    `ProblemError` unless it is one of force, moment and values, and these rise and close.

    Parameters
    ----------
    link : int
        The link that it acts on: 2, 3 or 4; of a six-bar 2 to 6.
    at : pair of float, length
        Of a force: its point in the link's frame.
    force : pair of float, N, optional
        Its components, in the axes of `frame`.
    moment : float, N m, optional
        Counter-clockwise.
    values : sequence of rows, optional
        Instead of both: (place, fx, fy) or (place, moment), places rising, in deg, length or s. Between
        rows the load follows a curve through them that rises and falls as they do.
    over : {"theta2", "theta4", "theta6", "travel", "time"}
        The places: `theta2`, `theta4`, of a six-bar `theta6` (deg, a full turn), `travel` (length: of a
        slide, see `FrictionSpec`) or `time` (s from the start).
    frame : {"global", "link"}
        Axes of the force: the global ones, or those of the link, with which it turns.
    """

    link: int
    at: Pair = (0.0, 0.0)
    force: Pair | None = None
    moment: float | None = None
    values: tuple[tuple[float, ...], ...] | None = None
    over: str = "theta2"
    frame: str = "global"

    def __post_init__(self) -> None:
        check_fields(self, link=_link, at=pair, frame=partial(one_of, words=("global", "link")))
        given = [name for name in ("force", "moment", "values") if getattr(self, name) is not None]
        if len(given) != 1:
            what = " and ".join(given) or "nothing"
            raise ProblemError(f"force is given by {what}; it must be by one of force, moment, values, table")
        check_fields(self, force=pair, moment=bounded, values=lambda rows, _: _rows(rows, self.over))
        for name, plain in (("over", "theta2"), ("at", (0.0, 0.0)), ("frame", "global")):
            needs = self.values is not None if name == "over" else not self.is_moment
            if getattr(self, name) != plain and not needs:
                without = "a constant load" if name == "over" else "a moment"
                raise ProblemError(f"{name} does not go with {without}")

    @property
    def greatest(self) -> float:
        """Its greatest size, N or N m."""
        if self.values is None:
            return float(np.hypot(*(self.force or (self.moment or 0.0, 0.0))))
        return float(np.linalg.norm(np.array(self.values)[:, 1:], axis=1).max())

    @property
    def is_moment(self) -> bool:
        """Whether it is a moment."""
        return self.moment is not None or (self.values is not None and len(self.values[0]) == 2)


@dataclass(frozen=True, slots=True)
class SpringSpec(TableValue):
    """A straight spring between points of two links.

    Parameters
    ----------
    between : pair of Place
        Its two ends.
    stiffness : float, N/m
        Force for each metre beyond its free length.
    free_length : float, length
        Length at which it is slack.
    """

    between: tuple[Place, Place]
    stiffness: float
    free_length: float = 0.0

    def __post_init__(self) -> None:
        check_fields(self, between=_two_places, stiffness=from_zero, free_length=from_zero)


@dataclass(frozen=True, slots=True)
class DamperSpec(TableValue):
    """A damper between points of two links.

    Parameters
    ----------
    between : pair of Place
        Its two ends.
    damping : float, N s/m
        Force for each m/s at which its ends part.
    """

    between: tuple[Place, Place]
    damping: float

    def __post_init__(self) -> None:
        check_fields(self, between=_two_places, damping=from_zero)


@dataclass(frozen=True, slots=True)
class TorsionSpringSpec(TableValue):
    """A spring about a joint, that turns its two links towards each other.

    Parameters
    ----------
    between : pair of int
        Links of a joint: 1 and 2 (O2), 2 and 3 (A), 3 and 4 (B), 1 and 4 (O4); of a six-bar further those in
        C, D and E.
    stiffness : float, N m/rad
        Moment for each radian from the free angle.
    free_angle_deg : float, deg
        Angle of the second link less that of the first where it is slack, the ground's being 0.
    """

    between: tuple[int, int]
    stiffness: float
    free_angle_deg: float = 0.0

    def __post_init__(self) -> None:
        links = tuple(self.between) if isinstance(self.between, Sequence) else (self.between,)
        if len(links) == 2 and links[0] == links[1]:
            raise ProblemError(f"between joins link {links[0]} to itself; it must be two links of a joint")
        free = bounded(self.free_angle_deg, "free_angle_deg")
        turned = links[::-1] in ANY_JOINTS
        set_fields(
            self,
            between=links[::-1] if turned else links,
            stiffness=from_zero(self.stiffness, "stiffness"),
            free_angle_deg=-free if turned else free,
        )


@dataclass(frozen=True, slots=True)
class CounterweightSpec(TableValue):
    """A point mass on a link, besides its own.

    Parameters
    ----------
    link : int
        The link that carries it: 2, 3 or 4; of a six-bar 2 to 6.
    mass : float, kg
        Of the weight.
    at : pair of float, length
        Its place in the link's frame.
    """

    link: int
    mass: float
    at: Pair

    def __post_init__(self) -> None:
        check_fields(self, link=_link, mass=from_zero, at=pair)


@dataclass(frozen=True, slots=True)
class FrictionSpec(TableValue):
    """Friction in the joints O2, A, B, O4, a number for each, or one for all; and in a slide.

    Of a six-bar the joints are O2, A, B, O4, C, E, D.

    Parameters
    ----------
    coulomb : float or one a joint
        Coefficient of friction of the pins; it needs `pin_radius`.
    pin_radius : float or one a joint, length
        Of the pins, for `coulomb`.
    viscous : float or one a joint, N m s/rad
        Moment for each rad/s.
    moment : float or one a joint, N m
        Of constant size, against the rotation.
    slide_mu : float
        Coefficient of friction of the slide, for the force across it: of a slider on the ground, of the
        rod of an inverted slider-crank in its block.
    slide_length : float, length
        Of the guide, whose ends bear the moment; by default the friction of `slide_mu` ignores the moment.
    slide_viscous : float, N s/m
        Force for each m/s along the slide.
    slide_force : float, N
        Of constant size, against the travel.
    """

    coulomb: tuple[float, ...] = (0.0,)
    pin_radius: tuple[float, ...] = (0.0,)
    viscous: tuple[float, ...] = (0.0,)
    moment: tuple[float, ...] = (0.0,)
    slide_mu: float = 0.0
    slide_length: float = 0.0
    slide_viscous: float = 0.0
    slide_force: float = 0.0

    def __post_init__(self) -> None:
        pins = ("coulomb", "pin_radius", "viscous", "moment")
        check_fields(self, **dict.fromkeys(pins, _one_or_each), **dict.fromkeys(SLIDE_KEYS, from_zero))
        if self.slide_length and not self.slide_mu:
            raise ProblemError("slide_mu is missing; slide_length is of no use without it")
        if any(self.coulomb) != any(self.pin_radius):
            absent = "pin_radius" if any(self.coulomb) else "coulomb"
            raise ProblemError(f"{absent} is missing; coulomb and pin_radius are needed together")

    @property
    def radius(self) -> tuple[float, ...]:
        """Of the friction circles: moment for each unit of a joint's force, length."""
        return tuple(np.multiply(self.coulomb, self.pin_radius).tolist())


def _link(link: object, where: str) -> object:
    if isinstance(link, bool) or not isinstance(link, Integral):
        raise wrong_value(where, link, "the number of a link")
    return link


def _one_or_each(given: object, name: str) -> tuple[float, ...]:
    if isinstance(given, Sequence) and not isinstance(given, str):
        if len(given) not in (1, *_COUNTS):
            return tuple(given)  # of no linkage: `misplaced` reports how many are needed
        each = tuple(from_zero(value, name) for value in given)
        return each[:1] if len(each) <= len(JOINTS) and len(set(each)) == 1 else each
    return (from_zero(given, name),)  # type: ignore[arg-type]


def _two_places(given: object, where: str) -> tuple[Place, Place]:
    places = tuple(given) if isinstance(given, Sequence) else ()
    if len(places) != 2 or not all(isinstance(place, Place) for place in places):
        raise wrong_value(where, given, "two places, each with its link")
    if places[0].link == places[1].link:
        raise ProblemError(
            f"between joins link {places[0].link} to itself; it must be places of two different links"
        )
    return places


def _rows(values: object, over: str) -> Rows:
    rows = [tuple(row) if isinstance(row, Sequence) else (row,) for row in values or ()]  # type: ignore[attr-defined]
    columns = len(rows[0]) if rows else 3
    if columns not in (2, 3):
        raise wrong_value("values[0]", list(rows[0]), f"[{over}, fx, fy] or [{over}, moment]")
    means = f"[{over}, fx, fy]" if columns == 3 else f"[{over}, moment]"
    return rising_rows(rows, columns, means, [over], turn=over in TURNING)
