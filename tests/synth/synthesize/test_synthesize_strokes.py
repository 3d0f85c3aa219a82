"""Crank-rockers by swing, slider-cranks by stroke, and by their time ratio: from the problem to the list."""

from typing import Any

import numpy as np
import pytest
from known_designs import SLIDES
from stroke_results import found, worst

from grashof.analysis import verify
from grashof.problems import (
    InvertedSliderCrank,
    Linkage,
    Problem,
    ProblemError,
    SliderCrank,
    StrokeTask,
    load,
)
from grashof.problems.files.problem_schema import problem_from
from grashof.problems.values.arrays import FloatArray
from grashof.synth import Result, synthesize
from grashof.synth.theory.limit_positions import best_transmission


@pytest.mark.slow
def test_the_published_quick_return_is_first_then_a_family_to_choose_from() -> None:
    result = synthesize(load("quick-return"))
    np.testing.assert_allclose(result.best.linkage.lengths, [120, 46.67, 116.16, 73.88], atol=0.005)
    assert worst(result)[0] == pytest.approx(37.733, abs=5e-4)
    assert len(result) >= 50
    frame = result.to_frame()
    assert frame["output_swing_deg"].to_numpy() == pytest.approx(80, abs=1e-9)
    assert frame["time_ratio"].to_numpy() == pytest.approx(10 / 9, abs=1e-9)
    assert (frame["theta2_end_deg"] - frame["theta2_start_deg"]).to_numpy() == pytest.approx(3600 / 19)
    assert frame["error_max"].isna().all()
    front = frame[frame["pareto"]]
    assert front["size"].max() > 1.5 * front["size"].min()
    assert (frame["grashof_class"] == "crank-rocker").all()


@pytest.mark.quick("30-1.0-wanted0")
@pytest.mark.parametrize(
    ("swing", "ratio", "wanted"),
    [
        (30, 1.0, {"link_ratio_max": 10}),
        (80, 10 / 9, {"link_ratio_max": 2}),
        (60, 1.3, {"r2": [1, 2], "r4": [2.5, 3]}),
        (20, 1.2, {"transmission_min_deg": 40, "transmission_over": "cycle", "driver_sense": "cw"}),
        (80, 1.1, {"o2": [3, 4], "o4": {"x": [100, 120], "y": [50, 60]}}),
        (80, 1.1, {"theta2_start_deg": 30, "link_length": [50, 200]}),
        (80, 1.1, {"ground_angle_deg": -90, "o4": {"y": [-7, -5]}, "driver_sense": "cw"}),
        (80, 1.1, {"ground_angle_deg": 10, "theta2_start_deg": 32}),
        (80, 1.1, {"r1": [120, 120], "r2": [46, 46]}),
        (100, 1.0, {"rotatability": "any", "rotatability_margin": 0}),
    ],
)
def test_limits_are_kept(swing: float, ratio: float, wanted: dict[str, Any]) -> None:
    result = found(swing, ratio, **wanted)
    task, asked = result.problem.task, result.problem.requirements
    assert len(result) > 0
    for each in result.candidates:
        assert verify(each.linkage, task, asked).ok
    assert worst(result)[0] == worst(result).max()
    assert worst(result)[0] <= np.degrees(best_transmission(np.radians(swing), ratio)) + 1e-6


@pytest.mark.quick("2.9-wanted8-rotatability_margin")
@pytest.mark.parametrize(
    ("ratio", "wanted", "words"),
    [  # a crank-rocker where there is no time ratio, else a slider-crank
        (None, {"transmission_min_deg": 40}, "transmission_min_deg 37.73 instead of 40"),
        (None, {"link_ratio_max": 1.5}, "link_ratio_max 1.562 instead of 1.5"),
        (None, {"r1": [120, 120], "link_length": [0, 30]}, "r1"),
        (None, {"output_swing_deg": [82, 90]}, "output_swing_deg from 80 instead of 82"),
        (None, {"ground_angle_deg": 10, "theta2_start_deg": 60}, "theta2_start_deg 59.7"),
        (1.2, {"transmission_min_deg": 60}, "transmission_min_deg 47.2 instead of 60"),
        (1.2, {"stroke": [2, 3]}, "stroke from 1 instead of 2"),
        (1.2, {"r2": [0.6, 0.9]}, "r2 from 0.499 instead of 0.6"),
        (2.9, {"rotatability_margin": 1e-3}, "rotatability_margin"),
    ],
)
def test_an_empty_list_names_sufficient_changes(
    ratio: float | None, wanted: dict[str, Any], words: str
) -> None:
    result = found(**wanted) if ratio is None else slides(ratio, **wanted)
    assert len(result) == 0
    assert result.complete
    assert words in result.note
    assert len(result.nearest) > 0


