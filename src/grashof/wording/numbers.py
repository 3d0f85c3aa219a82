"""Numbers as people read them in tables."""

from __future__ import annotations

from typing import Any

import numpy as np


def value_text(value: float | int | str | bool) -> str:
    """A value of the summary: six digits, yes or no.

    >>> value_text(True), value_text(2.0), value_text("crank-rocker"), value_text(np.inf)
    ('yes', '2', 'crank-rocker', 'no limit')
    """
    if isinstance(value, bool):
        return "yes" if value else "no"
    return number_text(value, 6) if isinstance(value, float) else str(value)


def with_unit(label: str, unit: str) -> str:
    """A label with its unit, if there is one."""
    return f"{label} ({unit})" if unit else label


def number_text(value: Any, digits: int) -> str:
    """A number that may have no limit, or not be known.

    >>> number_text(1.23456, 3), number_text(-np.inf, 3), number_text(np.nan, 3)
    ('1.23', '-no limit', '-')
    """
    number = float(value)
    if np.isinf(number):
        return "no limit" if number > 0 else "-no limit"
    return "-" if np.isnan(number) else f"{number + 0.0:.{digits}g}"
