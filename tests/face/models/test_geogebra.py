"""The formulas of the worksheet, evaluated by themselves, are the linkage."""

from __future__ import annotations

import math
import xml.etree.ElementTree as ET
import zipfile
from io import BytesIO
from typing import Any, NamedTuple

import numpy as np
import pytest

from grashof.analysis import solve_position
from grashof.models import Model, geogebra
from grashof.problems import load_linkage_spec


class Pair(NamedTuple):
    """A point as GeoGebra counts with it."""

    x: float
    y: float

    def __add__(self, other: Any) -> Pair:
        return Pair(self.x + other.x, self.y + other.y)

    def __rmul__(self, factor: Any) -> Pair:
        return Pair(factor * self.x, factor * self.y)


def worksheet(model: Model) -> ET.Element:
    with zipfile.ZipFile(BytesIO(geogebra(model))) as archive:
        assert archive.testzip() is None
        return ET.fromstring(archive.read("geogebra.xml"))  # noqa: S314  (our own)


def evaluated(root: ET.Element, driver: float) -> dict[str, Any]:
    """All labels of a worksheet, in its order; a formula that needs a later one fails."""
    known: dict[str, Any] = {
        "sqrt": math.sqrt, "cos": math.cos, "sin": math.sin,
        "x": lambda point: point.x, "y": lambda point: point.y, "Pair": Pair,
    }  # fmt: skip
    for line in root.iter("expression"):
        name, formula = line.attrib["label"], line.attrib["exp"].replace("^", "**")
        assert name not in known
        tree = compile(formula, name, "eval")
        value = driver if name == "t" else eval(tree, {"__builtins__": {}}, known)  # noqa: S307
        known[name] = Pair(*value) if isinstance(value, tuple) else value
    return known


def test_points_are_where_the_linkage_has_them(model: Model) -> None:
    root = pairs(worksheet(model))
    for driver in np.linspace(model.low, model.high, 23)[1:-1].tolist():
        at, known = solve_position(model.linkage, driver), evaluated(root, driver)
        for name in model.linkage.mechanism.moving:
            size = 1e-9 * float(model.linkage.lengths.max())
            assert tuple(known[name.upper()]) == pytest.approx(tuple(getattr(at, name)), abs=size)


def pairs(root: ET.Element) -> ET.Element:
    """The same with `(x, y)` written as `Pair(x, y)`."""
    for line in root.iter("expression"):
        line.attrib["exp"] = _paired(line.attrib["exp"])
    return root


def _paired(formula: str) -> str:
    """Brackets with a comma of their own are points."""
    opened: list[int] = []
    points: set[int] = set()
    for place, sign in enumerate(formula):
        if sign == "(":
            opened.append(place)
        elif sign == ",":
            points.add(opened[-1])
        elif sign == ")":
            opened.pop()
    return "".join(f"Pair{sign}" if place in points else sign for place, sign in enumerate(formula))


def test_the_slider_moves_as_the_driver_and_commands_name_what_exists(model: Model) -> None:
    root = worksheet(model)
    (slider,) = root.iter("slider")
    assert (float(slider.attrib["min"]), float(slider.attrib["max"])) == (model.low, model.high)
    assert model.low <= model.start <= model.high
    labels = [line.attrib["label"] for line in root.iter("expression")]
    used = [name for line in root.iter("input") for name in line.attrib.values()]
    assert set(used) <= set(labels)
    made = [name for line in root.iter("output") for name in line.attrib.values()]
    assert [line.attrib["label"] for line in root.iter("element")] == [*labels, *made]
    assert [line.attrib["name"] for line in root.iter("command")].count("Locus") == 1
    assert evaluated(pairs(root), model.start)["t"] == model.start


def test_the_same_linkage_gives_the_same_bytes() -> None:
    model = Model.of(load_linkage_spec("pumpjack"))
    assert geogebra(model) == geogebra(model)
