"""Dynamics that do not go with a kind of linkage are refused, a clear line each."""

from typing import Any

import pytest
from linkages_of_rows import linkage_of_row, row_name
from refusals import refusal, rows

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
from grashof.problems.values.dynamics import load_specs
from grashof.problems.values.dynamics.strength import SectionSpec, StrengthSpec
from grashof.problems.values.linkages.linkage import Linkage
from grashof.problems.values.linkages.mechanism import MECHANISMS, Mechanism
from grashof.problems.values.specs.dynamics_of_kind import misplaced

LINKAGES: dict[str, Linkage] = {
    "four-bar": FourBar((0, 0), (4, 0), 1, 4, 3),
    "slider-crank": SliderCrank((0, 0), 1, 3),
    "inverted-slider-crank": InvertedSliderCrank((0, 0), (0, -2), 1),
}
TRAVEL = DynamicsSpec(loads=(load_specs.LoadSpec(4, values=((0, 1, 0), (5, 2, 0)), over="travel"),))
OUTPUT = DynamicsSpec(loads=(load_specs.LoadSpec(4, values=((0, 1), (180, 2), (360, 1)), over="theta4"),))
AT_B, AT_O4 = (
    DynamicsSpec(torsion_springs=(load_specs.TorsionSpringSpec(at, 1.0),)) for at in ((3, 4), (1, 4))
)
SLIDE = DynamicsSpec(friction=load_specs.FrictionSpec(slide_mu=0.1, slide_length=0.2))
IN_B, IN_O4 = (
    DynamicsSpec(friction=load_specs.FrictionSpec(viscous=each)) for each in ((0, 0, 2, 0), (0, 0, 0, 2))
)
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
def test_dynamics_of_other_kinds_are_refused_in_one_line(spec: DynamicsSpec, kind: str, line: str) -> None:
    said = refusal(LinkageSpec, LINKAGES[kind], "mine", length_unit="m", dynamics=spec)
    assert said.splitlines()[0].startswith(line)
    task = PathTask([[0, 0], [1, 0], [2, 1]])
    assert line in refusal(Problem, task=task, length_unit="m", dynamics=spec, mechanism=kind)


def test_a_guide_length_needs_a_coefficient() -> None:
    with pytest.raises(ProblemError, match=r"^slide_mu is missing; slide_length is of no use without it$"):
        load_specs.FrictionSpec(slide_length=0.1)
    with pytest.raises(ProblemError, match=r"^slide_mu is -0.1; it must be"):
        load_specs.FrictionSpec(slide_mu=-0.1)


WIDTHS = SectionSpec(width=[1, 2, 3], height=1)
PINS = StrengthSpec(1e8, pin_diameter=[1, 1, 1, 2])


def everywhere(row: Mechanism, more: int = 0) -> DynamicsSpec:
    """Something of each sort on each link and in each joint, and on `more` further links."""
    moving = range(2, len(row.links) + 1 + more)
    ends = [(load_specs.Place(1), load_specs.Place(link, (0.1, 0.2))) for link in moving]
    fixed = [f"theta{second}" for first, second in row.slides if first == 1]
    angles = [word for word in ("theta2", "theta4", "theta6")[: len(row.dyads) + 1] if word not in fixed]
    each = tuple(0.0 if joint.slides else 1.0 + i for i, joint in enumerate(row.every_joint))
    one_loop = len(row.dyads) == 1  # six-bars take no lists of sections and pins
    return DynamicsSpec(
        masses=tuple(1.0 + link for link in moving),
        inertias=tuple(1.0 + link for link in moving),
        centres=tuple((link, 0.5) for link in moving),
        loads=(
            *(load_specs.LoadSpec(link, force=(0, 1)) for link in moving),
            *(load_specs.LoadSpec(4, values=((0, 1), (360, 1)), over=over) for over in angles),
            *(load_specs.LoadSpec(2, values=((0, 1), (9, 1)), over="travel") for _ in row.slides),
        ),
        springs=tuple(load_specs.SpringSpec(both, 1.0) for both in ends),
        dampers=tuple(load_specs.DamperSpec(both, 1.0) for both in ends),
        counterweights=tuple(load_specs.CounterweightSpec(link, 1.0, (0, 0)) for link in moving),
        torsion_springs=tuple(
            load_specs.TorsionSpringSpec(joint.links, 1.0) for joint in row.every_joint if not joint.slides
        ),
        friction=load_specs.FrictionSpec(0.1, each, each, 0.2, slide_mu=0.1 if row.slides else 0.0),
        section=WIDTHS if one_loop else None,
        strength=PINS if one_loop else None,
    )  # fmt: skip


