"""Linkages in words."""

from __future__ import annotations

from grashof.problems import LinkageSpec
from grashof.problems.values.mechanisms import FOUR_BAR


def dimensions_text(spec: LinkageSpec) -> str:
    """The lengths of a linkage, and what else its kind is made by.

    Examples
    --------
    >>> from grashof.problems import load_linkage_spec
    >>> dimensions_text(load_linkage_spec("engine"))
    'slider-crank, r2 40, r3 120, offset -20 mm'
    >>> dimensions_text(load_linkage_spec("pumpjack"))
    'r1 to r4 5, 1.1938, 3.7719, 3.04876 m'
    """
    linkage = spec.linkage
    if linkage.MECHANISM == FOUR_BAR:
        lengths = ", ".join(f"{length:.6g}" for length in linkage.lengths)
        return f"r1 to r4 {lengths} {spec.length_unit}".rstrip()
    names = (*linkage.LENGTHS, *(row.name for row in linkage.PARAMETERS if row.kind == "distance"))
    told = ", ".join(f"{name} {float(getattr(linkage, name)):.6g}" for name in names)
    return f"{linkage.MECHANISM}, {told} {spec.length_unit}".rstrip()
