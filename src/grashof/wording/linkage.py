"""Linkages in words."""

from __future__ import annotations

from grashof.problems import LinkageSpec
from grashof.problems.values.linkages.mechanisms import kinds_text, lengths_text


def dimensions_text(spec: LinkageSpec) -> str:
    """The lengths of a linkage with their unit, after its kind where that is no four-bar.

    >>> from grashof.problems import load_linkage_spec
    >>> dimensions_text(load_linkage_spec("engine"))
    'slider-crank, r2 40, r3 120, offset -20 mm'
    >>> dimensions_text(load_linkage_spec("pumpjack"))
    'r1 to r4 5, 1.1938, 3.7719, 3.04876 m'
    """
    said = [kinds_text([spec.linkage.mechanism.word]), lengths_text(spec.linkage, 6)]
    return f"{', '.join(filter(None, said))} {spec.length_unit}".rstrip()
