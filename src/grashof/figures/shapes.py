"""Moving elements of drawings as shapes: links, a cylinder, the body that P carries."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import Any, NamedTuple

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.patches import Polygon

from grashof.analysis import Position
from grashof.analysis.cylinder.lengths import cylinder_state
from grashof.analysis.effort.parts import part_ends
from grashof.analysis.judge.cylinder_drive import figures_of
from grashof.analysis.mechanism.kinematics import virtual_motion
from grashof.drawing.scene import CORNERS, Scene
from grashof.figures.parts import COLOURS, COUPLER, GROUND, PATH, SCENE
from grashof.figures.subject import Subject
from grashof.problems.values.arrays import FloatArray

Placement = dict[str, FloatArray]  # places (2,) of the points in one position, by name
_BASE, _END, _PIVOT = _CYLINDER = ("base", "end", "pivot")
_ROD = "#aab2b9"  # of a cylinder
_SHARE = 0.9  # length of the body of a cylinder over its closed length


def placements(subject: Subject, scene: Scene, state: Position) -> list[Placement]:
    """Places of all points in each of N positions."""
    found = scene.places(state) | _cylinder_places(subject, state) | _strut_places(subject, state)
    return [{name: place[k] for name, place in found.items()} for k in range(len(state.theta2))]


def _cylinder_places(subject: Subject, state: Position) -> dict[str, FloatArray]:
    """Base, end of the body and pivot of the cylinder in N positions, (N, 2) each; empty without one."""
    verdict, problem = subject.verdict, subject.problem
    if verdict is None or problem is None or verdict.cylinder is None:
        return {}
    found = cylinder_state(verdict.cylinder, subject.linkage, state)
    figures = figures_of(subject.linkage, problem.task, verdict)
    closed = float(found.length.min()) if figures is None else figures.closed
    base = np.broadcast_to(np.asarray(verdict.cylinder.base), found.pivot.shape)
    share = np.minimum(_SHARE * closed / np.maximum(found.length, 1e-300), 1.0)[:, None]
    return dict(zip(_CYLINDER, (base, base + share * (found.pivot - base), found.pivot), strict=True))


def _strut_places(subject: Subject, state: Position) -> dict[str, FloatArray]:
    """Both pivots of each strut or spring, and the end of its body, in N positions, shape (N, 2) each."""
    if not subject.struts:
        return {}
    _, rest = virtual_motion(subject.linkage, state.theta2, np.copysign(1.0, state.margins[0]))
    found: dict[str, FloatArray] = {}
    for number, part in enumerate(subject.struts):
        first, last = part_ends(part, subject.linkage, rest)
        length = np.maximum(np.hypot(*(last - first).T), 1e-300)
        body = _SHARE * part.sizes[0].compressed if part.sense > 0 else 0.0
        end = first + np.minimum(body / length, 1.0)[:, None] * (last - first)
        found |= dict(zip(_strut(number), (first, end, last), strict=True))
    return found


def _strut(number: int) -> tuple[str, ...]:
    """Names of the points of a strut."""
    return tuple(f"strut {number} {name}" for name in _CYLINDER)


class Shape(NamedTuple):
    """A line through points, or the area within them, with its style in matplotlib."""

    points: tuple[str, ...]
    look: dict[str, Any]
    filled: bool = False


def shapes_of(subject: Subject, scene: Scene, placement: Placement, *, named: bool = True) -> Iterator[Shape]:
    """The moving shapes in the position in which they are drawn first; `named` if they are in the legend."""
    for body in sorted(scene.bodies, key=lambda body: len(body.link.points)):
        label = body.words if named else None
        width = 2.4 if len(body.link.points) == 2 else 1.6
        for points in body.lines(placement):
            look = {"color": COLOURS[body.role], "linewidth": width, "label": label, "zorder": 4}
            yield Shape(points, look)
            label = None
    kind = scene.linkage.mechanism
    joints = tuple(name for name in kind.moving if name in kind.joints)
    yield Shape(joints, _dots("white", COUPLER, 5, 5))
    yield Shape(("p",), _dots(PATH, PATH, 4, 6))
    for body in scene.bodies:
        for points in body.areas(placement):
            alpha = 0.25 if points is CORNERS else 0.1
            look = {"color": COLOURS[body.role], "linewidth": 0, "alpha": alpha, "zorder": 3}
            yield Shape(points, look, filled=True)
    if (cylinder := subject.cylinder) is not None:
        body = scene.bodies[cylinder.link - 2]
        bracket = (body.link.points[0], _PIVOT, body.link.points[:2][-1])  # a slider has one point alone
        yield Shape(bracket, {"color": COLOURS[body.role], "linewidth": 1.0, "zorder": 3.1})
        look = {"solid_capstyle": "butt", "zorder": 3.2}
        yield Shape((_END, _PIVOT), {"color": _ROD, "linewidth": 2.6, **look})
        label = "cylinder" if named else None
        yield Shape((_BASE, _END), {"color": SCENE, "linewidth": 6.5, "label": label, **look})
        yield Shape((_BASE, _PIVOT), _dots("white", GROUND, 5, 5.5))
    label = "strut or spring" if named else None
    for number in range(len(subject.struts)):
        first, end, last = _strut(number)
        look = {"solid_capstyle": "butt", "zorder": 3.2}
        yield Shape((end, last), {"color": _ROD, "linewidth": 2.0, **look})
        yield Shape((first, end), {"color": SCENE, "linewidth": 4.5, "label": label, **look})
        yield Shape((first, last), _dots("white", GROUND, 4, 5.5))
        label = None


def _dots(colour: str, edge: str, size: float, zorder: float) -> dict[str, Any]:
    look = {"marker": "o", "linestyle": "none", "color": colour, "markeredgecolor": edge}
    return look | {"markersize": size, "zorder": zorder}


class Drawn:
    """Shapes drawn in one position, to be moved to others; `shade` is from 0, invisible, to 1."""

    def __init__(self, axes: Axes, shapes: Iterable[Shape], placement: Placement, shade: float = 1.0) -> None:
        self._drawn: list[tuple[tuple[str, ...], Line2D | Polygon]] = []
        for points, look, filled in shapes:
            draw = axes.fill if filled else axes.plot
            artists = draw(*_at(placement, points).T, **look | {"alpha": look.get("alpha", 1.0) * shade})
            self._drawn += [(points, artist) for artist in artists]

    @property
    def artists(self) -> list[Artist]:
        """The moving artists."""
        return [artist for _, artist in self._drawn]

    def move(self, placement: Placement) -> None:
        """Move the shapes to new places of their points."""
        for points, artist in self._drawn:
            corners = _at(placement, points)
            if isinstance(artist, Polygon):
                artist.set_xy(corners)
            else:
                artist.set_data(*corners.T)


def _at(placement: Placement, points: Sequence[str]) -> FloatArray:
    return np.array([placement[name] for name in points])
