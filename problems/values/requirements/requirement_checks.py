"""Checks of single fields of `Requirements`."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from enum import StrEnum
from typing import Any, cast

from grashof.problems.values import checks
from grashof.problems.values.arrays import FloatArray, Limits
from grashof.problems.values.box import Box
from grashof.problems.values.errors import listing, wrong_value
from grashof.problems.values.linkages.one_loop import FourBar
from grashof.problems.values.requirements.distances import Distances
from grashof.problems.values.requirements.limit_kinds import Kind, Limit
from grashof.problems.values.requirements.link_ratios import LinkRatios
from grashof.problems.values.requirements.named_limits import NamedLimits
from grashof.problems.values.requirements.target_limits import TargetLimits

MAY_KEEP_OUT = (*FourBar.mechanism.points, "links", "body")
# Limits by name, by the key of their quantity.
NAMED: Mapping[str, type[NamedLimits]] = {"link_ratios": LinkRatios, "distances": Distances}
KEPT_OUT = f"a list of {listing(MAY_KEEP_OUT, 'and')}"


def limits(limited: Limit, value: Any, where: str) -> Box | NamedLimits | Limits | float | str:
    """A checked limit of a quantity: a box, limits by name, a pair, an angle, a number or a word."""
    if limited.kind in (Kind.INSIDE, Kind.ON_BODY):
        if not isinstance(value, Box):
            raise wrong_value(where, value, "a Box or a Region")
        return value
    if limited.kind is Kind.NAMED:
        return NAMED[limited.quantity.key].checked(value, where)
    low, high = limited.allowed
    if limited.kind in (Kind.BETWEEN, Kind.HEADING):
        return checks.apart(value, where, limited.narrowest, least=low, most=high)
    if limited.kind is Kind.WORD:
        return checks.one_of(value, where, limited.words)
    if limited.kind is Kind.DIRECTION and isinstance(value, tuple | list):
        low, high = checks.limits(cast(Limits, value), where, least=-checks.GREATEST)
        return low if low == high else (low, high)
    if limited.kind.is_angle:
        return checks.finite_number(value, where)
    return checks.number_within(value, low, high, where)


def areas(values: Sequence[FloatArray], where: str) -> tuple[FloatArray, ...]:
    """Polygons to keep out of, corners (M, 2) each."""
    if isinstance(values, Sequence) and not len(values):
        return ()
    # Here, not above: shapely takes a while to import, and few problems have areas.
    from grashof.problems.values.areas import polygons

    return polygons(values, where)


def at_targets(values: Sequence[TargetLimits], where: str) -> tuple[TargetLimits, ...]:
    """Limits at single targets."""
    if not isinstance(values, Sequence) or not all(isinstance(each, TargetLimits) for each in values):
        raise wrong_value(where, values, "a list of TargetLimits")
    return tuple(values)


def word(kind: type[StrEnum], value: str, where: str) -> StrEnum:
    """A word as a member of its enumeration."""
    return kind(checks.one_of(value, where, kind))
