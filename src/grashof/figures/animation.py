"""Animations of a linkage over the entire motion of its driver, as GIF or MP4."""

from __future__ import annotations

import os
import subprocess
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.animation import FuncAnimation, writers
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.text import Annotation, Text

from grashof.analysis import Position, solve_position
from grashof.analysis.curves.coupler_curve import smooth_polygon
from grashof.figures import parts
from grashof.figures.linkage import figure_of, new_axes, plane
from grashof.figures.shapes import Drawn, Placement, Shape, placements, shapes_of
from grashof.figures.subject import Linkage, Subject
from grashof.problems import Problem, ProblemError
from grashof.problems.values.arrays import TURN, FloatArray

_WRITERS = {".gif": "pillow", ".mp4": "ffmpeg"}


def animate(
    linkage: Linkage,
    problem: Problem | None = None,
    *,
    seconds: float = 4.0,
    fps: float = 25.0,
    annotated: bool = False,
    ax: Axes | None = None,
) -> FuncAnimation:
    """Move a linkage through one turn of its driver, or from limit to limit and back.

    P draws its path. For a problem the motion begins at the first target, in the sense of the task;
    scene and targets are at rest and a body is carried.

    Parameters
    ----------
    linkage : Linkage, LinkageSpec or Candidate
    problem : Problem, optional
    seconds : float
        Duration of the motion, which repeats.
    fps : float
        Frames a second.
    annotated : bool
        With the names of the moving points and the driver angle; for a driver that turns steadily also the
        time at its own speed.
    ax : Axes, optional

    Returns
    -------
    FuncAnimation
        Keep a reference as long as it is to move; `save_animation` writes it.

    Raises
    ------
    ProblemError
        Not a single linkage, one that closes nowhere, or fewer than two frames.
    """
    subject = Subject.of(linkage, problem)
    frames = round(seconds * fps) if np.isfinite(seconds * fps) else 0
    if frames < 2:
        raise ProblemError(f"seconds * fps is {seconds * fps:g}; it must be two frames or more")
    turns = np.arange(frames + 1) / frames
    state = solve_position(subject.linkage, _driver(subject, turns[:-1]))
    trace = smooth_polygon(lambda turn: solve_position(subject.linkage, _driver(subject, turn)).p, turns)
    axes = new_axes(ax)
    moving, figure = _Moving(axes, subject, state, *trace), figure_of(axes)
    if annotated:
        moving.annotate(axes, subject, state)
    if ax is None:  # laid out once: a layout for every frame would take most of the time
        figure.draw_without_rendering()
        figure.set_layout_engine("none")
    return FuncAnimation(figure, moving.show, frames, interval=1000 / fps)


def save_animation(animation: FuncAnimation, path: str | os.PathLike[str]) -> None:
    """Write an animation as GIF or MP4, completely or not at all.

    Parameters
    ----------
    animation : FuncAnimation
    path : path-like
        Ends in .gif or .mp4; a file of this name is replaced. A GIF keeps time in hundredths of a
        second: give `animate` an `fps` that divides 100.

    Raises
    ------
    ProblemError
        As `check_animation`.
    OSError
        The disk is full, the folder is lost, or ffmpeg failed.
    """
    path = Path(path)
    check_animation(path)
    with tempfile.TemporaryDirectory(dir=path.parent, prefix=".writing-") as folder:
        fresh = Path(folder) / path.name
        try:
            with parts.missing_glyphs_unwarned():
                animation.save(fresh, writer=_WRITERS[path.suffix.lower()], dpi=100)
        except subprocess.CalledProcessError as error:
            raise OSError(f"{path}: ffmpeg ended with code {error.returncode}") from None
        except OSError as error:
            raise OSError(error.errno, error.strerror, str(path)) from None
        fresh.replace(path)


def check_animation(path: Path) -> None:
    """Refuse, before any work is done, a file that `save_animation` cannot write.

    ProblemError for an ending other than .gif or .mp4, .mp4 without ffmpeg, or a folder that is not writable.
    """
    kind = path.suffix.lower()
    if kind not in _WRITERS:
        raise ProblemError(f"{path}: ends in {kind or 'nothing'}; it must end in {' or '.join(_WRITERS)}")
    if not writers.is_available(_WRITERS[kind]):
        raise ProblemError(f"{path}: writing {kind} needs ffmpeg, which was not found; .gif works without it")
    if path.is_dir():
        raise ProblemError(f"{path}: is a folder; it must be a file")
    try:
        with tempfile.TemporaryDirectory(dir=path.parent, prefix=".writing-"):
            pass
    except OSError as error:
        reason = error.strerror or "it cannot be written"
        raise ProblemError(f"{path}: {reason}; it must be a file in a folder that can be written") from None


