"""Checks at the boundary: each raises one clear `ProblemError`."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager, suppress
from numbers import Real
from typing import Any, TypeVar

import numpy as np
import numpy.typing as npt

from grashof.problems.values.arrays import FloatArray, Limits, frozen_array
from grashof.problems.values.errors import ProblemError, shown, wrong_value
from grashof.problems.values.extent import span
from grashof.problems.values.text import counted

GREATEST = 1e20  # of lengths, masses and speeds: squares of torques stay within the floats
MOST_TURNS = 100  # of a stated angle: more of them take its last digits
DIGITS = 300  # of whole numbers: they become floats, times an effort
LEAST = 1e-20  # size of a task, for the same reason

Checked = TypeVar("Checked")
Rows = tuple[tuple[float, ...], ...]


def finite_rows(
    values: npt.ArrayLike, columns: int, where: str, row_means: str, greatest: float = np.inf
) -> FloatArray:
    """Array of shape (N, `columns`), each row checked by itself so that the message can name it."""
    if isinstance(values, (str, bytes)) or not isinstance(values, Iterable):
        raise wrong_value(where, values, f"a list, each entry {row_means}")
    rows = each_checked(values, where, lambda row, name: _finite_row(row, columns, name, row_means, greatest))
    return frozen_array(np.array(rows, dtype=np.float64).reshape(-1, columns))


def _finite_row(row: object, columns: int, name: str, row_means: str, greatest: float) -> FloatArray:
    try:
        numbers = np.asarray(row)
    except ValueError:  # rows of unequal length inside
        raise wrong_value(name, row, row_means) from None
    if numbers.dtype.kind not in "iuf":
        raise wrong_value(name, row, row_means)
    if numbers.shape != (columns,):
        count = counted(numbers.size, "number") if numbers.ndim == 1 else "not a plain list of numbers"
        raise ProblemError(f"{name} is {_plain(row)}, {count}; it must be {row_means}")
    if not np.isfinite(numbers).all():
        raise ProblemError(f"{name} is {_plain(row)}; all numbers must be finite")
    if (np.abs(numbers) > greatest).any():
        raise ProblemError(f"{name} is {_plain(row)}; its numbers must be at most {greatest:g}")
    return numbers.astype(np.float64)


@contextmanager
def noted(wrong: list[str]) -> Iterator[None]:
    """Note the errors raised inside, and continue."""
    try:
        yield
    except ProblemError as error:
        wrong += str(error).splitlines()


def refuse(wrong: Sequence[str]) -> None:
    """Raise the errors that were noted, if any."""
    if wrong:
        raise refused(wrong)


def refused(wrong: Iterable[str]) -> ProblemError:
    """All noted errors as one, a line each, without repetition."""
    return ProblemError("\n".join(dict.fromkeys(wrong)))


def each_checked(
    values: Iterable[Any],
    where: str,
    check: Callable[[Any, str], Checked],
    place: str = "[{}]",
    first: int = 0,
) -> list[Checked]:
    """The results of a check of each value and its place; all errors are raised together."""
    found: list[Checked] = []
    wrong: list[str] = []
    for number, value in enumerate(values, start=first):
        with noted(wrong):
            found.append(check(value, where + place.format(number)))
    refuse(wrong)
    return found


def located(error: ProblemError, where: str) -> ProblemError:
    """The error with the place, such as the name of a file, before every line."""
    return ProblemError("\n".join(f"{where}: {line}" for line in str(error).splitlines()))


@contextmanager
def located_in(where: str) -> Iterator[None]:
    """Begin every line of an error raised inside with the place."""
    try:
        yield
    except ProblemError as error:
        raise located(error, where) from None


def outline(values: npt.ArrayLike, where: str) -> FloatArray:
    """Array of shape (N, 2), the corners of something drawn."""
    corners = finite_rows(values, 2, where, "a corner [x, y]", GREATEST)
    if len(corners) < 2:
        raise ProblemError(f"{where} has {counted(len(corners), 'corner')}; it must have two or more")
    return corners


def number_array(values: npt.ArrayLike, message: str, axes: Sequence[int] = range(9)) -> npt.NDArray[Any]:
    """Values as an array of numbers with one of these numbers of axes, else refused with a message."""
    try:
        numbers = np.asarray(values)
    except ValueError:  # lists of unequal length inside
        numbers = np.array(None)
    if numbers.dtype.kind not in "iuf" or numbers.ndim not in axes:
        raise ProblemError(message)
    return numbers


def finite_list(values: npt.ArrayLike, where: str, what: str) -> FloatArray:
    """Array of shape (N,), refused when it is not a list of `what`, or a number of it is not finite."""
    numbers = number_array(values, f"{where} is {shown(values)}; it must be a list of {what}", (1,))
    for index in np.flatnonzero(~np.isfinite(numbers)):
        raise ProblemError(f"{where}[{index}] is {numbers[index]}; all numbers must be finite")
    return numbers.astype(np.float64)


def finite_number(value: float, where: str) -> float:
    """`value` as a float, refused when it is not a finite number."""
    if isinstance(value, Real) and not isinstance(value, bool):
        with suppress(OverflowError):  # a whole number beyond the floats
            if math.isfinite(value):
                return float(value)
    raise ProblemError(f"{where} is {shown(value)}; it must be a finite number")


def positive_number(value: float, where: str) -> float:
    """`value` as a float, refused when it is not greater than zero."""
    number = finite_number(value, where)
    if number <= 0:
        raise ProblemError(f"{where} is {number:.15g}; it must be a number greater than zero")
    return number


def number_within(value: float, low: float, high: float, where: str) -> float:
    """`value` as a float, refused outside [low, high]."""
    number = finite_number(value, where)
    if not low <= number <= high:
        raise ProblemError(f"{where} is {number:.15g}; it must be from {low:g} to {high:g}")
    return number


def within(low: float, high: float) -> Callable[[float, str], float]:
    """The check of a number from `low` to `high`, by its value and the place that messages name."""
    return lambda value, where: number_within(value, low, high, where)


def bounded(value: float, where: str) -> float:
    """`value` as a float, refused beyond 1e20 either way."""
    return number_within(value, -GREATEST, GREATEST, where)


def positive_bounded(value: float, where: str) -> float:
    """`value` as a float, refused when it is not greater than zero, or beyond 1e20."""
    return number_within(positive_number(value, where), 0.0, GREATEST, where)


def from_zero(value: float, where: str) -> float:
    """`value` as a float, refused below zero and beyond 1e20."""
    number = bounded(value, where)
    if number < 0:
        raise ProblemError(f"{where} is {number:.15g}; it must be a number from zero")
    return number


def pair(values: Sequence[float], where: str) -> tuple[float, ...]:
    """Two floats, neither beyond 1e20."""
    try:
        given = list(values)
    except TypeError:
        raise wrong_value(where, values, "2 numbers") from None
    if len(given) != 2:
        raise ProblemError(f"{where} has {counted(len(given), 'entry')}; it must have 2 numbers")
    return tuple(bounded(value, f"{where}[{index}]") for index, value in enumerate(given))


def one_or_each(
    value: float | Sequence[float],
    owners: Sequence[str],
    where: str,
    least: float = LEAST,
    greatest: float = GREATEST,
) -> float | tuple[float, ...]:
    """A number greater than zero, between limits; or a tuple with one for each of its owners."""
    if isinstance(value, (str, bytes)):
        raise wrong_value(where, value, "a number")
    if not isinstance(value, Iterable):
        return size_number(value, where, least, greatest)
    numbers = list(value)
    if len(numbers) != len(owners):
        wanted = f"it must be a number, or {len(owners)} ({', '.join(owners)})"
        raise ProblemError(f"{where} has {counted(len(numbers), 'entry')}; {wanted}")
    return tuple(
        size_number(each, f"{where}[{index}]", least, greatest) for index, each in enumerate(numbers)
    )


def size_number(value: float, where: str, least: float = LEAST, greatest: float = GREATEST) -> float:
    """`value` as a float, refused where it is not greater than zero or beyond limits."""
    return number_within(positive_number(value, where), least, greatest, where)


def true_or_false(value: bool, where: str) -> bool:
    """`value` as a bool, refused when it is not one."""
    if not isinstance(value, (bool, np.bool_)):
        raise wrong_value(where, value, "true or false")
    return bool(value)


def task_size(points: FloatArray, where: str) -> float:
    """Greatest distance between two of N points (N, 2), refused where it is so small that digits are lost."""
    size = span(points)
    if 0 < size < LEAST:
        raise ProblemError(f"{where} are at most {size:g} apart; two must be at least {LEAST:g} apart")
    return size


def whole_number(value: int, low: int, where: str, most: int | None = None) -> int:
    """`value` as an int; refused when out of bounds, not whole, or of more digits than floats have."""
    wanted = f"a whole number from {low}{'' if most is None else f' to {most}'}"
    if isinstance(value, bool) or not isinstance(value, (int, np.integer)) or value < low:
        raise wrong_value(where, value, wanted)
    if most is not None and value > most:
        raise wrong_value(where, value, wanted)
    if int(value) >= 10**DIGITS:  # of a hexadecimal one Python does not even write thousands
        raise wrong_value(where, value, f"a whole number from {low}, of up to {DIGITS} digits")
    return int(value)


def limits(values: Limits, where: str, *, least: float = -np.inf, most: float = GREATEST) -> Limits:
    """A pair (lo, hi) with least <= lo <= hi <= most."""
    try:
        low, high = values
    except (TypeError, ValueError):
        raise wrong_value(where, values, "[lo, hi]") from None
    low, high = finite_number(low, f"{where}[0]"), finite_number(high, f"{where}[1]")
    given = f"{where} is [{low:.15g}, {high:.15g}]"
    if low > high:
        raise ProblemError(f"{given}: lo exceeds hi; it must be [lo, hi] with lo <= hi")
    if high > most:
        raise ProblemError(f"{given}; hi must be at most {most:g}")
    if low < least:
        raise ProblemError(f"{given}; lo must be at least {least:g}")
    return low, high


def apart(
    values: Limits, where: str, narrowest: float, *, least: float = -np.inf, most: float = GREATEST
) -> Limits:
    """Limits likewise, refused where they are closer to each other than `narrowest`."""
    low, high = limits(values, where, least=least, most=most)
    if high - low < narrowest:
        raise wrong_value(where, [low, high], f"[lo, hi] at least {narrowest:g} apart")
    return low, high


def rising_rows(
    values: object, columns: int, means: str, rising: Sequence[str], *, least: str = "two", turn: bool = False
) -> Rows:
    """Checked rows, described by `means`, of that many columns; the first, in `rising`, have to rise.

    Of a `turn` the first is an angle (deg), which has to cover a turn, and the last row ends as the first.
    """
    table = finite_rows(values, columns, "values", means, GREATEST)  # type: ignore[arg-type]
    if len(table) < {"two": 2, "three": 3}[least]:
        raise ProblemError(f"values has {len(table)} rows; it must have {least} or more")
    for column, name in enumerate(rising):
        for row in np.flatnonzero(~(np.diff(table[:, column]) > 0)) + 1:
            given = f"values[{row}] has {name} {table[row, column]:.15g}"
            raise ProblemError(f"{given}; it must rise from row to row")
    first, last = table[0, 0], table[-1, 0]
    if turn and abs(last - first - 360) > 1e-9:
        raise ProblemError(
            f"values cover {rising[0]} {first:.15g} to {last:.15g} deg; they must cover a turn, as 0 to 360"
        )
    if turn and (table[0, 1:] != table[-1, 1:]).any():
        raise ProblemError("values end otherwise than they begin; a turn ends as it begins")
    return tuple(tuple(row) for row in table.tolist())


def one_of(word: object, where: str, words: Iterable[str]) -> str:
    """`word`, refused when it is not one of `words`."""
    if word not in list(words):  # it may be unhashable
        raise wrong_value(where, word, f"one of {', '.join(words)}")
    return str(word)


def some_of(given: Iterable[str], where: str, words: Iterable[str], wanted: str) -> tuple[str, ...]:
    """Some of `words`, each once, refused when they are others or none; `wanted` describes the list."""
    if isinstance(given, str) or not isinstance(given, Iterable) or not (listed := list(given)):
        raise wrong_value(where, given, wanted)
    return tuple(dict.fromkeys(one_of(word, f"{where}[{index}]", words) for index, word in enumerate(listed)))


def _plain(row: object) -> str:
    return shown(row.tolist() if isinstance(row, np.ndarray) else row)
