"""Fits of paths as a section: their motion, their notes, and that they are made only on request."""

from __future__ import annotations

import warnings
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from section_facts import TWO_RANGES, facts

from grashof.output.run_files import write_run
from grashof.problems import MotionTask, load_linkage_spec
from grashof.synth import Result, synthesize

ONLY = ("fits",)


def test_the_eleven_points_of_the_luggage_report(sections: Any) -> None:
    first, last = 74.0323, 74.0323 + 30 * 4.819353869
    with warnings.catch_warnings():
        warnings.simplefilter("error")  # x turns back: that is a note
        section = sections("luggage-report", fit_from_deg=first, fit_to_deg=last, fit_points=11)["fits"]
    quality = section.tables["fits"].set_index(["path", "fit", "by", "degree"])
    for link, r2 in ((2, 0.592), (3, 0.726), (4, 0.843)):
        row = quality.loc[(f"the centre of link {link}", "y over x", "least squares", 2)]
        assert row["r2"] == pytest.approx(r2, abs=5e-4)
    assert len(quality) == 4 * (2 * 4 + 2 * 3)
    assert section.tables["fits-points"]["theta2_deg"].tolist() == pytest.approx(np.linspace(first, last, 11))
    assert "11 points over the requested part" in section.notes[0]
    assert "link 2, the centre of link 3, the centre of link 4, P: y is not a function" in section.notes[1]
    assert facts(section)["fit_regression_of_theta2_error"] < 0.02
    assert facts(section)["fit_newton_y_of_x_error"] > 7
    drawn = {plot.key for plot in section.plots}
    assert drawn >= {"fits-regression-g2", "fits-newton-p", "fits-parametric-g4"}


def test_coefficients_give_the_polynomials_again(sections: Any) -> None:
    section = sections("pumpjack", fit_from_deg=10, fit_to_deg=80)["fits"]
    table, points = section.tables["fits-coefficients"], section.tables["fits-points"]
    own = table[(table["path"] == "P") & (table["degree"] == 4)].fillna(0)
    row = own[(own["fit"] == "y over x") & (own["by"] == "least squares")].iloc[0]
    x, y = points["p_x"].to_numpy(), points["p_y"].to_numpy()
    factors = row[["c0", "c1", "c2", "c3", "c4"]].to_numpy(dtype=float)
    np.testing.assert_allclose(factors[::-1], np.polyfit(x, y, 4), rtol=1e-5)
    # Newton: from the fifth point on through five of them, as divided differences.
    row = own[(own["fit"] == "y over theta2") & (own["first_point"] == 5)].iloc[0]
    theta2 = np.radians(points["theta2_deg"].to_numpy())[4:9]
    factors = row[["c0", "c1", "c2", "c3", "c4"]].to_numpy(dtype=float)
    through = sum(
        factor * np.prod([theta2[:, None] - theta2[:k]], axis=-1)[0] for k, factor in enumerate(factors)
    )
    np.testing.assert_allclose(through, y[4:9], rtol=1e-12)


def test_a_linkage_alone_is_fitted_over_all_that_it_does(sections: Any) -> None:
    turning = sections("pumpjack", sections=ONLY)["fits"]
    assert "13 points over the full turn, from theta2 = 0 to 360" in turning.notes[0]
    swinging = sections(TWO_RANGES, sections=ONLY)["fits"]
    assert "over its first range, from theta2 = 28.9551 to 67.9756 deg" in swinging.notes[0]
    assert "points halfway between joints" in swinging.notes[-1]


@pytest.mark.quick("1")
@pytest.mark.parametrize("sense", [1, -1])
def test_a_design_of_a_list_is_fitted_over_its_task(
    sections: Any, few: Result, tmp_path: Path, sense: int
) -> None:
    task = few.problem.task
    assert isinstance(task, MotionTask)
    back = replace(few.problem, task=MotionTask(task.positions[::-1], task.angles[::-1]))
    found = few if sense > 0 else synthesize(back, starts=4, enough=4)
    write_run(tmp_path, found, {}, 0)
    spec = load_linkage_spec(f"{tmp_path / 'candidates.json'}#1")
    section = sections(spec, sections=ONLY)["fits"]
    points = section.tables["fits-points"]
    assert points["theta2_deg"].iloc[0] == pytest.approx(np.degrees(found.best.verdict.theta2[0]), abs=1e-6)
    assert points["theta2_deg"].iloc[-1] == pytest.approx(np.degrees(found.best.verdict.theta2[-1]), abs=1e-6)
    ends = points[["p_x", "p_y"]].iloc[[0, -1]].to_numpy()
    np.testing.assert_allclose(ends, found.problem.task.positions[[0, -1]], atol=1e-9)
    assert "over the task motion" in section.notes[0]


def test_a_requested_part_may_be_followed_backwards(sections: Any) -> None:
    assert (
        "from theta2 = 60 to 30 deg" in sections(TWO_RANGES, fit_from_deg=60, fit_to_deg=30)["fits"].notes[0]
    )


def test_paths_that_are_lines_are_drawn_no_farther_than_they_are(sections: Any) -> None:
    section = sections("pumpjack", sections=ONLY)["fits"]
    for plot in section.plots:
        path = plot.series["path"]
        room = 1.01 * np.ptp(path, axis=0).max()
        for line in plot.series.values():
            assert np.nanmax(line - path.max(axis=0)) < room
            assert np.nanmax(path.min(axis=0) - line) < room
