"""The wanted effort that moves a linkage by hand, over its travel."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from typing import NamedTuple

import numpy as np

from grashof.problems.values import checks
from grashof.problems.values.arrays import Limits
from grashof.problems.values.dynamics.struts import STATED_C, ZERO_C, EffortPlace, PartSpec
from grashof.problems.values.errors import ProblemError, listing, wrong_value
from grashof.problems.values.value_bases import TableValue, check_fields, set_fields

SQUARE = "square"
OVER = ("link", "driver")
MOST_PARTS = 2
_MOST_TEMPERATURES = 9
_FAR = 3600.0  # deg, greatest angle of the travel


class Demand(NamedTuple):
    """Limits of the effort over a part of the travel.

    Angles are in deg; `most` and `least`, N, hold at `start` and `end`, and change linearly between them.
    `friction` is the multiple of the friction that is added to both: -1 within it, +1 beyond it. With
    `opening` the effort is positive in the sense of the travel, otherwise along its direction.
    """

    words: str
    start: float
    end: float
    least: tuple[float, float]
    most: tuple[float, float]
    friction: int = 0
    opening: bool = False


@dataclass(frozen=True, slots=True)
class EffortSpec(TableValue):
    """The wanted effort by which a linkage is moved, or held, by hand.

    Parameters
    ----------
    on : EffortPlace
        The point at which the hand acts.
    direction : "square" or pair of float
        Direction of the effort: along the path of the point, positive in the sense of the travel; or a fixed
        direction (x, y).
    wanted : sequence of rows (deg, N), optional
        The effort, which changes linearly from row to row.
    band : pair of float, N, optional
        Instead, limits of the effort over the entire travel.
    stays_deg : pair of float, deg, optional
        Angles between which the linkage stays where it is left: friction holds it.
    closes_below_deg : float, deg, optional
        Angle below which the linkage returns to the start of the travel by itself, against friction.
    temperatures_c : tuple of float, deg C
        Temperatures at which all of this holds.
    over : {"link", "driver"}
        The link whose rotation from the start of the travel the angles are: that on which the hand acts, or
        link 2.
    travel_deg : pair of float, deg, optional
        Driver angles at which the travel begins and ends, in linkage files only: the travel of a problem goes
        from its first target to its last. By default the range of the driver.
    parts : tuple of PartSpec
        Struts and springs, up to two; without any the effort alone is reported.

    Raises
    ------
    ProblemError
        No wanted effort, two of them, or numbers that contradict each other.

    Examples
    --------
    >>> from grashof.problems import Box
    >>> hand = EffortPlace("body", Box((300, 300), (0, 0)))
    >>> EffortSpec(hand, band=(-40, 60)).demands[0].most
    (60.0, 60.0)
    """

    on: EffortPlace
    direction: str | tuple[float, float] = SQUARE
    wanted: tuple[tuple[float, float], ...] | None = None
    band: Limits | None = None
    stays_deg: Limits | None = None
    closes_below_deg: float | None = None
    temperatures_c: tuple[float, ...] = (STATED_C,)
    over: str = "link"
    travel_deg: tuple[float, float] | None = None
    parts: tuple[PartSpec, ...] = ()

    def __post_init__(self) -> None:
        where = "effort."
        if not isinstance(self.on, EffortPlace) or not self.on.is_point or self.on.link == 1:
            raise ProblemError("effort.on is no point of a moving link, such as { link = 3, at = [u, v] }")
        check_fields(self, where, direction=_direction, over=partial(checks.one_of, words=OVER))
        if self.wanted is not None and self.band is not None:
            raise ProblemError("effort.band is given besides wanted; give one of them")
        if self.wanted is not None:
            rows = checks.finite_rows(self.wanted, 2, "effort.wanted", "[deg, N]", checks.GREATEST)
            if len(rows) < 2 or not (np.diff(rows[:, 0]) > 0).all() or rows[0, 0] < 0:
                given = [list(row) for row in self.wanted]
                raise wrong_value(
                    "effort.wanted", given, "two rows [deg, N] or more, their angles rising from 0"
                )
            set_fields(self, wanted=tuple((a, force) for a, force in rows.tolist()))
        angles = partial(checks.limits, least=0.0, most=_FAR)
        check_fields(
            self, where, band=checks.limits, stays_deg=angles, closes_below_deg=checks.positive_bounded
        )
        check_fields(self, where, temperatures_c=_temperatures, travel_deg=checks.pair)
        if self.stays_deg is not None and (self.closes_below_deg or 0.0) > self.stays_deg[0]:
            raise ProblemError(
                f"effort.closes_below_deg is {self.closes_below_deg:.15g}; it must be at most "
                f"{self.stays_deg[0]:.15g}, from where it stays"
            )
        if self.travel_deg is not None and self.travel_deg[0] == self.travel_deg[1]:
            raise wrong_value("effort.travel_deg", list(self.travel_deg), "two different angles")
        if not self.demands:
            raise ProblemError(f"effort wants nothing; it must have {listing(_WANTED)}")
        parts = tuple(self.parts) if isinstance(self.parts, Sequence) else ()
        if len(parts) > MOST_PARTS or not all(isinstance(part, PartSpec) for part in parts):
            raise wrong_value("effort.parts", self.parts, f"a list of at most {MOST_PARTS} parts")
        set_fields(self, parts=parts)

    @property
    def demands(self) -> tuple[Demand, ...]:
        """The limits over parts of the travel; an infinite end is that of the travel."""
        found = []
        rows = self.wanted or ()
        for (start, first), (end, last) in itertools.pairwise(rows):
            found.append(Demand("wanted", start, end, (first, last), (first, last)))
        if self.band is not None:
            least, most = self.band
            found.append(Demand("band", 0.0, np.inf, (least, least), (most, most)))
        if self.stays_deg is not None:
            found.append(Demand("stays", *self.stays_deg, (0.0, 0.0), (0.0, 0.0), -1, opening=True))
        if self.closes_below_deg is not None:
            no_limit = (np.inf, np.inf)
            found.append(Demand("closes", 0.0, self.closes_below_deg, (0.0, 0.0), no_limit, 1, opening=True))
        return tuple(found)

    @property
    def is_placed(self) -> bool:
        """Whether every part has one size and one place."""
        return all(part.is_placed for part in self.parts)

    @property
    def links(self) -> dict[str, int | str]:
        """The links of the hand and of the parts, by key."""
        found = {"effort.on.link": self.on.link}
        for index, part in enumerate(self.parts):
            for end, place in enumerate(part.places):
                found[f"effort.parts[{index}].between[{end}].link"] = place.link
        return found


_WANTED = ("wanted", "band", "stays_deg", "closes_below_deg")


def _direction(direction: object, where: str) -> object:
    if direction == SQUARE:
        return direction
    if isinstance(direction, str) or not isinstance(direction, Sequence):
        raise wrong_value(where, direction, f'"{SQUARE}" or [x, y]')
    given = checks.pair(direction, where)
    if not any(given):
        raise wrong_value(where, list(given), "a direction [x, y] other than [0, 0]")
    return given


def _temperatures(given: object, where: str) -> tuple[float, ...]:
    values = tuple(given) if isinstance(given, Sequence) and not isinstance(given, str) else ()
    if not 1 <= len(values) <= _MOST_TEMPERATURES:
        raise wrong_value(where, given, f"a list of 1 to {_MOST_TEMPERATURES} numbers")
    found = [checks.number_within(each, ZERO_C, 1e4, f"{where}[{k}]") for k, each in enumerate(values)]
    return tuple(found)
