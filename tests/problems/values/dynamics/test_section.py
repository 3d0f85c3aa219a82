"""Cross-sections: what they come to, and what is refused."""

import math
import pickle
from typing import Any

import pytest
from refusals import refusal

from grashof.problems import CrossSection, SectionSpec


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


@pytest.mark.parametrize(
    "spec",
    [
        SectionSpec(0.2, 0.1),
        SectionSpec(width=(0.2, 0.1, 0.3), height=1),
        SectionSpec(area=3, inertia=[1, 2, 3], extreme_fibre=1.0, inertia_across=4),
    ],
)
def test_what_is_stated_gives_the_same_again(spec: SectionSpec) -> None:
    assert SectionSpec(**spec.stated) == spec == pickle.loads(pickle.dumps(spec))
    assert None not in spec.stated.values()
    hash(spec)


SHAPES = "width and height, or area, inertia and extreme_fibre"
MORE = "it must be a number greater than zero"
TOGETHER = "area, inertia and extreme_fibre are needed together"
BAD: list[tuple[dict[str, Any], str]] = [
    ({}, f"section is empty; it must have {SHAPES}"),
    ({"width": 0, "height": 1}, f"section.width is 0; {MORE}"),
    ({"width": 1, "height": -1}, f"section.height is -1; {MORE}"),
    ({"width": [1, 0, 1], "height": 1}, f"section.width[1] is 0; {MORE}"),
    ({"width": math.nan, "height": 1}, "section.width is nan; it must be a finite number"),
    ({"width": 1e21, "height": 1}, "section.width is 1e+21; it must be from 1e-20 to 1e+20"),
    ({"width": 1e-300, "height": 1}, "section.width is 1e-300; it must be from 1e-20 to 1e+20"),
    ({"width": "2", "height": 1}, "section.width is '2'; it must be a number"),
    ({"width": True, "height": 1}, "section.width is True; it must be a finite number"),
    (
        {"width": [1, 2], "height": 1},
        "section.width has 2 entries; it must be a number, or 3 (link 2, link 3, link 4)",
    ),
    ({"width": [[1], 2, 3], "height": 1}, "section.width[0] is [1]; it must be a finite number"),
    ({"width": 1}, "section.height is missing; width and height are needed together"),
    ({"height": 1}, "section.width is missing; width and height are needed together"),
    ({"area": 1}, f"section.inertia is missing; {TOGETHER}"),
    ({"shear_factor": 2}, f"section.area is missing; {TOGETHER}"),
    (
        {"width": 1, "height": 1, "area": 1},
        "section.area does not go with width; give one shape or the other",
    ),
    (
        {"area": 1, "inertia": [1, 9, 1], "extreme_fibre": 2},
        "section.inertia[1] is 9; it must be at most area times extreme_fibre squared, 4",
    ),
    (
        {"area": 1, "inertia": 1, "extreme_fibre": 2, "shear_factor": 0.9},
        "section.shear_factor is 0.9; it must be from 1 to 1e+20",
    ),
    (
        {"area": 1e50, "inertia": 1, "extreme_fibre": 2},
        "section.area is 1e+50; it must be from 1e-40 to 1e+40",
    ),
]


@pytest.mark.parametrize(("given", "expected"), BAD)
def test_bad_sections(given: dict[str, Any], expected: str) -> None:
    assert refusal(SectionSpec, **given) == expected
