"""Animations: the linkage moves as it does, and the files hold what was asked for, or nothing."""

from __future__ import annotations

import shutil
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import matplotlib.animation
import matplotlib.pyplot as plt
import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.colors import to_hex
from matplotlib.figure import Figure
from PIL import Image, ImageSequence

import grashof.figures.animation as grashof_animation
from grashof import animate
from grashof.analysis import driver_ranges, solve_position
from grashof.figures import save_animation
from grashof.figures.parts import COUPLER, DRIVER, OUTPUT, PATH
from grashof.output.run_files import write_run
from grashof.problems import (
    FourBar,
    MotionTask,
    Problem,
    ProblemError,
    Requirements,
    Rotatability,
    load_linkage,
    load_linkage_spec,
)
from grashof.synth import Result

Grashof = Callable[..., Any]
ROCKER = FourBar((0, 0), (4, 0), 2, 2, 3, (1, 1))


def frames_of(linkage: Any, problem: Problem | None = None, **options: Any) -> tuple[dict[str, Any], Axes]:
    """Ends of the links, the trace and the body in every frame; the axes."""
    axes = Figure().subplots()
    moving = animate(linkage, problem, ax=axes, **options)
    shown: dict[str, list[Any]] = {"driver": [], "output": [], "coupler": [], "trace": [], "body": []}
    names = {DRIVER: "driver", OUTPUT: "output", COUPLER: "coupler"}
    for frame in moving.new_frame_seq():
        moving._draw_frame(frame)
        for line in axes.lines:
            name = names.get(to_hex(line.get_color()))
            if name:
                shown[name].append(line.get_xydata().copy())
            elif to_hex(line.get_color()) == PATH and line.get_linewidth() == 1.8:
                shown["trace"].append(line.get_xydata().copy())
        shown["body"] += [patch.get_xy()[:-1].copy() for patch in axes.patches if patch.get_alpha() == 0.7]
    moving._draw_was_started = True  # else matplotlib warns that it was never seen
    return shown, axes


def test_names_move_along_and_the_time_is_shown() -> None:
    """Of a driver that turns steadily the time at its own speed, of one that swings the angle alone."""
    jack = load_linkage_spec("pumpjack")
    axes = Figure().subplots()
    moving = animate(jack, seconds=1, fps=8, annotated=True, ax=axes)
    shown = {text.get_text(): text for text in axes.texts}
    for frame in moving.new_frame_seq():
        moving._draw_frame(frame)
        state = solve_position(jack.linkage, 2 * np.pi * frame / 8)
        for name, place in (("A", state.a), ("B", state.b), ("P", state.p)):
            np.testing.assert_allclose(shown[name].xy, place, atol=1e-12)
        assert shown["t = 0.00 s, theta2 = 0 deg"].get_text() == (
            f"t = {3 * frame / 8:.2f} s, theta2 = {45 * frame} deg"
        )
    moving._draw_was_started = True
    axes = Figure().subplots()
    swinging = animate(ROCKER, seconds=1, fps=8, annotated=True, ax=axes)
    swinging._draw_was_started = True
    assert any(text.get_text().startswith("theta2 = ") for text in axes.texts)
    plain = Figure().subplots()
    animate(ROCKER, seconds=1, fps=8, ax=plain)._draw_was_started = True
    assert {text.get_text() for text in plain.texts} == {"O2", "O4"}


def test_links_keep_their_lengths_and_p_draws_its_path() -> None:
    linkage = load_linkage("pumpjack")
    shown, _ = frames_of(linkage, seconds=1, fps=12)
    driver, coupler, output = (np.array(shown[name]) for name in ("driver", "coupler", "output"))
    lengths = [np.hypot(*np.moveaxis(ends[:, 1] - ends[:, 0], -1, 0)) for ends in (driver, coupler, output)]
    expected = np.array([linkage.r2, linkage.r3, linkage.r4])[:, None]
    np.testing.assert_allclose(lengths, np.tile(expected, 12), rtol=1e-12)
    np.testing.assert_allclose(coupler[:, 1], output[:, 1], atol=1e-12)
    turn = np.degrees(np.arctan2(*(driver[:, 1] - linkage.o2).T[::-1])) % 360
    np.testing.assert_allclose(turn, np.arange(12) * 30, atol=1e-9)
    for frame, trace in enumerate(shown["trace"]):
        np.testing.assert_allclose(trace[-1], coupler[frame, 2])
        np.testing.assert_array_equal(trace, shown["trace"][-1][: len(trace)])


