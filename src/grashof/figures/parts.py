"""Fixed elements of drawings of linkages: ground, path of P, names, the task and its scene."""

from __future__ import annotations

import warnings
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Polygon
from matplotlib.text import Annotation

from grashof.analysis import solve_position
from grashof.drawing.scene import ROLES, Scene
from grashof.figures.subject import Subject
from grashof.problems import Problem, Task
from grashof.problems.values.arrays import FloatArray

# Distinct to the colour-blind, too (after Okabe & Ito, *Color Universal Design*, 2008).
DRIVER, COUPLER, OUTPUT, PATH = "#d55e00", "#0072b2", "#009e73", "#8c3f78"
BODY = TARGET = "#e69f00"  # both belong to the task
COUPLER_2, OUTPUT_2 = "#5b3fd6", "#6b3d00"
COLOURS = dict(zip(ROLES, (DRIVER, COUPLER, OUTPUT, COUPLER_2, OUTPUT_2), strict=True))
SCENE, GROUND, KEPT_OUT = "#5d6d7e", "#17202a", "#909497"
# Targets up to which the linkage is drawn at each, and up to which each carries its number.
_CROWD, _CROWD_OF_POINTS = 8, 6
_NUMBERED = 24
# pt: offsets of a name from its point, in order of preference.
_SIDES = ((7, -12), (7, 6), (-20, 6), (-20, -12), (10, -3), (-22, -3), (-5, 9), (-5, -17))
_LETTER, _KEPT_OFF = (6.5, 7.0), 5.5  # pt: size of a letter, and least distance of its middle line from bars
_TEXT = (16.0, 11.0)  # pt: distances at which texts of two characters do not overlap


@contextmanager
def missing_glyphs_unwarned() -> Iterator[None]:
    """Suppress warnings for signs that the font lacks: PNG shows a box for them, SVG keeps the text."""
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", r"Glyph .* missing from", UserWarning)
        yield


def name_points(axes: Axes, points: Mapping[str, FloatArray]) -> None:
    """Write names beside points of shape (2,), each where it covers no text and, if possible, no line.

    The limits of the axes are final by then, and all else is drawn.
    """
    places = in_points(axes, np.array(list(points.values())))
    taken, ends = _written(axes), _segments(axes)
    for (name, point), place in zip(points.items(), places, strict=True):
        free = [side for side in _SIDES if apart(place + side, taken)] or _SIDES[:1]
        side = next((side for side in free if _clear(place + side, name, ends)), free[0])
        taken.append(place + side)
        axes.annotate(name, tuple(point), side, textcoords="offset points", color=GROUND, zorder=8)


def _written(axes: Axes) -> list[FloatArray]:
    """Places of short texts, pt."""
    found = [text for text in axes.texts if isinstance(text, Annotation) and text.get_text()]
    if not found:
        return []
    places = in_points(axes, np.array([text.xy for text in found])) + [text.xyann for text in found]
    right = [text.get_horizontalalignment() == "right" for text in found]
    back = [_LETTER[0] * len(text.get_text()) * at_right for text, at_right in zip(found, right, strict=True)]
    return list(places - np.stack([back, np.zeros(len(found))], axis=-1))


def _segments(axes: Axes) -> FloatArray:
    """The two ends of every piece of the lines and outlines that are drawn, pt, shape (M, 2, 2)."""
    drawn = [np.asarray(line.get_xydata()) for line in axes.lines if line.get_linestyle() != "None"]
    drawn += [patch.get_xy() for patch in axes.patches if isinstance(patch, Polygon)]
    pieces = [np.stack([each[:-1], each[1:]], axis=1) for each in drawn]
    every = np.concatenate([np.zeros((0, 2, 2)), *pieces])
    return in_points(axes, every[np.isfinite(every).all(axis=(1, 2))].reshape(-1, 2)).reshape(-1, 2, 2)


