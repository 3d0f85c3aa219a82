"""Checks of numbers at the boundary."""

from typing import Any

import numpy as np
import pytest

from grashof.problems import ProblemError
from grashof.problems.values import checks
from grashof.problems.values.arrays import frozen_array


def test_frozen_array_is_a_read_only_copy() -> None:
    given_array = np.array([1, 2])
    frozen = frozen_array(given_array)
    given_array[0] = 7
    assert frozen.tolist() == [1.0, 2.0]
    with pytest.raises(ValueError, match="read-only"):
        frozen[0] = 3.0
    assert hash(frozen_array(3)) == hash(3.0)


def test_finite_rows_keeps_the_rows() -> None:
    mixed: Any = [(1, 2), np.array([3.0, 4.0])]
    rows = checks.finite_rows(mixed, 2, "here", "a point")
    assert rows.tolist() == [[1, 2], [3, 4]]
    assert checks.finite_rows([], 3, "here", "a point").shape == (0, 3)


@pytest.mark.parametrize(
    ("rows", "message"),
    [
        (5, "here is 5; it must be a list, each entry a point"),
        ([[1, 2], [3]], r"here\[1\] is \[3\], 1 number; it must be a point"),
        ([[1, 2, 3]], r"here\[0\] is \[1, 2, 3\], 3 numbers; it must be a point"),
        ([[[1, 2], [3]]], r"here\[0\] is \[\[1, 2\], \[3\]\]; it must be a point"),
        ([[1, "2"]], r"here\[0\] is \[1, '2'\]; it must be a point"),
        ([[True, False]], r"here\[0\] is \[True, False\]; it must be a point"),
        ([[1, 2], [np.nan, 0]], r"here\[1\] is \[nan, 0\]; all numbers must be finite"),
        (np.array([[1, np.inf]]), r"here\[0\] is \[1.0, inf\]; all numbers must be finite"),
    ],
)
def test_finite_rows_names_the_row(rows: Any, message: str) -> None:
    with pytest.raises(ProblemError, match=rf"^{message}"):
        checks.finite_rows(rows, 2, "here", "a point")


@pytest.mark.parametrize("value", [3, np.float64(3), np.int64(3)])
def test_finite_number_takes_every_kind_of_number(value: float) -> None:
    assert checks.finite_number(value, "here") == checks.positive_number(value, "here") == 3.0


def from_one(value: Any, name: str) -> int:
    return checks.whole_number(value, 1, name)


FINITE = [True, np.True_, "3", b"3", None, [3], 3j, np.nan, -np.inf, 10**400]
POSITIVE, WHOLE = [0, -1.5, float("nan")], [0, -1, 1.0, True, "1", None]
REFUSED: list[tuple[Any, Any, str]] = [
    *((checks.finite_number, value, "a finite number") for value in FINITE),
    *((checks.positive_number, value, "a (number greater than zero|finite number)") for value in POSITIVE),
    *((from_one, value, "a whole number from 1") for value in WHOLE),
]


@pytest.mark.parametrize(("check", "value", "expected"), REFUSED)
def test_bad_numbers_are_refused(check: Any, value: Any, expected: str) -> None:
    with pytest.raises(ProblemError, match=rf"^here is .*; it must be {expected}$"):
        check(value, "here")


def test_number_within_includes_its_ends() -> None:
    assert checks.number_within(0, 0, 90, "here") == 0
    assert checks.number_within(90, 0, 90, "here") == 90
    with pytest.raises(ProblemError, match=r"^here is 90.000000001; it must be from 0 to 90$"):
        checks.number_within(90.000000001, 0, 90, "here")


@pytest.mark.parametrize(
    ("pair", "message"),
    [
        ((1,), r"here is \(1,\); it must be \[lo, hi\]"),
        ((1, 2, 3), r"here is \(1, 2, 3\); it must be \[lo, hi\]"),
        (5, r"here is 5; it must be \[lo, hi\]"),
        ((1, np.inf), r"here\[1\] is inf; it must be a finite number"),
        (("a", 1), r"here\[0\] is 'a'; it must be a finite number"),
        ((2, 1), r"here is \[2, 1\]: lo exceeds hi; it must be \[lo, hi\] with lo <= hi"),
        ((-1, 1), r"here is \[-1, 1\]; lo must be at least 0"),
    ],
)
def test_bad_limits_are_named(pair: tuple[float, float], message: str) -> None:
    with pytest.raises(ProblemError, match=rf"^{message}$"):
        checks.limits(pair, "here", least=0.0)