def _driver(subject: Subject, turns: FloatArray) -> FloatArray:
    """Driver angles at shares of the motion, shape (N,), rad: an even turn, or a swing between limits."""
    phase, sweep = TURN * turns, subject.sweep
    start, sense = sweep.ranges[0][0], 1
    if subject.verdict is not None:
        start, sense = float(subject.verdict.theta2[0]), subject.verdict.direction
    if sweep.turns:
        return start + sense * phase
    low, high = np.transpose(sweep.ranges)
    middle, half = (low + high) / 2, (high - low) / 2
    beside = (start - middle + np.pi) % TURN - np.pi
    chosen = np.argmin(np.abs(beside) - half)  # the range with the start
    phase = phase + sense * np.arccos(np.clip(-beside / half, -1, 1))[chosen]
    angles: FloatArray = middle[chosen] - half[chosen] * np.cos(phase)
    return angles


class _Moving:
    """The artists of an animation, and the motion that they show.

    `state` has every frame, `path` the path of P over the full motion at its shares `turns`.
    """

    def __init__(
        self, axes: Axes, subject: Subject, state: Position, turns: FloatArray, path: FloatArray
    ) -> None:
        scene, carried = subject.scene, _carried(subject, state)
        self._placements, self._path = placements(subject, scene, state), path
        shapes = list(shapes_of(subject, scene, self._placements[0], named=False))
        if carried:
            self._placements = [each | body for each, body in zip(self._placements, carried, strict=True)]
            look = {"color": parts.BODY, "alpha": 0.7, "zorder": 3.5}
            shapes.append(Shape(tuple(carried[0]), look, filled=True))
        self._names: dict[str, Annotation] = {}
        self._captions: list[str] = []
        self._clock: Text | None = None
        frames = len(state.p)
        self._drawn = np.searchsorted(turns, np.arange(frames) / frames, side="right")
        self._shapes = Drawn(axes, shapes, self._placements[0])
        axes.plot(*path.T, color=parts.PATH, linewidth=0.8, linestyle=":", zorder=2)
        (self._trace,) = axes.plot([], [], color=parts.PATH, linewidth=1.8, zorder=3)
        if subject.problem is not None:
            parts.draw_scene(axes, subject.problem)
            parts.draw_task(axes, subject)
        parts.draw_ground(axes, scene)
        plane(axes, subject.spec.length_unit)
        axes.update_datalim(np.concatenate([[*each.values()] for each in self._placements] + [path]))
        parts.name_points(axes, {name.upper(): place for name, place in scene.ground.items()})

    def annotate(self, axes: Axes, subject: Subject, state: Position) -> None:
        """Name the moving points, and show driver angle and time."""
        look: dict[str, Any] = {"textcoords": "offset points", "color": parts.GROUND, "zorder": 8}
        self._names = {
            name: axes.annotate(name.upper(), tuple(self._placements[0][name]), (6, 6), **look)
            for name in subject.linkage.mechanism.moving
        }
        self._captions = list(_clock(subject, state.theta2))
        self._clock = axes.text(0.01, 0.99, self._captions[0], transform=axes.transAxes, va="top", zorder=8)

    def show(self, frame: int) -> list[Artist]:
        """Move everything to its place in a frame, and return the moved artists."""
        for name, text in self._names.items():
            text.xy = tuple(self._placements[frame][name])
        if self._clock is not None:
            self._clock.set_text(self._captions[frame])
        self._shapes.move(self._placements[frame])
        self._trace.set_data(*self._path[: self._drawn[frame]].T)
        texts = [] if self._clock is None else [*self._names.values(), self._clock]
        return [*self._shapes.artists, self._trace, *texts]


def _clock(subject: Subject, theta2: FloatArray) -> Iterator[str]:
    """Driver angle and time of each frame."""
    sweep, frames = subject.sweep, len(theta2)
    dynamics = subject.spec.dynamics
    steady = dynamics is None or dynamics.motor is None or dynamics.motor.steady
    turn = 60 / abs(sweep.speed_rpm) if sweep.turns and steady and sweep.speed_rpm else None
    for frame, angle in enumerate(np.degrees(theta2) % 360):
        time = "" if turn is None else f"t = {turn * frame / frames:.2f} s, "
        yield f"{time}theta2 = {angle:.0f} deg"


def _carried(subject: Subject, state: Position) -> list[Placement]:
    """Corners of the body that P carries, by name, in every frame; empty without a body."""
    if subject.problem is None:
        return []
    task = subject.problem.task
    angles = state.carrying + subject.linkage.body_angle
    poses = zip(state.p, angles.tolist(), strict=True)
    found = [parts.body_outline(task, place, angle) for place, angle in poses]
    return [
        {f"corner{number}": corner for number, corner in enumerate(each)}
        for each in found
        if each is not None
    ]