def _clear(place: FloatArray, name: str, ends: FloatArray) -> bool:
    """Whether a name with its lower left corner at a place, pt, is clear of all lines."""
    middle = place + np.array([_LETTER[0] * len(name), _LETTER[1]]) / 2
    reach = np.linspace(-0.3, 0.3, 3)[:, None] * [_LETTER[0] * len(name), 0] + middle
    start, way = ends[:, None, 0], ends[:, None, 1] - ends[:, None, 0]
    size = np.maximum((way**2).sum(axis=-1), 1e-12)
    share = np.clip(((reach - start) * way).sum(axis=-1) / size, 0, 1)
    gap = start + share[..., None] * way - reach
    return bool((np.hypot(gap[..., 0], gap[..., 1]) > _KEPT_OFF).all())


def in_points(axes: Axes, places: FloatArray) -> FloatArray:
    """Points (N, 2) in pt on the page, with the present limits and scale."""
    axes.autoscale_view()
    axes.apply_aspect()
    inches: FloatArray = axes.figure.dpi_scale_trans.inverted().transform(axes.transData.transform(places))
    return 72 * inches


def apart(place: FloatArray, others: Sequence[FloatArray]) -> bool:
    """Whether a short text at a place, pt, overlaps none at others."""
    return not any((np.abs(place - other) < _TEXT).all() for other in others)


def draw_ground(axes: Axes, scene: Scene) -> None:
    """The ground pivots, and the guide of a slide."""
    for guide in (scene.guide(slide) for slide in scene.slides if not slide.carried):
        for line, width in zip(guide, (1.6, 0.7), strict=True):
            axes.plot(*line.T, linewidth=width, color=GROUND, zorder=1.8)
    for pivot in scene.ground.values():
        axes.plot(*pivot[:, None], marker="^", color=GROUND, markersize=11, zorder=6)
        axes.plot(*pivot[:, None], marker="o", color="white", markersize=3, zorder=7)


def draw_sense(axes: Axes, subject: Subject) -> None:
    """A quarter of a turn about O2 from the first target, in the sense of the driver."""
    linkage, verdict = subject.linkage, subject.verdict
    if verdict is None:
        return
    radius = max(0.4 * float(linkage.r2), 0.05 * verdict.size)
    angles = verdict.theta2[0] + verdict.direction * np.array([0, np.pi / 2])
    tail, head = linkage.o2 + radius * np.column_stack([np.cos(angles), np.sin(angles)])
    style = {
        "arrowstyle": "-|>", "color": DRIVER, "linewidth": 1.4, "shrinkA": 0, "shrinkB": 0,
        "connectionstyle": f"arc3,rad={0.5 * verdict.direction}",
    }  # fmt: skip
    axes.annotate("", tuple(head), tuple(tail), arrowprops=style, zorder=7)


def draw_path(axes: Axes, subject: Subject, scene: Scene) -> None:
    """The path of P over the entire motion; for an open task dotted, with the used part solid."""
    problem = subject.problem
    verdict = None if problem is None or problem.task.closed else subject.verdict
    style: dict[str, Any] = {"color": PATH, "linewidth": 1.6, "label": "path of P", "zorder": 2}
    signs = [int(scene.linkage.assembly)]
    if verdict is not None:
        extent = "full turn" if subject.sweep.turns else "full range"
        style |= {"linewidth": 0.8, "linestyle": ":", "label": f"path of P, {extent}"}
        signs = sorted(set(verdict.assembly.tolist()))
    for sign in signs:
        for track in scene.tracks(sign):
            axes.plot(*track.T, **style)
            style["label"] = None
    if verdict is not None and verdict.branch_ok:  # otherwise no motion joins the targets
        angles = np.linspace(verdict.theta2.min(), verdict.theta2.max(), 181)
        way = scene.path(angles, int(verdict.assembly[0]))
        axes.plot(*way.T, color=PATH, linewidth=1.6, label="path of P, first to last target", zorder=2)


