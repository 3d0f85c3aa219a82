"""Which designs are distinct, and the best distinct ones of many."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from grashof.problems import Linkage, Task
from grashof.problems.values.arrays import FloatArray, IntArray
from grashof.problems.values.linkages.mechanism import Mechanism
from grashof.synth.theory.symmetry import middle_of

# Share of the largest number of two designs by which they differ at least: 1 %, and a quarter more
# because pivots are measured from the middle of the task, where the largest number is smaller.
DISTINCT = 0.0125


def signature(linkage: Linkage, origin: FloatArray | None = None) -> FloatArray:
    """The numbers that distinguish designs, all in length: O2, O4, r2, r3, r4, u, v; shape (..., 9).

    Of slider kinds the offset in place of r4; of a slider-crank the slide's direction, of length r2 + r3, in
    place of O4, of an inverted one nothing in place of r3. Pivots are measured from `origin`, shape (2,),
    where one is given. Of six-bars all parameters but signs, without an origin places from O2; a direction
    has the length of all links together.
    """
    middle = np.zeros(2) if origin is None else origin
    if len(linkage.mechanism.loops) > 1:
        return _of_six_bar(linkage, linkage.o2 if origin is None else origin)
    if "o4" in linkage.mechanism.ground:
        second = linkage.o4 - middle
    else:
        direction = np.stack([np.cos(linkage.slide_angle), np.sin(linkage.slide_angle)], axis=-1)
        second = linkage.lengths.sum(axis=-1)[..., None] * direction
    names = ("r2", "r3", "offset" if linkage.mechanism.slides else "r4")
    lengths = (getattr(linkage, name, np.zeros_like(linkage.r2)) for name in names)
    return np.concatenate(
        [linkage.o2 - middle, second, np.stack(list(lengths), axis=-1), linkage.coupler_point], axis=-1
    )


def task_signature(task: Task, linkage: Linkage) -> FloatArray:
    """The signature by which designs for a task are compared, shape (..., K).

    Pivots are measured from the middle of the task (`middle_of`). Where no target has a position, a linkage
    of one loop is moved to O2 = 0 and turned to the x axis, and where no target has a length either, the
    ground gets the length 1: copies are one design.
    """
    if task.has_position.any():
        return signature(linkage, middle_of(task))
    numbers = signature(linkage)
    return numbers if len(linkage.mechanism.loops) > 1 else _unplaced(task, numbers, linkage)


def _unplaced(task: Task, numbers: FloatArray, linkage: Linkage) -> FloatArray:
    """Signatures of linkages of one loop without place, direction and, where any will do, scale."""
    ground = numbers[..., 2:4] - (numbers[..., :2] if "o4" in linkage.mechanism.ground else 0.0)
    length = np.hypot(*np.moveaxis(ground, -1, 0))[..., None]
    nothing = np.zeros_like(length)
    made = np.concatenate([nothing, nothing, length, nothing, numbers[..., 4:]], axis=-1)
    return made if task.states_length else made / length


def signatures(task: Task, linkages: Sequence[Linkage]) -> FloatArray:
    """Signatures of linkages of any kinds, (n, K); those of kinds with fewer numbers end with zeros."""
    found = [task_signature(task, linkage) for linkage in linkages]
    rows = np.zeros((len(found), max(map(len, found), default=0)))
    for row, numbers in zip(rows, found, strict=True):
        row[: len(numbers)] = numbers
    return rows


def _of_six_bar(linkage: Linkage, origin: FloatArray) -> FloatArray:
    numbers = list[FloatArray]()
    for row, value in zip(linkage.mechanism.parameters, linkage.parameters, strict=True):
        if row.in_length:
            placed = value - origin if row.kind in ("place", "station") else value
            numbers.append(placed if row.paired else placed[..., None])
        elif row.kind == "angle" and row.name != "body_angle":
            numbers.append(
                linkage.lengths.sum(axis=-1)[..., None] * np.stack([np.cos(value), np.sin(value)], axis=-1)
            )
    return np.concatenate(numbers, axis=-1)


def mirrored(kind: Mechanism) -> tuple[int, ...]:
    """Columns of it that change their sign in a mirror, besides y of pivots and directions."""
    return (6, 8) if kind.slides else (8,)


EQUAL = 1e-9  # largest difference of scores that tie, as a share of them


def apart(one: FloatArray, others: FloatArray) -> FloatArray:
    """Largest difference between signatures as a share of their largest absolute value, (..., n).

    Of `one` (..., 9) and `others` (n, 9); above `DISTINCT` for distinct designs.
    """
    one = one[..., None, :]
    scale = np.maximum(np.abs(one).max(axis=-1), np.abs(others).max(axis=-1))
    difference: FloatArray = np.abs(others - one).max(axis=-1) / scale
    return difference


def pick_apart(
    signatures: FloatArray,
    score: FloatArray,
    least: float,
    most: int,
    between: Callable[[], None] = lambda: None,
) -> IntArray:
    """Indices of the `most` best entries that are pairwise more than `least` apart (see `apart`), best first.

    Of `signatures` (n, 9), with greater `score` (n,) better. `between` is called before each is picked; it
    may raise, as `raise_if_overdue` does.
    """
    left = best_first(score)
    picked: list[int] = []
    largest = np.abs(signatures).max(axis=1)
    while left.size and len(picked) < most:
        between()
        one = left[0]
        picked.append(int(one))
        differ = np.abs(signatures[left] - signatures[one]).max(axis=1)
        left = left[differ > least * np.maximum(largest[left], largest[one])]
    return np.array(picked, dtype=np.int64)


def best_first(score: FloatArray) -> IntArray:
    """Indices by score, the greatest first; what differs by rounding alone stays in its order, shape (n,).

    Scores tie that differ from the next one by at most `EQUAL` of themselves.

    >>> best_first(np.array([0.5, 1.0 - 1e-12, 1.0, 2.0])).tolist()
    [3, 1, 2, 0]
    """
    order = np.argsort(-score, kind="stable")
    value = score[order]
    with np.errstate(invalid="ignore"):  # differences of infinite ones, and NaN
        step = ~(np.abs(np.diff(value)) <= EQUAL * np.abs(value[1:])) & (value[1:] != value[:-1])
    rank = np.empty(len(score), dtype=np.int64)
    rank[order] = np.concatenate([[0], np.cumsum(step)])[: len(order)]
    return np.argsort(rank, kind="stable")
