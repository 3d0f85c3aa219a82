"""Dynamics that do not go with a kind of linkage are refused, a clear line each."""

import pytest

from grashof.problems import (
    DynamicsSpec,
    FourBar,
    InvertedSliderCrank,
    LinkageSpec,
    PathTask,
    Problem,
    ProblemError,
    SliderCrank,
)
from grashof.problems.values.dynamics.acting import FrictionSpec, LoadSpec, TorsionSpringSpec
from grashof.problems.values.linkages.linkage import Linkage

LINKAGES: dict[str, Linkage] = {
    "four-bar": FourBar((0, 0), (4, 0), 1, 4, 3),
    "slider-crank": SliderCrank((0, 0), 1, 3),
    "inverted-slider-crank": InvertedSliderCrank((0, 0), (0, -2), 1),
}
TRAVEL = DynamicsSpec(loads=(LoadSpec(4, values=((0, 1, 0), (5, 2, 0)), over="travel"),))
OUTPUT = DynamicsSpec(loads=(LoadSpec(4, values=((0, 1), (180, 2), (360, 1)), over="theta4"),))
AT_B, AT_O4 = (DynamicsSpec(torsion_springs=(TorsionSpringSpec(at, 1.0),)) for at in ((3, 4), (1, 4)))
SLIDE = DynamicsSpec(friction=FrictionSpec(slide_mu=0.1, slide_length=0.2))
IN_B, IN_O4 = (DynamicsSpec(friction=FrictionSpec(viscous=each)) for each in ((0, 0, 2, 0), (0, 0, 0, 2)))
REFUSED = [
    (TRAVEL, "four-bar", "loads[0].over is 'travel'; a four-bar has no slide"),
    (OUTPUT, "slider-crank", "loads[0].over is 'theta4'; the slider of a slider-crank does not turn"),
    (AT_O4, "slider-crank", "torsion_springs[0].between is [1, 4]; a slider-crank has a slide there"),
    (AT_B, "inverted-slider-crank", "torsion_springs[0].between is [3, 4]; an inverted"),
    (SLIDE, "four-bar", "friction.slide_mu is 0.1; a four-bar has no slide"),
    (IN_O4, "slider-crank", "friction.viscous[3] is 2, in O4; a slider-crank has a slide there"),
    (IN_B, "inverted-slider-crank", "friction.viscous[2] is 2, in B; an inverted"),
]


@pytest.mark.parametrize(("spec", "kind", "line"), REFUSED)
def test_what_a_kind_has_not_is_refused_in_one_line(spec: DynamicsSpec, kind: str, line: str) -> None:
    with pytest.raises(ProblemError) as told:
        LinkageSpec(LINKAGES[kind], "mine", length_unit="m", dynamics=spec)
    assert str(told.value).splitlines()[0].startswith(line.replace("an inverted", "an inverted"))
    with pytest.raises(ProblemError) as told:
        Problem(task=PathTask([[0, 0], [1, 0], [2, 1]]), length_unit="m", dynamics=spec, mechanism=kind)
    assert line.replace("an inverted", "an inverted") in str(told.value)


@pytest.mark.parametrize(
    ("spec", "kinds"),
    [
        (TRAVEL, ("slider-crank", "inverted-slider-crank")),
        (OUTPUT, ("four-bar", "inverted-slider-crank")),
        (AT_O4, ("four-bar", "inverted-slider-crank")),
        (AT_B, ("four-bar", "slider-crank")),
        (SLIDE, ("slider-crank", "inverted-slider-crank")),
        (IN_B, ("four-bar", "slider-crank")),
    ],
)
def test_what_a_kind_has_is_taken(spec: DynamicsSpec, kinds: tuple[str, ...]) -> None:
    for kind in kinds:
        assert LinkageSpec(LINKAGES[kind], "mine", length_unit="m", dynamics=spec).dynamics == spec


def test_a_guide_length_needs_a_coefficient() -> None:
    with pytest.raises(ProblemError, match=r"^slide_mu is missing; slide_length is of no use without it$"):
        FrictionSpec(slide_length=0.1)
    with pytest.raises(ProblemError, match=r"^slide_mu is -0.1; it must be"):
        FrictionSpec(slide_mu=-0.1)