@pytest.mark.parametrize("row", MECHANISMS, ids=row_name)
def test_every_link_and_joint_that_a_linkage_has_takes_everything(row: Mechanism) -> None:
    spec = everywhere(row)
    assert LinkageSpec(linkage_of_row(row), "mine", length_unit="m", dynamics=spec).dynamics == spec
    allowed = "2, 3 or 4" if len(row.dyads) == 1 else "2, 3, 4, 5 or 6"
    number, count = len(row.links) + 1, len(row.links) - 1
    masses, inertias, centres, *others = misplaced(everywhere(row, more=1), row)
    assert centres.startswith("dynamics.centres is ")
    assert [masses, inertias, *others] == [
        f"dynamics.masses has {count + 1} entries; it must have {count} numbers",
        f"dynamics.inertias has {count + 1} entries; it must have {count} numbers",
        f"loads[{count}].link is {number}; it must be {allowed}",
        f"counterweights[{count}].link is {number}; it must be {allowed}",
        f"springs[{count}].between[1].link is {number}; it must be 1, {allowed}",
        f"dampers[{count}].between[1].link is {number}; it must be 1, {allowed}",
    ]


LEG = next(row for row in MECHANISMS if row.word == "stephenson-3")
PRESS = next(row for row in MECHANISMS if row.word == "stephenson-3" and row.slides)
JOINTS = "[1, 2], [2, 3], [3, 4], [1, 4], [3, 5], [5, 6] or [1, 6]"
ROWS = ((0, 1), (360, 1))


def load(link: int, over: str) -> DynamicsSpec:
    return DynamicsSpec(loads=(load_specs.LoadSpec(link, values=ROWS, over=over),))


def torsion(*between: int) -> DynamicsSpec:
    return DynamicsSpec(torsion_springs=(load_specs.TorsionSpringSpec(between, 1.0),))  # type: ignore[arg-type]


VISCOUS = DynamicsSpec(friction=load_specs.FrictionSpec(viscous=(1, 2, 3, 4)))
MOMENT = DynamicsSpec(friction=load_specs.FrictionSpec(moment=(0, 0, 0, 0, 0, 0, 3)))
CENTRES = DynamicsSpec(masses=(1, 2, 3), inertias=(1, 2, 3), centres=((1, 2), (3, 4)))
SPECS = {
    "viscous": (LEG, VISCOUS),
    "between 4 and 5": (LEG, torsion(4, 5)),
    "travel": (LEG, load(4, "travel")),
    "theta5": (LEG, load(4, "theta5")),
    "theta6 of a slider": (PRESS, load(6, "theta6")),
    "spring at a slide": (PRESS, torsion(6, 1)),
    "moment at a slide": (PRESS, MOMENT),
    "widths": (LEG, DynamicsSpec(section=WIDTHS)),
    "pins": (LEG, DynamicsSpec(section=SectionSpec(1, 1), strength=PINS)),
    "theta6 of a four-bar": (MECHANISMS[0], load(4, "theta6")),
    "between 3 and 5": (MECHANISMS[0], torsion(3, 5)),
    "centres": (MECHANISMS[0], CENTRES),
}
MISPLACED = """
viscous | friction.viscous is [1.0, 2.0, 3.0, 4.0]; it must be a number, or seven: in O2, A, B, O4, C, E, D
between 4 and 5 | torsion_springs[0].between is [4, 5]; it must be two links of a joint: <JOINTS>
travel | loads[0].over is 'travel'; a stephenson-3 has no slide, so it must be theta2, theta4, theta6 or time
theta5 | loads[0].over is 'theta5'; it must be theta2, theta4, theta6, travel or time
theta6 of a slider | loads[0].over is 'theta6';
    the slider of a stephenson-3 does not turn, so it must be theta2, theta4, travel or time
spring at a slide |
    torsion_springs[0].between is [1, 6]; a stephenson-3 has a slide there, so it must be at a pin
moment at a slide |
    friction.moment[6] is 3, in D;
    a stephenson-3 has a slide there, so it must be 0 (slide_force is for slides)
widths | section.width has 3 entries; it must be a number with mechanism stephenson-3
pins | strength.pin_diameter has 4 entries; it must be a number with mechanism stephenson-3
theta6 of a four-bar | loads[0].over is 'theta6'; it must be theta2, theta4, travel or time
between 3 and 5 |
    torsion_springs[0].between is [3, 5]; it must be two links of a joint: [1, 2], [2, 3], [3, 4] or [1, 4]
centres | dynamics.centres is ((1, 2), (3, 4));
    it must be three places [u, v], of links 2, 3 and 4
"""


@pytest.mark.parametrize(("name", "line"), rows(MISPLACED, JOINTS=JOINTS))
def test_misplaced_dynamics_are_reported_in_one_line(name: str, line: str) -> None:
    kind, spec = SPECS[name]
    assert misplaced(spec, kind) == [line]


@pytest.mark.parametrize("link", ["2", None, True])
def test_a_link_is_a_whole_number(link: Any) -> None:
    for make in (
        lambda: load_specs.LoadSpec(link, moment=1.0),
        lambda: load_specs.Place(link),
        lambda: load_specs.CounterweightSpec(link, 1, (0, 0)),
    ):
        with pytest.raises(ProblemError, match=r"^link is .*; it must be the number of a link"):
            make()
