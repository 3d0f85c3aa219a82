"""A document for Linkage has the linkage's lengths, its assembly and its slide."""

import xml.etree.ElementTree as ET

import numpy as np
import pytest
from refusals import refusal

from grashof.analysis import solve_position
from grashof.models import Model, linkage2
from grashof.problems.values.linkages.mechanism import DyadKind


def opened(model: Model) -> ET.Element:
    return ET.fromstring(linkage2(model))  # noqa: S314  (our own)


def places(root: ET.Element) -> dict[str, np.ndarray]:
    found = root.findall("connector")
    assert len({each.attrib["id"] for each in found}) == len(found)
    return {each.attrib["name"]: np.array([float(each.attrib[axis]) for axis in "xy"]) for each in found}


def distance(one: np.ndarray, other: np.ndarray) -> float:
    return float(np.hypot(*(one - other)))


def opened_or_skipped(model: Model) -> ET.Element:
    """A document; what the program cannot hold is refused in one line."""
    kind = model.linkage.mechanism
    if kind.dyads[0].kind is DyadKind.RPR:
        said = "four-bar or a slider-crank"
    elif kind.dyads[-1].kind is DyadKind.RRP and kind.carries == 2 * len(kind.dyads) + 2:
        said = f"--linkage2 cannot hold a {kind.word} with P on its slider-2"
    else:
        return opened(model)
    (line,) = refusal(linkage2, model).splitlines()
    assert said in line
    pytest.skip("refused")


def test_read_back(model: Model) -> None:
    root, mm, linkage = opened_or_skipped(model), 1000 * model.metre, model.linkage
    kind = linkage.mechanism
    assert root.tag == "linkage2"
    at, where = model.first, places(root)
    for name in kind.points:
        np.testing.assert_allclose(where[name.upper()], mm * at.point(name), rtol=1e-12)
    ids = {each.attrib["id"]: each for each in root.findall("connector")}
    joined = {
        link.attrib["name"]: {ids[end.attrib["id"]].attrib["name"] for end in link}
        for link in root.findall("Link")
    }
    guides = [joined.pop(name) for name in [*joined] if name.startswith("guide")]
    assert len(guides) == len(kind.slides)
    assert joined == {link.name: {*link.labels} for link in kind.links[1:] if len(link.points) > 1}
    assert [each.attrib["name"] for each in ids.values() if each.get("input") == "true"] == ["O2"]
    assert [each.attrib["name"] for each in ids.values() if each.get("draw") == "true"] == ["P"]
    anchored = {name for name, each in zip(where, ids.values(), strict=True) if each.get("anchor") == "true"}
    assert anchored == {name.upper() for name in kind.ground}.union(*guides)
    for name in ("r2", "r3", "r4", "r5", "r6"):
        if name in kind.lengths:
            one, other = kind.links[int(name[1]) - 1].labels[:2]
            assert distance(where[one], where[other]) == pytest.approx(mm * float(getattr(linkage, name)))


def test_a_slider_stays_within_its_guide(model: Model) -> None:
    kind = model.linkage.mechanism
    if all(dyad.kind is not DyadKind.RRP for dyad in kind.dyads):
        pytest.skip("no guide")
    root = opened_or_skipped(model)
    (slider,) = [each for each in root.findall("connector") if each.get("slider") == "true"]
    assert slider.attrib["name"] == ("B" if len(kind.dyads) == 1 else "E")
    names = {each.attrib["id"]: each.attrib["name"] for each in root.findall("connector")}
    where = places(root)
    start, end = (where[names[each.attrib["id"]]] for each in slider.findall("slidelimit"))
    moving = solve_position(model.linkage, np.linspace(model.low, model.high, 500)[1:-1])
    b = 1000 * model.metre * moving.point(slider.attrib["name"].lower())
    share = (b - start) @ (end - start) / distance(start, end) ** 2
    assert 0 < share.min() < 0.15
    assert 0.85 < share.max() < 1
    along = (end - start) / distance(start, end)
    beside = (b - start) @ np.array([-along[1], along[0]])
    assert np.abs(beside).max() < 1e-9 * distance(start, end)
