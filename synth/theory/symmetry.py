"""Rotations and reflections that map a task onto itself: the image of a design does the task, too."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from grashof.problems import Task
from grashof.problems.values.arrays import ComplexArray, FloatArray, IntArray

EVEN = 1e-3  # sizes, rad: targets nearer to others coincide with them


@dataclass(frozen=True, slots=True)
class Symmetry:
    """A rotation about the middle of a task, after a reflection in the x axis through it if `mirrored`."""

    turn: complex  # of absolute value 1
    mirrored: bool

    def of(self, signatures: FloatArray, signed: tuple[int, ...] = (8,)) -> FloatArray:
        """The image of designs by their signatures (k, 9), pivots measured from the middle of the task.

        See `grashof.synth.theory.distinct.signature`; the `signed` columns change their sign in a mirror.
        """
        made = np.array(signatures)
        pivots = made[:, [0, 2]] + 1j * made[:, [1, 3]]
        pivots = self.turn * (pivots.conj() if self.mirrored else pivots)
        made[:, [0, 2]], made[:, [1, 3]] = pivots.real, pivots.imag
        if self.mirrored:
            made[:, signed] *= -1
        return made


def symmetries(task: Task) -> tuple[Symmetry, ...]:
    """All that map the targets onto themselves, in their order or the reverse; the first moves nothing.

    A closed path may begin at another point. Angles of poses, driver rotations and weights must agree, too.
    """
    if not task.has_position.any():
        return (Symmetry(1 + 0j, False),)
    places = (_once(task) - middle_of(task)) @ np.array([1, 1j])
    found = [Symmetry(1 + 0j, False)]
    for order, able in _orders(task, places):
        for mirrored in able:
            turn = _turn(places, order, mirrored, EVEN * task.size)
            if turn is None or not _agrees(task, order, mirrored):
                continue
            if mirrored or abs(turn - 1) > EVEN:
                found.append(Symmetry(turn, mirrored))
    return tuple(found)


def middle_of(task: Task) -> FloatArray:
    """Mean of the target positions, shape (2,), length: it stays in its place under all symmetries.

    The origin where no target has a position.
    """
    if not task.has_position.any():
        return task.middle
    middle: FloatArray = np.nanmean(_once(task), axis=0)
    return middle


def _once(task: Task) -> FloatArray:
    """Target positions, without a last point of a closed path that repeats the first; shape (n, 2)."""
    places = task.positions
    again = task.closed and np.hypot(*(places[-1] - places[0])) <= EVEN * task.size
    return places[:-1] if again else places


def _orders(task: Task, places: ComplexArray) -> Iterator[tuple[IntArray, list[bool]]]:
    """Orders in which the targets may be met, shape (count,), each with the ways it may be: mirrored or not.

    A closed path of N points has 2 N of them. Those are left out after which no turn lays the points on
    the others, by their correlation (Fourier transforms, N log N steps for all).
    """
    count = len(places)
    forth, first = np.arange(count), np.arange(count if task.closed else 1)
    able = np.ones((2, 2, len(first)), dtype=bool)
    if task.closed:
        z = np.nan_to_num(places)
        enough = (np.abs(z) ** 2).sum() - count * (EVEN * task.size) ** 2
        for mirrored, image in enumerate((z, z.conj())):
            for back, other in enumerate((image, image[::-1])):
                # Over k of z[first + k] conj(other[k]), for every first.
                product = np.fft.ifft(np.fft.fft(z) * np.fft.fft(other).conj())
                able[back, mirrored] = np.abs(product) >= enough
    for back in (0, 1):
        for begin in first[able[back].any(axis=0)]:
            order = (begin - 1 - forth if back else begin + forth) % count
            yield order, [way for way in (False, True) if able[back, int(way), begin]]


def _turn(places: ComplexArray, order: IntArray, mirrored: bool, least: float) -> complex | None:
    """The rotation after which the targets lie on those of another order; None where there is none."""
    image, there = (places.conj() if mirrored else places), places[order]
    if not np.array_equal(np.isnan(image), np.isnan(there)):
        return None
    product = complex(np.nansum(there * image.conj()))
    if not abs(product) > 0:
        return None
    turn = product / abs(product)
    return turn if np.nanmax(np.abs(there - turn * image)) <= least else None


def _agrees(task: Task, order: IntArray, mirrored: bool) -> bool:
    """Whether angles, weights and timing are those of the targets fallen on."""
    angles, weights, timing = (
        column[: len(order)] for column in (task.angles, task.weights, task.driver_turns)
    )
    if not np.array_equal(np.isnan(angles[order]), np.isnan(angles)):
        return False
    return (
        _constant(angles[order] - (-1 if mirrored else 1) * angles)
        and np.array_equal(weights[order], weights)
        and any(_constant(timing[order] - sense * timing) for sense in (1, -1))
    )


def _constant(angles: FloatArray) -> bool:
    """Whether all given angles are the same modulo full turns."""
    given = angles[~np.isnan(angles)]
    return not given.size or bool(np.abs(np.exp(1j * (given - given[0])) - 1).max() <= EVEN)
