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
from grashof.problems.values.requirements.quantities import (
    GROUNDED,
    MEASURED,
    RMS,
    Kind,
    Limit,
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
) -> Any:
    """A field of `Requirements` that limits a quantity: one of `MEASURED`, or one declared with the field."""
    limited = MEASURED[quantity] if isinstance(quantity, str) else quantity
    return field(default=default, metadata={"limit": Limit(limited, kind, allowed, usual, words or {})})


def between(
    quantity: str | Quantity,
    low: float = 0.0,
    high: float = GREATEST,
    usual: tuple[float, float] | None = None,
) -> Any:
    """A field that limits a quantity to [lo, hi], both of them from `low` to `high`."""
    return limit(quantity, Kind.BETWEEN, allowed=(low, high), usual=usual)
