"""Strengths: defaults, and what is refused."""

import math
import pickle
from typing import Any

import pytest
from refusals import refusal

from grashof.problems import ProblemError, SectionSpec, StrengthSpec
from grashof.problems.values.dynamics.strength import check_strength

RECTANGLE = SectionSpec(0.2, 0.1)
TUBE = SectionSpec(area=3, inertia=2, extreme_fibre=1)


def test_pins_are_of_the_same_material_by_default() -> None:
    plain = StrengthSpec(300e6, pin_diameter=0.1)
    assert plain.shear_limit == pytest.approx(0.577 * 300e6, rel=1e-3)
    assert plain.bearing_limit == 300e6
    own = StrengthSpec(300e6, pin_diameter=0.1, pin_shear_strength=1e8, bearing_strength=2e8)
    assert (own.shear_limit, own.bearing_limit) == (1e8, 2e8)


def test_diameters_and_thicknesses() -> None:
    plain = StrengthSpec(300e6, pin_diameter=0.1)
    assert plain.diameters() == (0.1,) * 4
    assert StrengthSpec(300e6).diameters() is None
    assert StrengthSpec(300e6, pin_diameter=[1, 2, 3, 4]).diameters() == (1, 2, 3, 4)
    assert plain.thicknesses(RECTANGLE) == (0.1,) * 3
    assert plain.thicknesses(TUBE) == (None,) * 3
    assert StrengthSpec(3e8, pin_diameter=1, pin_thickness=[1, 2, 3]).thicknesses(RECTANGLE) == (1, 2, 3)


@pytest.mark.parametrize(
    "spec",
    [
        StrengthSpec(235e6),
        StrengthSpec(235e6, 210e9, pin_diameter=[1, 2, 3, 4], pin_thickness=2, double_shear=True),
    ],
)
def test_what_is_stated_gives_the_same_again(spec: StrengthSpec) -> None:
    assert StrengthSpec(**spec.stated) == spec == pickle.loads(pickle.dumps(spec))
    assert None not in spec.stated.values()
    hash(spec)


MORE = "it must be a number greater than zero"
BAD: list[tuple[dict[str, Any], str]] = [
    ({"yield_stress": 0}, f"strength.yield_stress is 0; {MORE}"),
    ({"yield_stress": math.inf}, "strength.yield_stress is inf; it must be a finite number"),
    ({"yield_stress": None}, "strength.yield_stress is None; it must be a finite number"),
    ({"yield_stress": 1, "elastic_modulus": -2}, f"strength.elastic_modulus is -2; {MORE}"),
    (
        {"yield_stress": 1, "elastic_modulus": 1e30},
        "strength.elastic_modulus is 1e+30; it must be from 1e-20 to 1e+20",
    ),
    ({"yield_stress": 1, "pin_diameter": 0}, f"strength.pin_diameter is 0; {MORE}"),
    ({"yield_stress": 1, "pin_diameter": [1, 1, 0, 1]}, f"strength.pin_diameter[2] is 0; {MORE}"),
    (
        {"yield_stress": 1, "pin_diameter": [1, 2, 3]},
        "strength.pin_diameter has 3 entries; it must be a number, or 4 (O2, A, B, O4)",
    ),
    (
        {"yield_stress": 1, "pin_thickness": 1},
        "strength.pin_diameter is missing; pin_thickness is of no use without it",
    ),
    (
        {"yield_stress": 1, "double_shear": True},
        "strength.pin_diameter is missing; double_shear is of no use without it",
    ),
    ({"yield_stress": 1, "double_shear": 2}, "strength.double_shear is 2; it must be true or false"),
]


@pytest.mark.parametrize(("given", "expected"), BAD)
def test_bad_strengths(given: dict[str, Any], expected: str) -> None:
    assert refusal(StrengthSpec, **given) == expected


def test_strength_needs_sections() -> None:
    check_strength(None, None)
    check_strength(TUBE, None)
    check_strength(TUBE, StrengthSpec(1.0))
    check_strength(RECTANGLE, StrengthSpec(1.0, pin_diameter=1))
    check_strength(TUBE, StrengthSpec(1.0, pin_diameter=1, pin_thickness=2))
    with pytest.raises(ProblemError, match=r"^section is missing, which strength needs; give width and"):
        check_strength(None, StrengthSpec(1.0))
    with pytest.raises(ProblemError, match=r"^strength.pin_thickness is missing; bearing pressure needs it"):
        check_strength(TUBE, StrengthSpec(1.0, pin_diameter=1))