AREA = {"keep_out": [[[2, 0], [3, 0], [3, 1], [2, 1]]], "keep_out_for": ["links"]}


@pytest.mark.slow
@pytest.mark.quick("a")
@pytest.mark.parametrize(
    "wanted",
    [
        {"a": {"x": [1, 2], "y": [3, 4]}},
        {"size": [0.2, 0.5]},
        {"o2": [0, 0], "o4": [5, 5], "b": {"x": [0, 10]}, **AREA},
    ],
    ids=["a", "size", "keep out"],
)
def test_places_and_areas_are_kept(wanted: dict[str, Any]) -> None:
    result = found(**wanted)
    assert len(result) > 3
    asked = result.problem
    assert all(verify(each.linkage, asked.task, asked.requirements).ok for each in result.candidates)


@pytest.mark.slow
def test_another_objective_decides() -> None:
    dynamics = {"speed_rpm": 60, "mass_per_length": 2.0}
    tables = {"length_unit": "m", "dynamics": dynamics, "objective": {"maximise": "torque"}}
    torque = found(tables=tables).to_frame()["torque_peak"].to_numpy()
    assert (np.diff(torque) >= 0)[:3].all()
    assert torque[0] == torque.min()


@pytest.mark.slow
def test_a_users_own_constraint() -> None:
    def short(design: Any) -> Any:
        return design.r3 - 0.9

    problem = Problem(task=StrokeTask.from_degrees(swing_deg=80, time_ratio=10 / 9))
    result = synthesize(problem, constraints=[short])
    assert len(result) > 0
    assert all(each.linkage.r3 <= 0.9 + 1e-9 for each in result.candidates)


@pytest.mark.slow
def test_a_stroke_that_no_crank_rocker_does_well_is_listed_and_advised() -> None:
    result = found(40, 1.5)
    assert len(result) >= 8
    assert "31.8 deg at best" in result.note
    assert "six-bar" in result.note
    assert found(40, 1.1).note == ""


@pytest.mark.slow
@pytest.mark.quick("0.2")
@pytest.mark.parametrize("effort", [0.2, 3])
def test_effort_and_enough(effort: float) -> None:
    result = synthesize(load("quick-return"), effort=effort, enough=7)
    assert 7 <= len(result) < 30
    assert worst(result)[0] == pytest.approx(37.733, abs=5e-4)


def slides(ratio: float = 1.2, travel: float = 1.0, **wanted: Any) -> Result:
    stroke = {"stroke": travel, "time_ratio": ratio}
    document = {"kind": "stroke", "mechanism": "slider-crank", "stroke": stroke, "requirements": wanted}
    return synthesize(problem_from(document, "slide"), enough=8)


@pytest.mark.quick("2.5-3.214-0.47051-0.54314-0.07177")
@pytest.mark.parametrize(("ratio", "angle", "r2", "r3", "offset"), SLIDES)
def test_the_best_slide_is_first(ratio: float, angle: float, r2: float, r3: float, offset: float) -> None:
    result = slides(ratio, 100.0)
    best = result.best.linkage
    assert isinstance(best, SliderCrank)
    assert worst(result)[0] == pytest.approx(angle, abs=5e-4)
    assert [best.r2, best.r3, best.offset] == pytest.approx([100 * r2, 100 * r3, 100 * offset], abs=1e-3)
    for each in result.candidates:
        check_sampled(each.linkage, 100.0, ratio)


