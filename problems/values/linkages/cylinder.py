"""A cylinder as driver: its limits in a problem, and the cylinder of a design."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import partial
from typing import Any, ClassVar

from grashof.problems.values.arrays import Limits
from grashof.problems.values.box import Box
from grashof.problems.values.checks import finite_number, limits, one_of, pair, some_of
from grashof.problems.values.errors import ProblemError, shown
from grashof.problems.values.linkages.one_loop import FourBar
from grashof.problems.values.region import Region
from grashof.problems.values.value_bases import TableValue, check_fields, set_fields

CARRIERS: dict[str, int] = {link.name: link.number for link in FourBar.mechanism.links[1:]}
_WHERE = "driver.cylinder"


@dataclass(frozen=True, slots=True, kw_only=True)
class CylinderSpec(TableValue):
    """The limits of a cylinder that drives the linkage.

    Parameters
    ----------
    closed : tuple of float, length, optional
        (lo, hi) for the closed length, pivot to pivot, which is the least over the task motion.
    ratio_max : float
        Greatest length over the least: above 1, and below 2, since a rod is no longer than its cylinder.
    on : sequence of {"driver", "coupler", "output"}
        Links that it may act on.
    base : Box, optional
        Where its ground pivot may lie.

    Raises
    ------
    ProblemError
        Limits that no cylinder keeps, or a link that is unknown.

    Examples
    --------
    >>> CylinderSpec(closed=(300, 900), on=["driver"]).on
    ('driver',)
    >>> CylinderSpec(ratio_max=2.5)
    Traceback (most recent call last):
        ...
    grashof.problems.values.errors.ProblemError: driver.cylinder.ratio_max is 2.5; it must be above 1 and \
below 2: a rod is no longer than its cylinder
    """

    keeps_defaults: ClassVar[bool] = True

    closed: Limits | None = None
    ratio_max: float = 1.6
    on: tuple[str, ...] = tuple(CARRIERS)
    base: Box | None = None

    def __post_init__(self) -> None:
        if self.closed is not None:
            closed = limits(self.closed, f"{_WHERE}.closed", least=0.0)
            if closed[1] <= 0:
                raise ProblemError(f"{_WHERE}.closed is [0, 0]; its greatest length must be above zero")
            set_fields(self, closed=closed)
        ratio = finite_number(self.ratio_max, f"{_WHERE}.ratio_max")
        if not 1 < ratio < 2:
            raise ProblemError(
                f"{_WHERE}.ratio_max is {ratio:.15g}; it must be above 1 and below 2: "
                "a rod is no longer than its cylinder"
            )
        on = some_of(self.on, f"{_WHERE}.on", CARRIERS, f"a list of some of {', '.join(CARRIERS)}")
        set_fields(self, ratio_max=ratio, on=tuple(sorted(on, key=list(CARRIERS).index)))
        if not isinstance(self.base, Box | None) or isinstance(self.base, Region):
            given = "a region" if isinstance(self.base, Region) else shown(self.base)
            raise ProblemError(f"{_WHERE}.base is {given}; it must be a box")


@dataclass(frozen=True, slots=True)
class Cylinder:
    """A cylinder between a pivot of the ground and one of a moving link.

    Parameters
    ----------
    on : {"driver", "coupler", "output"}
        The link that it acts on: link 2, 3 or 4, of other kinds than the four-bar slider or block.
    base : tuple of float, length
        Its pivot of the ground (x, y).
    point : tuple of float, length
        Its pivot (u, v) of the link, in that link's frame: u from O2 along O2A, from A along AB, or from O4
        along O4B, and v to the left; of a slider u from B along the slide.

    Examples
    --------
    >>> Cylinder("coupler", base=(0, -2), point=(1.5, 0.5)).link
    3
    """

    on: str
    base: tuple[float, float]
    point: tuple[float, float]
    COLUMNS: ClassVar[tuple[str, ...]] = tuple(f"cylinder_{name}" for name in ("base_x", "base_y", "u", "v"))
    link: int = field(init=False, compare=False, repr=False)

    def __post_init__(self) -> None:
        check_fields(self, "cylinder.", on=partial(one_of, words=CARRIERS), base=pair, point=pair)
        set_fields(self, link=CARRIERS[self.on])

    @property
    def stated(self) -> dict[str, Any]:
        """The arguments that give this value: lossless JSON."""
        return {"on": self.on, "base": list(self.base), "point": list(self.point)}

    @property
    def columns(self) -> dict[str, float]:
        """Its pivots by their columns in tables."""
        return dict(zip(self.COLUMNS, (*self.base, *self.point), strict=True))
