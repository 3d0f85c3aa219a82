"""A document for Linkage has the linkage's lengths, its assembly and its slide."""

import xml.etree.ElementTree as ET

import numpy as np
import pytest

from grashof.analysis import solve_position
from grashof.models import Model, linkage2
from grashof.problems import FourBar, InvertedSliderCrank, ProblemError, SliderCrank


def opened(model: Model) -> ET.Element:
    return ET.fromstring(linkage2(model))  # noqa: S314  (our own)


def places(root: ET.Element) -> dict[str, np.ndarray]:
    found = root.findall("connector")
    assert len({each.attrib["id"] for each in found}) == len(found)
    return {each.attrib["name"]: np.array([float(each.attrib[axis]) for axis in "xy"]) for each in found}


def distance(one: np.ndarray, other: np.ndarray) -> float:
    return float(np.hypot(*(one - other)))


def test_read_back(model: Model) -> None:
    if isinstance(model.linkage, InvertedSliderCrank):
        with pytest.raises(ProblemError, match="four-bar or a slider-crank"):
            linkage2(model)
        return
    root, mm = opened(model), 1000 * model.metre
    assert root.tag == "linkage2"
    at, where = model.first, places(root)
    for name in model.linkage.mechanism.moving:
        np.testing.assert_allclose(where[name.upper()], mm * getattr(at, name), rtol=1e-12)
    assert distance(where["O2"], where["A"]) == pytest.approx(mm * float(model.linkage.r2), rel=1e-12)
    ids = {each.attrib["id"]: each for each in root.findall("connector")}
    joined = {
        link.attrib["name"]: {ids[end.attrib["id"]].attrib["name"] for end in link}
        for link in root.findall("Link")
    }
    assert joined["driver"] == {"O2", "A"}
    assert joined["coupler"] == {"A", "B", "P"}
    assert [each.attrib["name"] for each in ids.values() if each.get("input") == "true"] == ["O2"]
    assert [each.attrib["name"] for each in ids.values() if each.get("draw") == "true"] == ["P"]
    anchored = {name for name, each in zip(where, ids.values(), strict=True) if each.get("anchor") == "true"}
    if isinstance(model.linkage, FourBar):
        assert anchored == {"O2", "O4"}
        assert distance(where["B"], where["O4"]) == pytest.approx(mm * float(model.linkage.r4), rel=1e-12)
    else:
        assert anchored == {"O2", *joined["guide"]}


def test_b_stays_within_its_guide(model: Model) -> None:
    if not isinstance(model.linkage, SliderCrank):
        pytest.skip("no guide")
    root = opened(model)
    (slider,) = [each for each in root.findall("connector") if each.get("slider") == "true"]
    names = {each.attrib["id"]: each.attrib["name"] for each in root.findall("connector")}
    where = places(root)
    start, end = (where[names[each.attrib["id"]]] for each in slider.findall("slidelimit"))
    b = 1000 * model.metre * solve_position(model.linkage, np.linspace(model.low, model.high, 500)[1:-1]).b
    share = (b - start) @ (end - start) / distance(start, end) ** 2
    assert 0 < share.min() < 0.15
    assert 0.85 < share.max() < 1
    along = (end - start) / distance(start, end)
    beside = (b - start) @ np.array([-along[1], along[0]])
    assert np.abs(beside).max() < 1e-9 * distance(start, end)