TURN = np.linspace(0, 2 * np.pi, 400_001)


def check_sampled(linkage: Linkage, travel: float, ratio: float) -> None:
    """Stroke and time ratio of a turn in small steps, by the position of B written out."""
    assert isinstance(linkage, SliderCrank)
    rise = linkage.offset - linkage.r2 * np.sin(TURN)
    b = linkage.r2 * np.cos(TURN) + linkage.assembly * np.sqrt(linkage.r3**2 - rise**2)
    check_turned(b, travel, 1e-9, ratio, 2e-4)


def check_sampled_swing(linkage: Linkage, swing: float, ratio: float) -> None:
    """Swing and time ratio of a turn in small steps, by the direction of the rod written out."""
    assert isinstance(linkage, InvertedSliderCrank)
    way = linkage.r1 - linkage.r2 * np.exp(1j * TURN)  # from A to O4, O2O4 along x
    rod = np.unwrap(np.angle(way)) + np.arcsin(linkage.offset / np.abs(way))
    check_turned(np.degrees(rod), swing, 1e-8, ratio, 1e-3)


def check_turned(place: FloatArray, travel: float, near: float, ratio: float, near_ratio: float) -> None:
    assert np.ptp(place) == pytest.approx(travel, rel=near)
    there = abs(TURN[place.argmax()] - TURN[place.argmin()])
    slow = max(there, 2 * np.pi - there)
    assert slow / (2 * np.pi - slow) == pytest.approx(ratio, rel=near_ratio)


@pytest.mark.quick("wanted0")
@pytest.mark.parametrize(
    "wanted",
    [
        {"link_length": [0.3, 0.9]},
        {"r2": [0.2, 0.4]},
        {"offset": [-0.3, -0.1]},
        {"offset": [0.6, 1.0], "o2": [3, 4], "slide_angle_deg": 90},
        {"theta2_start_deg": 30},
        {"theta2_start_deg": 30, "slide_angle_deg": 15},
        {"theta2_start_deg": 30, "slide_angle_deg": 45, "driver_sense": "cw"},
        {"link_ratio_max": 2.0, "driver_sense": "cw"},
        {"o2": {"x": [10, 20]}, "a": {"y": [-5, 0.2]}},
        {"keep_out": [[[-9, -9], [9, -9], [9, 9], [-9, 9]]], "o2": {"x": [-20, 20], "y": [-20, 20]}},
    ],
)
def test_limits_of_slides_are_kept(wanted: dict[str, Any]) -> None:
    result = slides(1.2, **wanted)
    assert len(result) > 0
    best = float(np.degrees(best_transmission(None, 1.2)))
    assert worst(result)[0] == pytest.approx(worst(result).max(), abs=1e-12)  # mirror images are as good
    assert worst(result)[0] <= best + 1e-6
    for each in result.candidates:
        assert verify(each.linkage, result.problem.task, result.problem.requirements).ok
        check_sampled(each.linkage, 1.0, 1.2)


def test_no_slide_within_limits_does_better() -> None:
    """Against all members of the family that a dense grid has, limits active."""
    result = slides(1.2, link_length=[0.3, 0.9], offset=[0.0, 0.2])
    r3 = np.linspace(0.3, 0.9, 200_001)
    # The triangle of both limit positions with unit stroke, solved for r2 / r3.
    lag = np.pi * 0.2 / 2.2
    share = np.sqrt(np.maximum((0.25 / r3**2 - np.sin(lag / 2) ** 2), 0.0)) / np.cos(lag / 2)
    r2, offset = share * r3, (r3**2 - (share * r3) ** 2) * np.sin(lag)
    fine = (share < 1) & (offset <= 0.2) & (r2 >= 0.3) & (r2 + offset < r3) & (4 * r2 * r3 > 1)
    best = np.degrees(np.arccos(((r2 + offset) / r3)[fine].min()))
    assert worst(result)[0] == pytest.approx(best, abs=1e-3)


