"""Limits of distances between pivots, and of the coupler point from them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

from grashof.problems.values.arrays import Limits
from grashof.problems.values.checks import GREATEST
from grashof.problems.values.errors import ProblemError, listing, shown
from grashof.problems.values.linkages.mechanism import ONE_LOOP
from grashof.problems.values.linkages.mechanisms import ROWS
from grashof.problems.values.requirements.named_limits import NamedLimits
from grashof.problems.values.tasks.task import Task

PAIRS = ("a-o4", "b-o2", "a-p", "b-p", "o2-p", "o4-p")
EITHER_WAY = tuple(name for pair in PAIRS for name in (pair, "-".join(reversed(pair.split("-")))))
_LINKS = {"o2-o4": "r1", "a-o2": "r2", "a-b": "r3", "b-o4": "r4"}


@dataclass(frozen=True, slots=True)
class Distances(NamedLimits):
    """Limits of distances by their two points, such as "a-o4", stated in either order.

    Examples
    --------
    >>> Distances.checked({"a-o4": (2, 3), "p-b": 1}, "distances")["b-p"]
    (1.0, 1.0)
    """

    example: ClassVar[str] = "a table such as { a-o4 = [2, 3] }"
    allowed: ClassVar[Limits] = (0.0, GREATEST)

    @classmethod
    def kept_name(cls, name: Any, where: str) -> str:
        """Two points whose distance is not the length of a link, in the order of `PAIRS`."""
        both = ends_of(name) if isinstance(name, str) else ()
        if (kept := "-".join(both)) in PAIRS:
            return kept
        length = _LINKS.get(kept)
        wanted = f"limit {length}, the length of that link" if length else f"it must be {listing(PAIRS)}"
        raise ProblemError(f"{where} has {shown(name)}; {wanted}")

    @classmethod
    def kinds_with(cls, name: str) -> Sequence[str]:
        """The kinds that have both points; P, where the link that carries it is a bar from A to B."""
        both = set(ends_of(name))
        of_p = {word for word, kind in ONE_LOOP.items() if "r3" in kind.lengths or both == {"a", "p"}}
        return [
            word
            for word, rows in ROWS.items()
            if both <= set(rows[0].points) and ("p" not in both or word in of_p)
        ]

    def wrong(self, task: Task, where: str) -> list[str]:
        """Errors for distances that do not apply to a task, a line each."""
        if "p" not in task.without:
            return []
        named = (name for name in self if "p" in ends_of(name))
        return [f"{where}.{name} does not apply to a {task.kind}; remove it" for name in named]


def ends_of(name: str) -> tuple[str, ...]:
    """The points of a distance in the order of `PAIRS`.

    >>> ends_of("o4-a"), ends_of("p-b")
    (('a', 'o4'), ('b', 'p'))
    """
    return tuple(sorted(name.split("-")))
