"""A linkage as a document of the program Linkage by David Rector (.linkage2)."""

from __future__ import annotations

import xml.etree.ElementTree as ET

import numpy as np

from grashof.drawing.scene import Scene, Slide
from grashof.models.model import Model, add
from grashof.problems import ProblemError
from grashof.problems.values.arrays import FloatArray

_UNITS = {"mm": "Millimeters", "in": "Inches"}  # units of the program
_LONGER = 0.1  # of the travel, added to a guide at each end
_RPM = 15.0  # as the program has it


def linkage2(model: Model) -> str:
    """A document with the linkage at the beginning of its motion, where the program continues.

    Places are in mm, as the program counts. The driver turns at the speed of the file, or at 15 rpm.

    Parameters
    ----------
    model : Model

    Returns
    -------
    str

    Raises
    ------
    ProblemError
        The program has no block that swings about a pivot, and no slider that carries a point.

    Examples
    --------
    >>> from grashof.problems import load_linkage_spec
    >>> linkage2(Model.of(load_linkage_spec("pumpjack"))).count("<Link ")
    3
    """
    kind, scene = model.linkage.mechanism, Scene(model.linkage, (np.linspace(model.low, model.high, 721),))
    fixed = dict(scene.ground)
    links = {body.link.name: body.link.points for body in scene.bodies if len(body.link.points) > 1}
    guided = dict[str, tuple[str, str]]()
    for slide in scene.slides:
        if slide.carried:
            raise ProblemError(
                "--linkage2 is for a four-bar or a slider-crank; Linkage has no block that swings about "
                "a pivot"
            )
        slider, guide = kind.links[slide.slider - 1].name, f"guide{slide.ending}"
        if slider in links:
            raise ProblemError(
                f"--linkage2 cannot hold a {kind.word} with P on its {slider}: a slider of Linkage is a point"
            )
        links[guide] = guided[slide.pin] = f"{guide} start", f"{guide} end"
        fixed |= zip(links[guide], _guide(model, scene, slide), strict=True)
    places = fixed | {name: getattr(model.first, name) for name in kind.moving}
    root = ET.Element("linkage2")
    shown = {"units": _UNITS.get(model.spec.length_unit, _UNITS["mm"])}
    add(root, "program", zoom="1", xoffset="0", yoffset="0", scalefactor="1", **shown)
    dynamics = model.spec.dynamics
    rpm = _RPM if dynamics is None else float(abs(dynamics.speed_rpm))
    ids = {name: str(number) for number, name in enumerate(places)}
    for name, place in places.items():
        x, y = (1000 * model.metre * place).tolist()
        connector = add(root, "connector", id=ids[name], name=name.upper(), x=repr(x), y=repr(y))
        connector.attrib |= {"anchor": "true"} if name in fixed else {}
        connector.attrib |= {"input": "true", "rpm": repr(rpm)} if name == "o2" else {}
        connector.attrib |= {"draw": "true"} if name == "p" else {}
        if name in guided:
            connector.set("slider", "true")
        for end in guided.get(name, ()):
            add(connector, "slidelimit", id=ids[end])
    for number, (name, joined) in enumerate(links.items()):
        link = add(root, "Link", id=str(number), name=name)
        for point in joined:
            add(link, "connector", id=ids[point])
    ET.indent(root, "\t")
    return ET.tostring(root, encoding="unicode") + "\n"


def _guide(model: Model, scene: Scene, slide: Slide) -> FloatArray:
    """Ends of a guide on the ground that is somewhat longer than the travel of its slider, shape (2, 2)."""
    low, high = scene.reach(slide)
    ends = np.array([low, high]) + _LONGER * (high - low) * np.array([-1, 1])
    along = np.array([np.cos(slide.angle), np.sin(slide.angle)])
    return model.first.point(slide.pin) + np.outer(ends - slide.travel(model.first), along)
