"""A linkage as a model for MuJoCo: a tree of bodies, and one equality that closes the loop."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Callable, Iterable
from itertools import combinations
from typing import NamedTuple, cast

import numpy as np

from grashof.models.model import Model
from grashof.models.xml import add
from grashof.problems import FourBar, InvertedSliderCrank, Linkage, SliderCrank
from grashof.problems.values.arrays import FloatArray

STEPS = 50_000  # in a turn of the driver: the loop then stays closed to a millionth of a radian
_LIGHT = 1e-4  # share of the heaviest link: what a link without mass has, as MuJoCo wants some
_LEAST = 1e-14  # kg, kg m^2: MuJoCo refuses less than 1e-15
_STIFF = 30.0  # of the drive: its gain over what inertia and weight ask of it
_THICK = 0.02  # of bars, as a share of the longest link
_COLOURS = ("0.30 0.47 0.66 1", "0.95 0.56 0.17 1", "0.35 0.63 0.31 1")


class _Joint(NamedTuple):
    """The joint of a body with its parent: its axis there, and its coordinate where the motion begins."""

    name: str
    value: float
    axis: tuple[float, float, float] = (0, 0, 1)
    type: str = "hinge"


class _Link(NamedTuple):
    """A link in the tree: its frame in that of its parent where the motion begins, and points on it."""

    number: int
    place: FloatArray
    angle: float
    joint: _Joint
    points: dict[str, FloatArray]
    children: tuple[_Link, ...] = ()


class _Loop(NamedTuple):
    """Two links that share a point, which is given in the frame of the first."""

    one: int
    other: int
    anchor: FloatArray


def mjcf(model: Model) -> str:
    """A model in MJCF: lengths in m, masses in kg, the motion in the x-y plane.

    Coordinates are theta2 and theta4 (of a rod: theta3) from the x-axis, and the angle in A; of slides their
    travel. The model stands assembled at the driver angle it begins from, and a drive turns it steadily.
    Gravity and masses are those of the file, or bars of 1 kg/m; friction, springs and loads are left out.

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
    trees, loop = _TREES[type(model.linkage)](model)
    for link in trees:
        _add(world, link, model, size)
    names = {link.number: link.name for link in model.linkage.mechanism.links}
    closed = add(root, "equality")
    stiff = {"solref": _numbers((2 * turn / STEPS, 1)), "solimp": "0.9999 0.9999 0.001 0.5 2"}
    ends = {"body1": names[loop.one], "body2": names[loop.other]}
    add(closed, "connect", **ends, anchor=_numbers((*loop.anchor * model.metre, 0)), **stiff)
    gain = _gain(model, float(np.hypot(*gravity)))
    drive = {"gainprm": _number(gain), "biasprm": _numbers((gain * model.omega2, 0, -gain))}
    actuators = add(root, "actuator")
    actuators.append(ET.Comment(" steady; what the control gives is added to the speed, rad/s "))
    add(actuators, "general", name="drive", joint="O2", biastype="affine", **drive)
    ET.indent(root)
    return ET.tostring(root, encoding="unicode") + "\n"


def _add(parent: ET.Element, link: _Link, model: Model, size: float) -> None:
    """Add a link, and those that hang on it."""
    metre, name = model.metre, model.linkage.mechanism.links[link.number - 1].name
    place = {"pos": _numbers((*link.place * metre, 0)), "euler": _numbers((0, 0, link.angle))}
    body = add(parent, "body", name=name, **place)
    joint = link.joint
    ref = joint.value * (1 if joint.type == "hinge" else metre)
    add(body, "joint", name=joint.name, type=joint.type, axis=_numbers(joint.axis), ref=_number(ref))
    mass = model.masses.of(link.number)
    least = _LIGHT * max(float(model.masses.of(number).mass) for number in (2, 3, 4))
    inertia = _number(max(float(mass.inertia) * metre**2, least * (_THICK * size) ** 2, _LEAST))
    weight = _number(max(float(mass.mass), least, _LEAST))
    centre = _numbers((*mass.centre * metre, 0))
    add(body, "inertial", pos=centre, mass=weight, diaginertia=" ".join([inertia] * 3))
    look = {"rgba": _COLOURS[link.number - 2], "contype": "0", "conaffinity": "0"}
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
    for child in link.children:
        _add(body, child, model, size)


def _gain(model: Model, gravity: float) -> float:
    """Of the drive, N m s/rad: so high that inertia and weight slow it by few percent."""
    furthest = max(float(model.linkage.lengths.max()), float(np.hypot(*model.linkage.coupler_point)))
    reach, speed = furthest * model.metre, abs(model.omega2)
    weight = float(model.masses.total)
    turning = sum(float(model.masses.of(link).inertia) for link in (2, 3, 4)) * model.metre**2
    return _STIFF * ((weight * reach**2 + turning) * speed + weight * gravity * reach / speed)


def _four_bar(model: Model) -> tuple[list[_Link], _Loop]:
    linkage, at = cast(FourBar, model.linkage), model.first
    driver = _crank(model, _coupler(model))
    angle = float(at.theta4)
    output = _Link(4, linkage.o4, angle, _Joint("O4", angle), {"B4": np.array([float(linkage.r4), 0.0])})
    return [driver, output], _Loop(3, 4, np.array([float(linkage.r3), 0.0]))


def _slider_crank(model: Model) -> tuple[list[_Link], _Loop]:
    linkage, at = cast(SliderCrank, model.linkage), model.first
    slide = _Joint("slide", float(at.travel), (1, 0, 0), "slide")
    slider = _Link(4, at.b, float(linkage.slide_angle), slide, {})
    return [_crank(model, _coupler(model)), slider], _Loop(3, 4, np.array([float(linkage.r3), 0.0]))


def _inverted(model: Model) -> tuple[list[_Link], _Loop]:
    """The rod hangs on the block, and the loop closes in A."""
    linkage, at = cast(InvertedSliderCrank, model.linkage), model.first
    travel = float(at.travel)
    slide = _Joint("slide", travel, (-1, 0, 0), "slide")
    points = {"P": linkage.coupler_point, "B": np.array([travel, 0.0])}
    rod = _Link(3, np.array([float(linkage.offset), travel]), -np.pi / 2, slide, points)
    angle = float(at.theta4)
    block = _Link(4, linkage.o4, angle, _Joint("O4", angle), {}, (rod,))
    return [_crank(model), block], _Loop(2, 3, np.array([float(linkage.r2), 0.0]))


def _crank(model: Model, *children: _Link) -> _Link:
    linkage, angle = model.linkage, model.start
    return _Link(
        2, linkage.o2, angle, _Joint("O2", angle), {"A": np.array([float(linkage.r2), 0.0])}, children
    )


def _coupler(model: Model) -> _Link:
    linkage, angle = cast(FourBar | SliderCrank, model.linkage), float(model.first.theta3 - model.start)
    points = {"B": np.array([float(linkage.r3), 0.0]), "P": linkage.coupler_point}
    return _Link(3, np.array([float(linkage.r2), 0.0]), angle, _Joint("A", angle), points)


_TREES: dict[type[Linkage], Callable[[Model], tuple[list[_Link], _Loop]]] = {
    FourBar: _four_bar,
    SliderCrank: _slider_crank,
    InvertedSliderCrank: _inverted,
}


def _number(value: float) -> str:
    return repr(float(value))


def _numbers(values: Iterable[float]) -> str:
    return " ".join(map(_number, values))