def test_a_driver_with_limits_swings_between_them_and_back() -> None:
    driver = np.array(frames_of(ROCKER, seconds=2, fps=20)[0]["driver"])
    angle = np.unwrap(np.arctan2(*driver[:, 1].T[::-1]))
    low, high = driver_ranges(ROCKER)[0]
    turned = angle - angle[0] + low
    np.testing.assert_allclose([turned.min(), turned.max()], [low, high], atol=1e-9)
    assert np.argmax(turned) == 20
    np.testing.assert_allclose(turned[1:20], turned[:20:-1], atol=1e-9)
    assert np.isfinite(driver).all()


@pytest.mark.slow
def test_a_design_starts_at_its_first_target_in_its_sense_and_carries_the_body(few: Result) -> None:
    task, verdict = few.problem.task, few.best.verdict
    assert isinstance(task, MotionTask)
    shown, axes = frames_of(few.best, few.problem, seconds=3, fps=12)
    a = np.array(shown["driver"])[:, 1] - few.best.linkage.o2
    step = np.angle((a[1:] @ [1, 1j]) / (a[:-1] @ [1, 1j]))
    np.testing.assert_allclose(step, verdict.direction * np.radians(10))
    body = np.array(shown["body"])
    np.testing.assert_allclose(body[:, 0], np.array(shown["coupler"])[:, 2])
    first = task.body + task.positions[0]  # the first pose is not turned
    np.testing.assert_allclose(body[0], first, atol=1e-6)
    sides = np.hypot(*np.moveaxis(np.diff(body, axis=1), -1, 0))
    np.testing.assert_allclose(sides, 1, atol=1e-9)
    still = [patch.get_xy()[0] for patch in axes.patches if patch.get_alpha() == 0.15]
    np.testing.assert_allclose(still, task.positions)


@pytest.mark.parametrize("sense", [1, -1])
def test_between_limits_a_task_starts_at_its_first_target_in_its_sense(sense: int) -> None:
    angles = np.mean(driver_ranges(ROCKER)[0]) + sense * np.radians([-20, 0, 20, 40])
    state = solve_position(ROCKER, angles)
    wanted = Requirements(rotatability=Rotatability.ANY)
    problem = Problem(task=MotionTask(state.p, state.theta3), requirements=wanted)
    driver = np.array(frames_of(ROCKER, problem, seconds=4, fps=20)[0]["driver"])
    turned = np.unwrap(np.arctan2(*driver[:, 1].T[::-1]))
    assert turned[0] == pytest.approx(angles[0], abs=1e-6)
    assert np.sign(turned[1] - turned[0]) == sense
    low, high = driver_ranges(ROCKER)[0]
    assert np.ptp(turned) == pytest.approx(high - low, abs=1e-2)


def test_a_change_point_linkage_moves_between_its_dead_positions() -> None:
    shown, _ = frames_of(FourBar((0, 0), (4, 0), 1, 4, 1), seconds=1, fps=20)
    assert np.isfinite(shown["coupler"]).all()
    output = np.diff(np.array(shown["output"]), axis=1)[:, 0]
    np.testing.assert_allclose(np.hypot(*output.T), 1)


def test_a_new_figure_only_where_no_axes_are_given() -> None:
    moving = animate(ROCKER, seconds=0.2, fps=20)
    assert len(plt.get_fignums()) == 1
    moving._draw_was_started = True  # else matplotlib warns that it was never seen


@pytest.mark.parametrize(("seconds", "fps"), [(0.01, 10), (np.nan, 10), (1, np.inf), (-1, 25)])
def test_fewer_than_two_frames_are_refused(seconds: float, fps: float) -> None:
    with pytest.raises(ProblemError, match="it must be two frames"):
        animate(ROCKER, seconds=seconds, fps=fps)


