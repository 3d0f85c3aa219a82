"""The plane of the coupler, hodographs and jerk: against the motion itself."""

from __future__ import annotations

from typing import Any

import numpy as np
from section_facts import JACK, facts

from grashof.analysis import solve_kinematics


def test_the_jerk_is_the_rate_of_the_acceleration(sections: Any) -> None:
    table, linkage = sections(JACK)["hodographs"].tables["jerk"], JACK.linkage
    omega, step = 20 * np.pi / 30, 1e-4
    theta2 = np.radians(table["theta2_deg"])
    ahead, behind = (solve_kinematics(linkage, theta2 + s, omega) for s in (step, -step))
    rate = (ahead.p.acceleration - behind.p.acceleration) * omega / (2 * step)
    np.testing.assert_allclose(table[["p_jerk_x", "p_jerk_y"]], rate, atol=1e-5)
    np.testing.assert_allclose(table["jerk4"], (ahead.alpha4 - behind.alpha4) * omega / (2 * step), atol=1e-5)


def test_circles_at_the_angles_asked_for(sections: Any) -> None:
    found = sections(JACK, at_deg=(45.0, 90.0))["coupler-plane"]
    table = found.tables["coupler-circles"]
    assert table["theta2_deg"].tolist() == [45, 90]
    circle = next(plot for plot in found.plots if plot.key == "inflection-circle")
    for angle, row in zip((45, 90), table.to_dict("records"), strict=True):
        arc = circle.series[f"inflection circle, {angle}°"]
        arc = arc[np.isfinite(arc[:, 0])]
        radius = np.hypot(*(arc - [row["inflection_x"], row["inflection_y"]]).T)
        np.testing.assert_allclose(radius, row["inflection_diameter"] / 2, rtol=1e-9)


def test_what_is_constant_is_largest_nowhere(sections: Any) -> None:
    """P is A: its jerk has one size all around."""
    assert [*facts(sections("lufkin-c912d")["hodographs"])] == ["p_jerk_largest"]
