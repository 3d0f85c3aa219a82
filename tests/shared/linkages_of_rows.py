"""A linkage of each row of `MECHANISMS`, with numbers of which no digit may be lost."""

from __future__ import annotations

from typing import Any

import numpy as np

from grashof.problems.values.linkages.linkage import Linkage
from grashof.problems.values.linkages.mechanism import Mechanism
from grashof.problems.values.linkages.mechanisms import linkage_of


def row_name(value: Any) -> str | None:
    """The name of a row, to tell it in the name of a test from others of its word."""
    if not isinstance(value, Mechanism):
        return None
    return f"{value.word}-{value.dyads[-1].kind}-{value.dyads[-1].hosts}"


def linkage_of_row(row: Mechanism, point_link: int = 5) -> Linkage:
    """A linkage of a row; of a six-bar `point_link` carries P."""
    rng = np.random.default_rng(7)
    sizes = {each.name: rng.uniform(0.5, 2.0, 2 if each.paired else ()) for each in row.parameters}
    signs = {each.name: -1 for each in row.parameters if each.kind == "sign"}
    choices = {"hosts": row.dyads[1].hosts, "point_link": point_link} if len(row.dyads) > 1 else {}
    return linkage_of(row.word, sizes | signs | choices)