def test_a_gif_has_the_frames_and_the_time_asked_for(tmp_path: Path) -> None:
    jack = animate(load_linkage("pumpjack"), seconds=0.5, fps=20, ax=Figure(figsize=(1, 1)).subplots())
    path = tmp_path / "jack.gif"
    path.write_text("an older one")
    save_animation(jack, path)
    with Image.open(path) as picture:
        assert picture.format == "GIF"
        durations = [each.info["duration"] for each in ImageSequence.Iterator(picture)]
    assert durations == [50] * 10
    assert [file.name for file in tmp_path.iterdir()] == ["jack.gif"]


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("a.webm", r"ends in \.webm; it must end in \.gif or \.mp4"),
        ("a", "ends in nothing"),
        ("no/a.gif", "No such file or directory"),
        ("taken.gif", "is a folder"),
        ("a.mp4", r"writing \.mp4 needs ffmpeg, which was not found; \.gif works without it"),
    ],
)
def test_files_that_cannot_be_written_are_refused_before_any_work(
    refused: Callable[..., str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str, message: str
) -> None:
    monkeypatch.setattr(matplotlib.animation.shutil, "which", lambda _: None)
    monkeypatch.setattr(grashof_animation, "FuncAnimation", None)
    (tmp_path / "taken.gif").mkdir()
    refused("animate", "pumpjack", "--out", name)
    with pytest.raises(ProblemError, match=message):
        grashof_animation.check_animation(Path(name))
    assert [path.name for path in tmp_path.iterdir()] == ["taken.gif"]


@pytest.mark.skipif(sys.platform == "win32", reason="a shell script stands for ffmpeg")
@pytest.mark.parametrize(("code", "exit_code"), [(0, 0), (1, 3)])
def test_mp4_goes_through_ffmpeg_completely_or_not_at_all(
    grashof: Grashof, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, code: int, exit_code: int
) -> None:
    tool = tmp_path / "bin" / "ffmpeg"
    tool.parent.mkdir()
    tool.write_text(f'#!/bin/sh\nfor last; do :; done\nwc -c > "$last"\nexit {code}\n')
    tool.chmod(0o755)
    monkeypatch.setenv("PATH", str(tool.parent), prepend=":")
    assert shutil.which("ffmpeg") == str(tool)
    (tmp_path / "jack.mp4").write_text("old")
    done = grashof("animate", "pumpjack", "--out", "jack.mp4", "--seconds", "0.2", "--fps", "20")
    assert done.exit_code == exit_code, done.output
    written = (tmp_path / "jack.mp4").read_text().strip()
    assert written == (str(4 * 600 * 500 * 4) if code == 0 else "old")
    assert "ffmpeg ended with code 1" in done.stderr or code == 0
    assert sorted(path.name for path in tmp_path.iterdir()) == ["bin", "jack.mp4"]


def test_the_command_names_the_file_after_the_linkage(grashof: Grashof, tmp_path: Path) -> None:
    done = grashof("animate", "pumpjack", "--seconds", "0.2", "--fps", "10")
    assert (done.exit_code, done.stderr) == (0, "pumpjack.gif\n")
    with Image.open(tmp_path / "pumpjack.gif") as picture:
        assert picture.size == (600, 500)
    assert grashof("animate", "pumpjak").exit_code == 2
    assert grashof("animate", "pumpjack", "--fps", "99").exit_code == 2


def test_a_design_of_a_list_moves_as_in_its_problem(few: Result, tmp_path: Path) -> None:
    """The same picture in every frame as from the result itself: body, poses, scene and start."""
    write_run(tmp_path, few, {}, drawings=0)
    for rank in (1, 3):
        stored = load_linkage_spec(f"{tmp_path}/candidates.json#{rank}")
        mine, axes = frames_of(few.candidates[rank - 1], few.problem, seconds=1, fps=10)
        others, other_axes = frames_of(stored, seconds=1, fps=10)
        assert len(mine["body"]) == 10
        for one, other in zip(mine.values(), others.values(), strict=True):
            for shown in zip(one, other, strict=True):
                np.testing.assert_allclose(*shown, atol=1e-9)
        assert len(axes.patches) == len(other_axes.patches)
        for line, its in zip(axes.lines, other_axes.lines, strict=True):
            np.testing.assert_allclose(line.get_xydata(), its.get_xydata(), atol=1e-9)
        np.testing.assert_allclose(axes.axis(), other_axes.axis(), rtol=1e-9)
