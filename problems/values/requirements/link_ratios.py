"""Limits of ratios of link lengths."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import chain
from typing import Any, ClassVar

import numpy as np

from grashof.problems.values.arrays import FloatArray, Limits
from grashof.problems.values.errors import ProblemError, shown
from grashof.problems.values.linkages.mechanisms import ROWS
from grashof.problems.values.requirements.named_limits import NamedLimits

PAIR = re.compile(r"(r[1-6])/(r[1-6])")
LEAST_LENGTH, ROUNDING = 1e-300, 1e-9


@dataclass(frozen=True, slots=True)
class LinkRatios(NamedLimits):
    """Limits of ratios by their names, such as "r3/r2"; equal links have the ratio 1.

    Examples
    --------
    >>> ratios = LinkRatios.checked({"r4/r2": 1, "r3/r2": (2, 3)}, "link_ratios")
    >>> ratios["r4/r2"], ratios.of(["r2", "r3"])
    ((1.0, 1.0), LinkRatios(rows=(('r3/r2', (2.0, 3.0)),)))
    """

    example: ClassVar[str] = 'a table such as { "r3/r2" = [2, 2.5] }'
    allowed: ClassVar[Limits] = (1e-6, 1e6)

    @classmethod
    def kept_name(cls, name: Any, where: str) -> str:
        """Two different lengths."""
        found = PAIR.fullmatch(name) if isinstance(name, str) else None
        if found is None or found[1] == found[2]:
            raise ProblemError(f'{where} has {shown(name)}; it must be two of r1 to r6, such as "r3/r2"')
        return found[0]

    @classmethod
    def kinds_with(cls, name: str) -> list[str]:
        """The kinds that have both links."""
        return [word for word, rows in ROWS.items() if set(links_of(name)) <= set(rows[0].lengths)]

    def of(self, lengths: Iterable[str]) -> LinkRatios:
        """Those of two of some lengths."""
        known = set(lengths)
        return self.where(lambda name: known.issuperset(links_of(name)))


def links_of(name: str) -> tuple[str, str]:
    """The two lengths of a ratio."""
    one, _, other = name.partition("/")
    return one, other


def contradictions(ratios: LinkRatios, lengths: Mapping[str, Limits | None], greatest: float) -> list[str]:
    """Ratios that the other limits do not allow, a line each.

    The others are those of lengths, the greatest ratio of any two, and the other ratios.
    """
    wrong = []
    stated = {name: limits for name, limits in lengths.items() if limits is not None}
    for name, asked in ratios.items():
        others = LinkRatios(tuple(row for row in ratios.rows if row[0] != name))
        low, high = _allowed(name, others, stated, greatest)
        if asked[0] > high * (1 + ROUNDING) or asked[1] < low * (1 - ROUNDING):
            allowed = f"the other limits allow [{low:.6g}, {high:.6g}]"
            wrong.append(f'requirements.link_ratios."{name}" is {shown(list(asked))}; {allowed}')
    return wrong


def greatest_logs(names: Sequence[str], ratios: LinkRatios, greatest: float) -> FloatArray:
    """Greatest logarithm of each length (rows) over each other one (columns), (n, n).

    By the greatest ratio of any two, and by those ratios whose links are both named.

    >>> np.exp(greatest_logs(["r2", "r4"], LinkRatios((("r4/r2", (0.5, 2.0)),)), 9.0)).round(6).tolist()
    [[9.0, 2.0], [2.0, 9.0]]
    """
    most = np.full((len(names), len(names)), np.log(greatest))
    for name, (low, high) in ratios.of(names).items():
        over, under = map(names.index, links_of(name))
        most[over, under] = min(most[over, under], np.log(high))
        most[under, over] = min(most[under, over], -np.log(low))
    return most


def _allowed(name: str, ratios: LinkRatios, lengths: Mapping[str, Limits], greatest: float) -> Limits:
    """The range of a ratio by chains of other limits, the shortest ways between logarithms of lengths."""
    one, other = links_of(name)
    names = list(dict.fromkeys(["", one, other, *lengths, *chain.from_iterable(map(links_of, ratios))]))
    most = greatest_logs(names, ratios, greatest)
    most[0] = most[:, 0] = np.inf  # the unit of length
    np.fill_diagonal(most, 0.0)
    for each, limits in lengths.items():
        i, (low, high) = names.index(each), np.log(np.maximum(limits, LEAST_LENGTH))
        most[i, 0], most[0, i] = high, -low
    for k in range(len(names)):
        most = np.minimum(most, most[:, [k]] + most[[k]])
    i, j = names.index(one), names.index(other)
    return float(np.exp(-most[j, i])), float(np.exp(most[i, j]))
