"""Cases of the benchmarks, and times in words."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from time import perf_counter
from typing import TypeVar

import numpy as np

T = TypeVar("T")


@dataclass(frozen=True, slots=True)
class Case:
    """One case of a benchmark."""

    name: str
    usual: int
    "Tasks, repetitions or size, unless ``--count`` states another number."
    measure: Callable[[int, int], Iterable[str]]
    'Takes that number and the seed, and returns lines; one that ends with "!" is a failure.'


def timed(run: Callable[[], T], clock: Callable[[], float] = perf_counter) -> tuple[T, float]:
    """A result, and the time that it took, s."""
    begun = clock()
    result = run()
    return result, clock() - begun


def spread(seconds: Sequence[float]) -> str:
    """Times in words."""
    late = np.quantile(seconds, 0.95)
    return f"median {np.median(seconds):.3f} s, 95 % {late:.3f} s, longest {max(seconds):.2f} s"
