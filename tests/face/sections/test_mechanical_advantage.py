"""The section on mechanical advantage: its table, in every length unit and sense, and its toggles."""

from dataclasses import replace

import numpy as np
import pytest

from grashof.analysis import output_stroke
from grashof.problems import DynamicsSpec, FourBar, LinkageSpec, load_linkage_spec
from grashof.survey import Asked, Section, report_on

KEY = "mechanical-advantage"
JACK = load_linkage_spec("pumpjack")


def section(spec: LinkageSpec, asked: Asked | None = None, key: str = KEY) -> Section:
    return next(each for each in report_on(spec, asked).sections if each.key == key)


@pytest.mark.slow
def test_the_table_is_the_ratio_of_the_rates() -> None:
    found = section(JACK)
    table, motion = found.tables[KEY], report_on(JACK).tables["kinematics"]
    np.testing.assert_allclose(table["velocity_ratio"], motion["omega4"] / motion["omega2"], atol=1e-14)
    np.testing.assert_allclose(table["p_way"], motion["p_speed"] / motion["omega2"], rtol=1e-12)
    facts = {fact.key: fact.value for fact in found.facts}
    toggles = sorted(np.degrees(output_stroke(JACK.linkage).theta2))
    assert [facts[f"toggle_{n}_theta2_deg"] for n in (1, 2)] == pytest.approx(toggles, abs=1e-8)
    assert facts["velocity_ratio_largest"] >= table["velocity_ratio"].max()
    assert facts["mechanical_advantage_least"] <= table["torque_ratio"].abs().min()


@pytest.mark.slow
def test_what_holds_it_is_newtons_in_every_unit_and_follows_the_sense_of_p() -> None:
    assert JACK.dynamics is not None
    linkage, inch = JACK.linkage, 0.0254
    small = FourBar(
        linkage.o2 / inch, linkage.o4 / inch, linkage.r2 / inch, linkage.r3 / inch, linkage.r4 / inch,
        linkage.coupler_point / inch,
    )  # fmt: skip
    given = DynamicsSpec(300 * inch, payload=40, speed_rpm=-12, gravity=(0, -9.8))
    inches = section(LinkageSpec(small, "jack", length_unit="in", dynamics=given)).tables[KEY]
    metres = section(replace(JACK, dynamics=replace(given, mass_per_length=300))).tables[KEY]
    for name in ("holding_torque", "holding_moment_on_4", "holding_force_at_p", "holding_force_y"):
        np.testing.assert_allclose(inches[name], metres[name], rtol=1e-9, atol=1e-6)
    other = section(replace(JACK, dynamics=replace(given, mass_per_length=300, speed_rpm=12))).tables[KEY]
    np.testing.assert_allclose(other["holding_force_at_p"], -metres["holding_force_at_p"])
    np.testing.assert_allclose(other["holding_force_x"], metres["holding_force_x"])
    np.testing.assert_allclose(other["holding_torque"], metres["holding_torque"])


@pytest.mark.slow
def test_without_weight_there_is_nothing_to_hold() -> None:
    floating = replace(JACK, dynamics=DynamicsSpec(300))
    for spec in (load_linkage_spec("lufkin-c912d"), floating):
        assert "holding_torque" not in section(spec).tables[KEY]


@pytest.mark.quick("linkage1")
@pytest.mark.parametrize(
    "linkage",
    [
        FourBar((0, 0), (4, 0), 3, 1, 3, (0.5, 1)),
        FourBar((0, 0), (4, 0), 2, 2, 3, (1, 1), assembly=-1),
        FourBar((0, 0), (3, 0), 2, 3, 2, (1, 1)),
    ],
)
def test_a_driver_that_swings(linkage: FourBar) -> None:
    dynamics = DynamicsSpec(2.0, gravity=(0, -9.81))
    found = section(LinkageSpec(linkage, "swings", length_unit="m", dynamics=dynamics))
    table = found.tables[KEY]
    assert len(table) % 361 == 0
    assert np.isfinite(table["holding_force_at_p"]).mean() > 0.98
    assert all(np.isfinite(fact.value) for fact in found.facts)
    for plot in found.plots:
        assert all(np.isfinite(values).any() for values in plot.series.values())
