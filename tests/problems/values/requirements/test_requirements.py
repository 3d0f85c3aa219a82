"""Requirements and boxes."""

import dataclasses
import math
import pickle
from typing import Any

import numpy as np
import pytest
from refusals import refusal

from grashof.problems import Box, Requirements, Rotatability, TransmissionOver


def test_resolved_fills_in_what_depends_on_the_size() -> None:
    resolved = Requirements().resolved(5.0)
    assert resolved.link_length == (0.05, 100.0)
    assert resolved.coupler_arms == (0.0, 150.0)
    assert (resolved.link_ratio_max, resolved.tolerance, resolved.transmission_min_deg) == (20.0, 1e-6, 0.0)
    assert resolved.o2 == resolved.o4 == resolved.a == resolved.b == Box()
    assert "o2" not in Requirements(o2=Box()).resolved(2.0).limited


def test_resolved_keeps_what_is_given() -> None:
    given = Requirements(
        link_length=(0.3, 8), coupler_arms=(0, 0), o2=Box((0, 1), (2, 3)), theta2_start_deg=30, order=False
    )
    resolved = given.resolved(5.0)
    assert resolved.link_length == (0.3, 8.0)
    assert resolved.coupler_arms == (0.0, 0.0)
    assert resolved.o2 == Box((0, 1), (2, 3))
    assert resolved.theta2_start_deg == 30
    assert not resolved.order
    assert resolved.resolved(7.0) == resolved


def test_single_link_lengths_override_the_common_one() -> None:
    requirements = Requirements(link_length=(0.3, 8), r2=(1, 2), r4=(3, 3))
    assert requirements.link_lengths == ((0.3, 8.0), (1.0, 2.0), (0.3, 8.0), (3.0, 3.0))
    assert Requirements().link_lengths == ((0.0, math.inf),) * 4


def test_words_and_members_are_the_same() -> None:
    assert Requirements(rotatability="any").rotatability is Rotatability.ANY  # type: ignore[arg-type]
    assert Requirements(transmission_over=TransmissionOver.CYCLE).transmission_over == "cycle"


SIDES: list[Any] = [(2, 1), (math.nan, 1), (math.inf, math.inf), (1,), "ab"]
SHOWN = ["[2, 1]", "[nan, 1]", "[inf, inf]", "(1,)", "'ab'"]
BAD: list[tuple[type, dict[str, Any], str]] = [
    (
        Requirements,
        {"transmission_over": "turn"},
        "transmission_over is 'turn'; it must be one of task, cycle",
    ),
    (Requirements, {"rotatability_margin": 0.3}, "rotatability_margin is 0.3; it must be from 0 to 0.25"),
    (Requirements, {"link_ratio_max": 0.5}, "link_ratio_max is 0.5; it must be from 1 to 1e+06"),
    (Requirements, {"r3": (-1, 2)}, "r3 is [-1, 2]; lo must be at least 0"),
    (Requirements, {"o4": (0, 0)}, "o4 is (0, 0); it must be a Box or a Region"),
    *(
        (Box, {axis: side}, f"{axis} is {shown}; it must be [lo, hi] with lo <= hi")
        for axis in ("x", "y")
        for side, shown in zip(SIDES, SHOWN, strict=True)
    ),
]


@pytest.mark.parametrize(("make", "given", "said"), BAD)
def test_bad_values_are_named(make: type, given: dict[str, Any], said: str) -> None:
    assert refusal(make, **given).removeprefix("requirements.") == said


def test_numbers_are_kept_as_floats() -> None:
    requirements = Requirements(link_length=(1, 2), ground_angle_deg=30, transmission_min_deg=15)
    assert repr(requirements.link_length) == "(1.0, 2.0)"
    assert repr(requirements.ground_angle_deg) == "30.0"
    assert repr(requirements.transmission_min_deg) == "15.0"


def test_a_box_is_open_by_default() -> None:
    assert Box(x=(0, 1)) == Box((0.0, 1.0), (-math.inf, math.inf))
    assert Box(y=(-math.inf, 3)).y == (-math.inf, 3.0)
    assert Box((2, 2), (3, 3)).x == (2.0, 2.0)


def test_requirements_with_areas_are_values_too() -> None:
    corners = np.array([[0.0, 0.0], [4.0, 0.0], [4.0, 3.0]])
    requirements = Requirements(keep_out=(corners,), keep_out_for=("a", "o2", "a"))
    assert requirements == Requirements(keep_out=[corners.tolist()], keep_out_for=["a", "o2"])  # type: ignore[arg-type]
    assert hash(requirements) == hash(dataclasses.replace(requirements))
    assert requirements != Requirements(keep_out=(corners + 1,), keep_out_for=("a", "o2"))
    assert requirements != Requirements(keep_out=(corners,))
    assert requirements != "requirements"
    assert pickle.loads(pickle.dumps(requirements)) == requirements
    with pytest.raises(dataclasses.FrozenInstanceError):
        requirements.order = False  # type: ignore[misc]
