"""Numbers as people read them in tables, and the class and lengths of a linkage."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from grashof.problems import LinkageSpec
from grashof.problems.values.linkages.mechanisms import has_one_loop, kinds_text, lengths_text

if TYPE_CHECKING:
    from grashof.synth import Candidate


def value_text(value: float | int | str | bool) -> str:
    """A value of the summary: six digits, yes or no.

    >>> value_text(True), value_text(2.0), value_text("crank-rocker"), value_text(np.inf)
    ('yes', '2', 'crank-rocker', 'no limit')
    """
    if isinstance(value, bool):
        return "yes" if value else "no"
    return number_text(value, 6) if isinstance(value, float) else str(value)


def with_unit(label: str, unit: str) -> str:
    """A label with its unit, if any."""
    return f"{label} ({unit})" if unit else label


def number_text(value: Any, digits: int) -> str:
    """A number that may be infinite or unknown.

    >>> number_text(1.23456, 3), number_text(-np.inf, 3), number_text(np.nan, 3)
    ('1.23', '-no limit', '-')
    """
    number = float(value)
    if np.isinf(number):
        return "no limit" if number > 0 else "-no limit"
    return "-" if np.isnan(number) else f"{number + 0.0:.{digits}g}"


def dimensions_text(spec: LinkageSpec) -> str:
    """The lengths of a linkage with their unit, preceded by its kind unless that is a four-bar.

    >>> from grashof.problems import load_linkage_spec
    >>> dimensions_text(load_linkage_spec("engine"))
    'slider-crank, r2 40, r3 120, offset -20 mm'
    >>> dimensions_text(load_linkage_spec("pumpjack"))
    'r1 to r4 5, 1.1938, 3.7719, 3.04876 m'
    """
    said = [kinds_text([spec.linkage.mechanism.word]), lengths_text(spec.linkage, 6)]
    return f"{', '.join(filter(None, said))} {spec.length_unit}".rstrip()


def class_text(candidate: Candidate) -> str:
    """The Grashof class of a linkage with one loop, otherwise its mechanism."""
    word = candidate.linkage.mechanism.word
    return str(candidate.verdict.grashof_class) if has_one_loop(word) else word