def draw_scene(axes: Axes, problem: Problem) -> None:
    """Outlines of the scene, and hatched areas with the points that are kept out of them."""
    for index, outline in enumerate(problem.outlines):
        label = "scene" if index == 0 else None
        axes.plot(*outline.T, color=SCENE, linewidth=3, solid_joinstyle="miter", label=label, zorder=1)
    wanted = problem.requirements
    names = ", ".join(name if name in ("links", "body") else name.upper() for name in wanted.keep_out_for)
    for index, corners in enumerate(wanted.keep_out):
        label = f"kept out: {names}" if index == 0 else None
        axes.fill(
            *corners.T, facecolor="#d5d8dc", edgecolor=KEPT_OUT, hatch="///", linewidth=0.8, alpha=0.6,
            label=label, zorder=0.5,
        )  # fmt: skip


def draw_task(axes: Axes, subject: Subject) -> None:
    """The points of a path, or the body in every pose of a motion; about a dozen of many."""
    if subject.problem is None or subject.verdict is None:
        return
    state = solve_position(subject.linkage, subject.verdict.theta2, subject.verdict.assembly)
    draw_targets(axes, subject.problem.task, state.p, state.carrying + subject.linkage.body_angle)


def draw_targets(axes: Axes, task: Task, places: FloatArray, angles: FloatArray) -> None:
    """The same, with positions (N, 2) and angles (N,) for parts that a pose leaves free, or NaN."""
    if task.only_points:
        _draw_points(axes, task)
        return
    if task.fits_range:
        return
    for pose in _dozen(len(task)):
        _draw_pose(axes, task, pose, places[pose], float(angles[pose]))


def targets_shown(task: Task) -> list[int]:
    """Targets at which the linkage is drawn: all, or of many the first, the middle and the last."""
    count = len(task) - task.returns
    most = _CROWD_OF_POINTS if task.only_points else _CROWD
    return list(range(count)) if count <= most else [0, count // 2, count - 1]


def body_outline(task: Task, place: FloatArray, angle: float) -> FloatArray | None:
    """The corners of the body (M, 2) at a position and an angle (rad); None without a body."""
    if task.body is None or not task.has_angle.any():  # without angles it has no orientation
        return None
    corners: FloatArray = task.body @ _turned(angle).T + place
    return corners


def _draw_pose(axes: Axes, task: Task, pose: int, place: FloatArray, angle: float) -> None:
    """The body in a pose, dashed where position or angle is free and the given one is drawn."""
    placed, oriented = bool(task.has_position[pose]), bool(task.has_angle[pose])
    place = task.positions[pose] if placed else place
    angle = float(task.angles[pose]) if oriented else angle
    if np.isnan(place).any():  # free, and no position is given
        return
    corners = body_outline(task, place, angle)
    if corners is not None and np.isfinite(angle):
        style = "solid" if placed and oriented else "dashed"
        label = "body" if pose == 0 else None
        axes.fill(*corners.T, facecolor=BODY, alpha=0.15, zorder=2)
        axes.fill(
            *corners.T, facecolor="none", edgecolor=BODY, linewidth=1.2, linestyle=style, label=label,
            zorder=5,
        )  # fmt: skip
    if oriented:
        arrow = place + _turned(angle)[:, 0] * 0.08 * task.size
        look = {"arrowstyle": "->", "color": BODY}
        axes.annotate("", tuple(arrow), tuple(place), arrowprops=look, zorder=6)
    _number(axes, pose, place)


def _draw_points(axes: Axes, task: Task) -> None:
    """Target points as open circles under the path; about a dozen of many are numbered."""
    count = len(task) - task.returns
    size = float(np.clip(200 / count, 3, 8))
    axes.plot(
        *task.positions.T, linestyle="none", marker="o", markersize=size, markerfacecolor="none",
        markeredgecolor=TARGET, markeredgewidth=size / 6, label="target points", zorder=1.5,
    )  # fmt: skip
    for index in _dozen(count):
        _number(axes, index, task.positions[index])


def _number(axes: Axes, index: int, place: FloatArray) -> None:
    axes.annotate(
        f"{index + 1}", tuple(place), (-5, 5), textcoords="offset points", ha="right", color=PATH,
        weight="bold", zorder=8,
    )  # fmt: skip


def _dozen(count: int) -> range:
    """All of the targets, or about a dozen of many."""
    return range(0, count, 1 if count <= _NUMBERED else round(count / 12))


def _turned(angle: float) -> FloatArray:
    return np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
