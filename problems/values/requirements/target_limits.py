"""Limits that hold at single targets."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, fields
from typing import Any

from grashof.problems.values import checks
from grashof.problems.values.arrays import Limits
from grashof.problems.values.box import ANYWHERE, Box
from grashof.problems.values.errors import ProblemError, wrong_value
from grashof.problems.values.linkages.mechanism import ONE_LOOP
from grashof.problems.values.linkages.mechanisms import not_had
from grashof.problems.values.requirements.distances import Distances
from grashof.problems.values.requirements.limit_kinds import (
    HEADINGS,
    NARROW_HEADING,
    NARROW_RATE,
    RATES,
)
from grashof.problems.values.requirements.named_limits import NamedLimits
from grashof.problems.values.tasks.task import Task
from grashof.problems.values.value_bases import check_fields

NARROWEST, FARTHEST = 0.1, 45.0  # deg, of the range of `past_deg`


TOGGLE = ("driver", "coupler")  # links of `past_deg`


@dataclass(frozen=True, slots=True, kw_only=True)
class TargetLimits:
    """Limits at some of the targets, besides those of `Requirements`.

    Parameters
    ----------
    targets : sequence of int
        Numbers of the poses, points or pairs of a function, counted from 1. Of a law over its range they are
        the 41 Chebyshev-Lobatto points. Of a stroke 1 is the limit position in which the slow stroke begins,
        2 the one in which it ends; the driver turns counter-clockwise unless `driver_sense` is "cw", and of
        strokes that take equally long the one from the stretched position counts as the slow one. There
        `past_deg`, `instant_centre`, `coupler_rate` and `mechanical_advantage_min` are refused.
    a, b : Box or Region, optional
        Where this moving pivot may be there.
    instant_centre : Box, optional
        Where the centre of rotation of the coupler may lie there, the intersection of O2A and O4B.
    distances : mapping of str to float or tuple of float, optional
        Distances there, as those of `Requirements`.
    links : pair of str
        The links of `past_deg`: "driver" and "coupler". With coupler and output in line the driver is in a
        dead position, which no task motion passes; for that, exchange O2 and O4, A and B, so that the output
        becomes the driver.
    past_deg : tuple of float, deg, optional
        Angle of driver and coupler past toggle there (O2, A and B in line), (lo, hi), from -45 to 45, as in a
        clamp or brace. Positive where the motion from the first target (for the first target, the motion back
        from the last) passes the toggle position.
    coupler_angle_deg : tuple of float, deg, optional
        Direction A->B there, (lo, hi).
    coupler_rate : tuple of float, optional
        Derivative of this direction with respect to the driver angle there, (lo, hi).
    transmission_min_deg : float, deg, optional
        Least min(mu, pi - mu) there.
    mechanical_advantage_min : float, optional
        Least ``|omega2 / omega4|`` there.

    Raises
    ------
    ProblemError
        Values outside these limits, no target, or nothing that is limited.

    Examples
    --------
    >>> TargetLimits(targets=[3], past_deg=(2, 5)).past_deg
    (2.0, 5.0)
    """

    targets: Sequence[int]
    links: Sequence[str] = TOGGLE
    a: Box | None = None
    b: Box | None = None
    instant_centre: Box | None = None
    distances: Mapping[str, float | Limits] | None = None
    past_deg: Limits | None = None
    coupler_angle_deg: Limits | None = None
    coupler_rate: Limits | None = None
    transmission_min_deg: float | None = None
    mechanical_advantage_min: float | None = None

    def __post_init__(self) -> None:
        check_fields(self, "", **_CHECKS)
        if not self.limited:
            raise ProblemError(f"targets have no limit; give one or more of {', '.join(LIMITED)}")

    @property
    def limited(self) -> tuple[str, ...]:
        """Names of the limits that are stated."""
        return tuple(name for name in LIMITED if getattr(self, name) is not None)

    @property
    def named(self) -> dict[str, NamedLimits]:
        """The limits by name, by field."""
        every = {name: getattr(self, name) for name in self.limited}
        return {name: each for name, each in every.items() if isinstance(each, NamedLimits)}

    def wrong(self, task: Task, kinds: Sequence[str], where: str) -> list[str]:
        """Contradictions with a task and kinds of linkages, a line each."""
        if not (task.in_plane or task.has_output.any() or task.at_limits):
            return [
                f"{where} does not go with {task.described}; "
                "it needs poses, points, pairs of a function or the limit positions of one stroke"
            ]
        beyond = [number for number in self.targets if number > len(task)]
        wrong = [f"{where}.targets has {number}; the last target is {len(task)}" for number in beyond]
        if isinstance(self.distances, Distances):
            wrong += self.distances.wrong(task, f"{where}.distances")
        for name in self.limited:
            if task.at_limits and (why := _IN_LINE.get(name)):
                wrong.append(f"{where}.{name} does not go with a stroke; in a limit position {why}")
                continue
            limits, every = self.named.get(name), {"": _kinds_with(name)}
            if limits is not None:
                every = {f".{each}": [*limits.kinds_with(each)] for each in limits}
            for part, had in every.items():
                wrong += [] if set(kinds) & set(had) else [not_had(f"{where}.{name}{part}", kinds, had)]
        return wrong

    def for_kind(self, kind: str) -> TargetLimits | None:
        """Those that apply to a kind of linkage; None where none does."""
        kept: dict[str, Any] = {
            name: getattr(self, name) for name in self.limited if kind in _kinds_with(name)
        }
        kept |= {name: limits.for_kind(kind) for name, limits in self.named.items()}
        return (
            TargetLimits(targets=self.targets, **kept)
            if any(each is not None for each in kept.values())
            else None
        )


def _kinds_with(name: str) -> list[str]:
    """Kinds of one loop on which a limit has a meaning."""
    needed = _NEEDED.get(name, {"r3", "r4"})
    return [word for word, kind in ONE_LOOP.items() if needed <= {*kind.points, *kind.lengths}]


def _targets(values: Sequence[int], where: str) -> tuple[int, ...]:
    if isinstance(values, (str, bytes)) or not isinstance(values, Sequence) or not len(values):
        raise wrong_value(where, values, "a list of numbers of targets, counted from 1")
    return tuple(dict.fromkeys(checks.each_checked(values, where, _target)))


def _links(names: Sequence[str], where: str) -> tuple[str, ...]:
    given = sorted(map(str, names)) if isinstance(names, (list, tuple)) else []
    if given == sorted(TOGGLE):
        return TOGGLE
    if given == ["coupler", "output"]:
        raise ProblemError(
            f"{where} are coupler and output, whose toggle is a dead position of the driver; "
            "exchange o2 and o4, a and b, so that the output becomes the driver, and state "
            '["driver", "coupler"]'
        )
    raise wrong_value(where, names, '["driver", "coupler"]')


def _target(number: int, where: str) -> int:
    return checks.whole_number(number, 1, where)


def _box(value: Any, where: str) -> Box | None:
    if value is not None and not isinstance(value, Box):
        raise wrong_value(where, value, "a Box or a Region")
    if value == ANYWHERE:
        raise ProblemError(f"{where} limits neither x nor y; give one of them a finite side")
    return value


def _between(low: float, high: float, narrowest: float) -> Callable[[Any, str], Limits | None]:
    def check(value: Any, where: str) -> Limits | None:
        return None if value is None else checks.apart(value, where, narrowest, least=low, most=high)

    return check


def _number(low: float, high: float) -> Callable[[Any, str], float | None]:
    return lambda value, where: None if value is None else checks.number_within(value, low, high, where)


_CHECKS: dict[str, Callable[[Any, str], Any]] = {
    "targets": _targets,
    "links": _links,
    "a": _box,
    "b": _box,
    "instant_centre": _box,
    "distances": lambda value, where: None if value is None else Distances.checked(value, where),
    "past_deg": _between(-FARTHEST, FARTHEST, NARROWEST),
    "coupler_angle_deg": _between(*HEADINGS, NARROW_HEADING),
    "coupler_rate": _between(*RATES, NARROW_RATE),
    "transmission_min_deg": _number(0.0, 90.0),
    "mechanical_advantage_min": _number(0.0, 1e6),
}
LIMITED = tuple(each.name for each in fields(TargetLimits) if each.name not in ("targets", "links"))
# Limits that have no meaning of their own in limit positions, and why.
_IN_LINE = {
    "past_deg": "driver and coupler are in line",
    "instant_centre": "that is B; limit b",
    "coupler_rate": "it follows from lengths, r2/r3; limit link_ratios",
    "mechanical_advantage_min": "the advantage is infinite",
}
# Points and lengths without which a limit has no meaning; of those not named here r3 and r4.
_NEEDED = {"a": {"a"}, "b": {"b"}, "past_deg": {"r3"}, "coupler_angle_deg": {"a"}, "coupler_rate": {"a"}}
