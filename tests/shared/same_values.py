"""Shared by tests of values that come back: from copies, pickles and files."""

from dataclasses import fields
from typing import Any

import numpy as np


def check_same(one: Any, other: Any) -> None:
    """Every number and word in two values is the same, to the last bit."""
    if isinstance(one, np.ndarray):
        np.testing.assert_array_equal(one, other, strict=True)
    elif isinstance(one, tuple):
        for parts in zip(one, other, strict=True):
            check_same(*parts)
    elif hasattr(one, "__dataclass_fields__"):
        assert type(one) is type(other)
        for field in fields(one):
            check_same(getattr(one, field.name), getattr(other, field.name))
    else:
        assert one == other or (one != one and other != other)  # NaN