@pytest.mark.parametrize(
    ("mechanism", "stroke", "words"),
    [
        (["slider-crank", "four-bar"], {"stroke": 9, "time_ratio": 1.2}, "a four-bar has a swing"),
        (["slider-crank"], {"swing_deg": 9, "time_ratio": 1.2}, "a slider-crank has a slide"),
        (
            ["inverted-slider-crank"],
            {"swing_deg": 9, "time_ratio": 1.2},
            "it must be 1.1052632 for an inverted-slider-crank",
        ),
        (["slider-crank"], {"stroke": 9, "time_ratio": 3.0}, "it must be less than 2.999 for a slider-crank"),
    ],
)
def test_impossible_strokes_of_a_kind_are_refused(
    mechanism: list[str], stroke: dict[str, float], words: str
) -> None:
    with pytest.raises(ProblemError, match=words):
        problem_from({"kind": "stroke", "mechanism": mechanism, "stroke": stroke}, "slide")


def test_a_slide_almost_three_times_as_slow_is_listed_with_how_badly_it_transmits() -> None:
    result = slides(2.9)
    assert worst(result)[0] == pytest.approx(0.25046, abs=1e-5)
    assert "transmit at 0.2505 deg at best" in result.note
    for each in result.candidates:
        check_sampled(each.linkage, 1.0, 2.9)


def test_as_long_both_ways_the_longest_rod_is_first_and_none_has_an_offset() -> None:
    result = slides(1.0, 50.0)
    best = result.best.linkage
    lengths = [float(getattr(best, name)) for name in ("r2", "r3", "offset")]
    assert lengths == pytest.approx([25.0, 500.0, 0.0], abs=1e-9)  # 20 times the crank
    assert worst(result)[0] == worst(result).max()


@pytest.mark.quick("box1-cw")
@pytest.mark.parametrize("sense", ["ccw", "cw"])
@pytest.mark.parametrize("box", [{"x": [0, 1], "y": [0, 0]}, {"x": [0, 0.75], "y": [0, 0.75]}])
def test_the_best_slide_lies_in_a_box_that_just_holds_its_stroke(box: dict[str, Any], sense: str) -> None:
    result = slides(1.2, b=box, driver_sense=sense)
    assert worst(result).max() == pytest.approx(47.201, abs=5e-4)
    for each in result.candidates:
        assert verify(each.linkage, result.problem.task, result.problem.requirements).ok


def test_a_box_that_cannot_hold_the_stroke_is_refused() -> None:
    with pytest.raises(ProblemError, match=r"^requirements.b is 0.5 by 0.5; it must hold the stroke, 1$"):
        slides(1.2, b={"x": [0, 0.5], "y": [0, 0.5]})


@pytest.mark.quick("20.0")
@pytest.mark.parametrize("swing", [20.0, 80.0, 150.0])
def test_crank_shapers_by_their_swing(swing: float) -> None:
    ratio = (180 + swing) / (180 - swing)
    document = {
        "kind": "stroke",
        "mechanism": "inverted-slider-crank",
        "stroke": {"swing_deg": swing, "time_ratio": ratio},
    }
    result = synthesize(problem_from(document, "shaper"), enough=6)
    best = result.best.linkage
    assert [float(best.r2), float(best.offset)] == pytest.approx([np.sin(np.radians(swing / 2)), 0], abs=1e-9)
    assert worst(result)[0] == pytest.approx(90, abs=1e-6)
    for each in result.candidates:
        check_sampled_swing(each.linkage, swing, ratio)


@pytest.mark.slow
def test_crank_rockers_and_crank_shapers_in_one_list() -> None:
    document = {
        "kind": "stroke",
        "mechanism": ["four-bar", "inverted-slider-crank"],
        "stroke": {"swing_deg": 80, "time_ratio": 2.6},
    }
    result = synthesize(problem_from(document, "both"), enough=6)
    kinds = [each.linkage.mechanism.word for each in result.candidates]
    assert {"four-bar", "inverted-slider-crank"} == set(kinds)
    assert kinds[0] == "inverted-slider-crank"
    assert (result.to_frame()["time_ratio"] - 2.6).abs().max() < 1e-9
