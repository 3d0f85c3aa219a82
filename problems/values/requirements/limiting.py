"""Fields of requirements that limit a quantity, and quantities that are declared with them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field
from typing import Any

import numpy as np

from grashof.problems.values.arrays import Limits
from grashof.problems.values.checks import GREATEST
from grashof.problems.values.linkages.mechanism import ONE_LOOP, WORDS
from grashof.problems.values.linkages.mechanisms import SLIDER_CRANK, having
from grashof.problems.values.requirements.limit_kinds import (
    HEADINGS,
    NARROW_HEADING,
    NARROW_RATE,
    RATES,
    Kind,
    Limit,
)
from grashof.problems.values.requirements.quantities import (
    GROUNDED,
    MEASURED,
    OUTPUTS,
    RMS,
    Needs,
    Quantity,
    Scope,
)
from grashof.problems.values.units import Unit


def place_of(name: str, over: Scope) -> Quantity:
    """The place of a joint."""
    kinds = GROUNDED if name == "d" else having(name) if over is Scope.DESIGN else WORDS
    return Quantity(name, f"place of {name.upper()}", Unit.LENGTH, over, listed=False, kinds=kinds)


def on_body(name: str) -> Quantity:
    """The place of a joint on the guided body."""
    words = f"place of {name.upper()} on the body"
    kinds = tuple(word for word, kind in ONE_LOOP.items() if name in kind.links[2].points)
    return Quantity(f"{name}_on_body", words, Unit.LENGTH, needs=Needs.ANGLES, listed=False, kinds=kinds)


def advantage(key: str, better: int = 0, **others: Any) -> Quantity:
    """The mechanical advantage over the task motion."""
    words = "mechanical advantage"
    return Quantity(key, words, Unit.RATIO, Scope.TASK, better, kinds=OUTPUTS, listed=not better, **others)


def structural_error(key: str, travels: Mapping[str, str] | None = None) -> Quantity:
    """The greatest error of an output ("max"), or its root mean square; `travels` has the keys of a slide."""
    about, name = "output minus the wanted output, over the full range", f"structural_error_{key}"
    words = "greatest structural error" if key == "max" else f"structural error{RMS}"
    label, task = f"{key} error", Scope.TASK
    if travels is None:
        return Quantity(name, label, Unit.ANGLE, task, -1, Needs.ROTATION, 3, about, words=words)
    return Quantity(
        travels[name], label, Unit.LENGTH, task, -1, Needs.TRAVEL, 3, about, named=name,
        kinds=(SLIDER_CRANK,), words=words,
    )  # fmt: skip


def limit(
    quantity: str | Quantity,
    kind: Kind,
    *,
    default: Any = None,
    allowed: tuple[float, float] = (-np.inf, np.inf),
    usual: tuple[float, float] | None = None,
    words: Mapping[str, Limits] | None = None,
    narrowest: float = 0.0,
) -> Any:
    """A field of `Requirements` that limits a quantity: one of `MEASURED`, or one declared with the field."""
    limited = MEASURED[quantity] if isinstance(quantity, str) else quantity
    return field(
        default=default, metadata={"limit": Limit(limited, kind, allowed, usual, words or {}, narrowest)}
    )


def between(
    quantity: str | Quantity,
    low: float = 0.0,
    high: float = GREATEST,
    usual: tuple[float, float] | None = None,
) -> Any:
    """A field that limits a quantity to [lo, hi], both of them from `low` to `high`."""
    return limit(quantity, Kind.BETWEEN, allowed=(low, high), usual=usual)


def coupler(name: str) -> Any:
    """A field that limits the direction or the rate of the coupler, whose extremes are `MEASURED`."""
    unit, words, about, kind, allowed, narrowest = {
        "angle": (Unit.ANGLE, "direction", "of A->B", Kind.HEADING, HEADINGS, NARROW_HEADING),
        "rate": (Unit.RATIO, "rate", "derivative of theta3 by theta2", Kind.BETWEEN, RATES, NARROW_RATE),
    }[name]
    words = f"{words} of the coupler"
    made = Quantity(f"coupler_{name}", words, unit, Scope.TASK, about=about, listed=False)
    return limit(made, kind, allowed=allowed, narrowest=narrowest)
