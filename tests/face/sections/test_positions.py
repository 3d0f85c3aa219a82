"""The linkage at chosen driver angles."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from grashof.problems import FourBar, LinkageSpec, ProblemError

ONE_RANGE = LinkageSpec(FourBar((0, 0), (4, 0), 2, 2, 3, (1, 1)), "swinging")


def test_the_pumpjack_at_90_deg_is_that_of_the_audit(sections: Any, golden: dict[str, Any]) -> None:
    section = sections("pumpjack", at_deg=(0, 90, 180, 135, 225))["positions"]
    table = section.tables["positions"]
    assert table["theta2_deg"].tolist() == [0, 90, 180, 135, 225]
    row = table.iloc[1]
    assert [row["g_x"], row["g_y"]] == pytest.approx([1.3821515197636443, 4.4318969846450526], abs=1e-14)
    assert [row["b_x"], row["b_y"]] == pytest.approx([1.4524716014443350, 6.1748279885398406], abs=1e-14)
    assert [row["g3_x"], row["g3_y"]] == pytest.approx([0.726236, 4.434314], abs=5e-7)
    known = {
        float(state["theta2_deg"]): state
        for state in golden["pumpjack_report_geometry"]["states"]["sigma=+1"]
    }
    for _, row in table.iterrows():
        if (expected := known.get(row["theta2_deg"])) is not None:
            for key in ("omega3", "omega4", "alpha3", "alpha4"):
                assert row[key] == pytest.approx(float(expected[key]), rel=1e-11)
            for key in ("theta3", "theta4"):  # of any sequence of angles as they are: -180 to 180 deg
                assert row[f"{key}_deg"] == pytest.approx(np.degrees(float(expected[key])), abs=1e-9)
    assert {0.0, 225.0} <= known.keys()
    drawing = section.plots[0]
    bars = drawing.series["theta2 = 90 deg"]
    assert bars.shape == (8, 2)
    np.testing.assert_allclose(bars[2], table.loc[1, ["b_x", "b_y"]].to_numpy(dtype=float))
    lengths = np.hypot(*np.diff(bars[:4], axis=0).T)
    assert lengths == pytest.approx([1.1938, 3.7719, 3.048762])


def test_none_without_being_asked(sections: Any) -> None:
    assert "positions" not in sections("pumpjack")


def test_an_angle_that_the_driver_does_not_reach_is_refused(sections: Any) -> None:
    assert len(sections(ONE_RANGE, at_deg=(-100, 0, 360))["positions"].tables["positions"]) == 3
    with pytest.raises(ProblemError, match=r"at_deg is 120; the driver moves from -108.21 to 108.21 deg"):
        dict(sections(ONE_RANGE, at_deg=(0, 120)))
    with pytest.raises(ProblemError, match="at_deg has 37 driver angles; it may have up to 36"):
        dict(sections(ONE_RANGE, at_deg=(0,) * 37))
    with pytest.raises(ProblemError, match=r"at_deg\[1\] is nan"):
        dict(sections(ONE_RANGE, at_deg=(0, np.nan)))
