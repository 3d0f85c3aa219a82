"""Cross-sections, strengths and pumping units: defaults and errors."""

import pickle
import tomllib
from typing import Any

import pytest
from refusals import refusal, rows

from grashof.problems import CrossSection, ProblemError, SectionSpec, StrengthSpec
from grashof.problems.values.dynamics.pumping_unit import PumpingUnitSpec
from grashof.problems.values.dynamics.strength import check_strength

RECTANGLE = SectionSpec(0.2, 0.1)
TUBE = SectionSpec(area=3, inertia=2, extreme_fibre=1)


def test_a_rectangle_is_wide_in_the_plane_of_motion() -> None:
    section = SectionSpec(width=0.3, height=0.1).of(3)
    assert section.area == pytest.approx(0.03)
    assert section.inertia == pytest.approx(0.1 * 0.3**3 / 12)
    assert section.inertia_across == pytest.approx(0.3 * 0.1**3 / 12)
    assert (section.extreme_fibre, section.shear_factor, section.height) == (0.15, 1.5, 0.1)


def test_links_may_differ() -> None:
    spec = SectionSpec(width=[1, 2, 3], height=2)
    assert [spec.of(link).area for link in (2, 3, 4)] == [2, 4, 6]
    tube = SectionSpec(area=[3, 4, 5], inertia=2, extreme_fibre=1, shear_factor=[2, 2, 1.5])
    assert tube.of(4) == CrossSection(5, 2, 1, 1.5)
    assert SectionSpec(area=3, inertia=2, extreme_fibre=1).of(2).shear_factor == 2
    assert SectionSpec(area=3, inertia=2, extreme_fibre=1, inertia_across=7).of(2).inertia_across == 7


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
        SectionSpec(0.2, 0.1),
        SectionSpec(width=(0.2, 0.1, 0.3), height=1),
        SectionSpec(area=3, inertia=[1, 2, 3], extreme_fibre=1.0, inertia_across=4),
        StrengthSpec(235e6),
        StrengthSpec(235e6, 210e9, pin_diameter=[1, 2, 3, 4], pin_thickness=2, double_shear=True),
        PumpingUnitSpec(well="left", rating=1e5, values=[[0, 9e3], [360, 9e3]]),
    ],
)
def test_stated_keys_give_the_same_value(spec: SectionSpec | StrengthSpec | PumpingUnitSpec) -> None:
    assert type(spec)(**spec.stated) == spec == pickle.loads(pickle.dumps(spec))
    assert None not in spec.stated.values()
    hash(spec)


def test_a_unit_on_the_left_turns_clockwise() -> None:
    unit = PumpingUnitSpec(well="left")
    assert (unit.side, unit.sense) == (-1, 1)


TEXTS = {
    "MORE": "it must be a number greater than zero",
    "TOGETHER": "area, inertia and extreme_fibre are needed together",
}
BAD_SECTIONS = r"""
# | section is empty; it must have width and height, or area, inertia and extreme_fibre
width = 0\nheight = 1 | section.width is 0; <MORE>
width = [1, 0, 1]\nheight = 1 | section.width[1] is 0; <MORE>
width = nan\nheight = 1 | section.width is nan; it must be a finite number
width = 1e-300\nheight = 1 | section.width is 1e-300; it must be from 1e-20 to 1e+20
width = '2'\nheight = 1 | section.width is '2'; it must be a number
width = true\nheight = 1 | section.width is True; it must be a finite number
width = [1, 2]\nheight = 1 | section.width has 2 entries; it must be a number, or 3 (link 2, link 3, link 4)
width = 1 | section.height is missing; width and height are needed together
area = 1 | section.inertia is missing; <TOGETHER>
shear_factor = 2 | section.area is missing; <TOGETHER>
width = 1\nheight = 1\narea = 1 | section.area does not go with width; give one shape or the other
area = 1\ninertia = [1, 9, 1]\nextreme_fibre = 2 |
    section.inertia[1] is 9; it must be at most area times extreme_fibre squared, 4
area = 1\ninertia = 1\nextreme_fibre = 2\nshear_factor = 0.9 |
    section.shear_factor is 0.9; it must be from 1 to 1e+20
area = 1e+50\ninertia = 1\nextreme_fibre = 2 | section.area is 1e+50; it must be from 1e-40 to 1e+40
"""
BAD_STRENGTHS = r"""
yield_stress = 0 | strength.yield_stress is 0; <MORE>
yield_stress = 1\nelastic_modulus = -2 | strength.elastic_modulus is -2; <MORE>
yield_stress = 1\npin_diameter = [1, 1, 0, 1] | strength.pin_diameter[2] is 0; <MORE>
yield_stress = 1\npin_diameter = [1, 2, 3] |
    strength.pin_diameter has 3 entries; it must be a number, or 4 (O2, A, B, O4)
yield_stress = 1\npin_thickness = 1 | strength.pin_diameter is missing; pin_thickness is of no use without it
yield_stress = 1\ndouble_shear = true | strength.pin_diameter is missing; double_shear is of no use without it
yield_stress = 1\ndouble_shear = 2 | strength.double_shear is 2; it must be true or false
"""
TURNING = "values = [[0, 9e3], [180, 2e4], [360, 9e3]]\n"
BAD_UNITS = r"""
well = 'north' | well is 'north'; it must be one of right, left
crank = 'left' | crank is 'left'; it must be one of clockwise, counter-clockwise
counterbalance = nan | counterbalance is nan; it must be a finite number
rating = 0.0 | rating is 0; <MORE>
rod_load = 1e21 | rod_load is 1e+21; it must be from -1e+20 to 1e+20
over = "position" | over does not go with a constant load; it needs values
<TURNING>rod_load = 1.0 | rod_load is given besides values; give one of them
values = [[0, 1], [90, 1], [80, 2], [360, 1]] | values[2] has crank 80; it must rise from row to row
values = [[0, 1, 2], [2, 1, 2]]\nover = "position" | values cover positions 0 to 2; they must cover 0 to 1
<TURNING>over = "theta2" | over is 'theta2'; it must be one of crank, position
"""
BAD = [(SectionSpec, *row) for row in rows(BAD_SECTIONS, **TEXTS)]
BAD += [(StrengthSpec, *row) for row in rows(BAD_STRENGTHS, **TEXTS)]
BAD += [(PumpingUnitSpec, *row) for row in rows(BAD_UNITS, **TEXTS, TURNING=TURNING)]


@pytest.mark.parametrize(("spec", "given", "expected"), BAD)
def test_bad_sections_strengths_and_units(spec: Any, given: str, expected: str) -> None:
    assert refusal(spec, **tomllib.loads(given)) == expected


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
