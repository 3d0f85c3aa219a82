"""A linkage as a model for MuJoCo: a tree of bodies, and an equality that closes each loop."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Iterable
from itertools import combinations
from typing import NamedTuple

import numpy as np

from grashof.drawing.scene import Scene
from grashof.models.model import Model, add
from grashof.problems.values.arrays import FloatArray
from grashof.problems.values.linkages.mechanism import Link

STEPS = 50_000  # in a turn of the driver: the loop then stays closed to a millionth of a radian
_LIGHT = 1e-4  # of the heaviest link, for links without mass, which MuJoCo refuses
_LEAST = 1e-14  # kg, kg m^2: MuJoCo refuses less than 1e-15
_STIFF = 30.0  # gain of the drive over the demand of inertia and weight
_THICK = 0.02  # of bars, as a share of the longest link
_COLOURS = (
    "0.30 0.47 0.66 1",
    "0.95 0.56 0.17 1",
    "0.35 0.63 0.31 1",
    "0.69 0.48 0.63 1",
    "0.46 0.72 0.70 1",
)


class _Joint(NamedTuple):
    """The joint of a body with its parent: its axis there, and its coordinate where the motion begins."""

    name: str
    value: float
    axis: tuple[float, float, float] = (0, 0, 1)
    type: str = "hinge"


class _Body(NamedTuple):
    """A link in the tree: its frame in that of its parent where the motion begins, and points on it."""

    link: Link
    parent: int
    place: FloatArray
    angle: float
    joint: _Joint
    points: dict[str, FloatArray]


class _Loop(NamedTuple):
    """Two links that share a point, which is given in the frame of the first."""

    one: int
    other: int
    anchor: FloatArray


def mjcf(model: Model) -> str:
    """A model in MJCF: lengths in m, masses in kg, the motion in the x-y plane.

    Coordinates are the angles of links on the ground from the x-axis (of a block: theta4), those in A, C and
    D of links on moving ones, and the travel of slides. The model is assembled at the first driver
    angle, and a drive turns it steadily. Gravity and masses are those of the file, or bars of 1 kg/m;
    friction, springs and loads are left out.

    Parameters
    ----------
    model : Model

    Returns
    -------
    str

    Examples
    --------
    >>> from grashof.problems import load_linkage_spec
    >>> "<connect " in mjcf(Model.of(load_linkage_spec("engine")))
    True
    """
    root = ET.Element("mujoco", model=model.spec.name)
    root.append(ET.Comment(" made by Grashof; m, kg, rad "))
    add(root, "compiler", angle="radian", autolimits="true")
    turn = 2 * np.pi / abs(model.omega2)
    gravity = model.spec.dynamics.gravity if model.spec.dynamics is not None else (0.0, 0.0)
    option = {"timestep": _number(turn / STEPS), "gravity": _numbers((*gravity, 0.0))}
    add(root, "option", **option, integrator="implicitfast")
    size = float(model.linkage.lengths.max()) * model.metre
    world = add(root, "worldbody")
    add(world, "light", pos=_numbers((0, 0, 5 * size)), dir="0 0 -1", directional="true")
    bodies, loops = _tree(model)
    for body in bodies.values():
        if body.parent == 1:
            _add(world, body, bodies, model, size)
    closed = add(root, "equality")
    stiff = {"solref": _numbers((2 * turn / STEPS, 1)), "solimp": "0.9999 0.9999 0.001 0.5 2"}
    for loop in loops:
        ends = {"body1": bodies[loop.one].link.name, "body2": bodies[loop.other].link.name}
        add(closed, "connect", **ends, anchor=_numbers((*loop.anchor * model.metre, 0)), **stiff)
    gain = _gain(model, float(np.hypot(*gravity)))
    drive = {"gainprm": _number(gain), "biasprm": _numbers((gain * model.omega2, 0, -gain))}
    actuators = add(root, "actuator")
    actuators.append(ET.Comment(" steady; what the control gives is added to the speed, rad/s "))
    add(actuators, "general", name="drive", joint="O2", biastype="affine", **drive)
    ET.indent(root)
    return ET.tostring(root, encoding="unicode") + "\n"


def _add(parent: ET.Element, link: _Body, bodies: dict[int, _Body], model: Model, size: float) -> None:
    """Add a link and its children."""
    metre, number = model.metre, link.link.number
    place = {"pos": _numbers((*link.place * metre, 0)), "euler": _numbers((0, 0, link.angle))}
    body = add(parent, "body", name=link.link.name, **place)
    joint = link.joint
    ref = joint.value * (1 if joint.type == "hinge" else metre)
    add(body, "joint", name=joint.name, type=joint.type, axis=_numbers(joint.axis), ref=_number(ref))
    mass = model.masses.of(number)
    least = _LIGHT * max(float(model.masses.of(each).mass) for each in bodies)
    inertia = _number(max(float(mass.inertia) * metre**2, least * (_THICK * size) ** 2, _LEAST))
    weight = _number(max(float(mass.mass), least, _LEAST))
    centre = _numbers((*mass.centre * metre, 0))
    add(body, "inertial", pos=centre, mass=weight, diaginertia=" ".join([inertia] * 3))
    look = {"rgba": _COLOURS[number - 2], "contype": "0", "conaffinity": "0"}
    thick = _number(_THICK * size)
    points = {"": np.zeros(2)} | link.points
    for one, other in combinations(points.values(), 2):
        if np.hypot(*(one - other)) * metre <= _THICK * size:  # too short to be drawn
            continue
        ends = _numbers((*one * metre, 0, *other * metre, 0))
        add(body, "geom", type="capsule", fromto=ends, size=thick, **look)
    if len(points) == 1:
        add(body, "geom", type="box", size=" ".join([_number(2 * _THICK * size)] * 3), **look)
    for point, at in link.points.items():
        add(body, "site", name=point, pos=_numbers((*at * metre, 0)), size=thick)
    for child in bodies.values():
        if child.parent == number:
            _add(body, child, bodies, model, size)


def _gain(model: Model, gravity: float) -> float:
    """Gain of the drive, N m s/rad: inertia and weight slow it by few percent."""
    furthest = max(float(model.linkage.lengths.max()), float(np.hypot(*model.linkage.coupler_point)))
    reach, speed = furthest * model.metre, abs(model.omega2)
    weight = float(model.masses.total)
    moving = (link.number for link in model.linkage.mechanism.links[1:])
    turning = sum(float(model.masses.of(number).inertia) for number in moving) * model.metre**2
    return _STIFF * ((weight * reach**2 + turning) * speed + weight * gravity * reach / speed)


def _tree(model: Model) -> tuple[dict[int, _Body], list[_Loop]]:
    """The bodies by the numbers of their links, and the closure of each loop: in E, or of a rod in C.

    The parent of the first link of a dyad is the host of C, that of the second the host of D, that of a rod
    its block.
    """
    scene, at, kind = Scene(model.linkage), model.first, model.linkage.mechanism
    frames = {link.number: scene.frame(link) for link in kind.links}
    angles = {1: 0.0} | {number: float(angle) for number, angle in at.angles.items()}
    bodies, loops = dict[int, _Body](), list[_Loop]()

    def pin(number: int, host: int, joint: str, points: dict[str, FloatArray]) -> None:
        """Pin a link by its origin."""
        link, angle = kind.links[number - 1], angles[number] - angles[host]
        place = frames[host][link.points[0]]
        bodies[number] = _Body(link, host, place, angle, _Joint(joint, angle), points)

    pin(2, 1, "O2", _named(frames[2]))
    slides = {slide.loop: slide for slide in scene.slides}
    for number, loop in enumerate(kind.loops):
        (first, second), (on_c, on_d), slide = loop.links, loop.dyad.hosts, slides.get(number)
        points, e = _named(frames[second]), loop.e.upper()
        if slide is None or not slide.carried:
            pin(first, on_c, loop.c.upper(), _named(frames[first]))
            loops.append(_Loop(first, second, frames[first][loop.e]))
        if slide is None:
            points[f"{e}{second}"] = points.pop(e)
            pin(second, on_d, loop.d.upper(), points)
            continue
        travel, name = float(slide.travel(at)), f"slide{slide.ending}"
        if slide.carried:
            pin(second, on_d, loop.d.upper(), {})
            place, joint = np.array([-slide.offset, travel]), _Joint(name, travel, (-1, 0, 0), "slide")
            points = _named(frames[first]) | {e: np.array([travel, 0.0])}
            bodies[first] = _Body(kind.links[first - 1], second, place, -np.pi / 2, joint, points)
            loops.append(_Loop(on_c, first, frames[on_c][loop.c]))
        else:
            joint = _Joint(name, travel, (1, 0, 0), "slide")
            bodies[second] = _Body(kind.links[second - 1], 1, at.point(slide.pin), slide.angle, joint, points)
    return bodies, loops


def _named(frame: dict[str, FloatArray]) -> dict[str, FloatArray]:
    """Points of a link but for its origin, as they are named in the model."""
    return {name.upper(): at for name, at in list(frame.items())[1:]}


def _number(value: float) -> str:
    return repr(float(value))


def _numbers(values: Iterable[float]) -> str:
    return " ".join(map(_number, values))
