"""Struts in drawings, and as pages have them: their ends are those of the linkage in each position."""

from dataclasses import replace

import matplotlib.pyplot as plt
import numpy as np
from page_parts import LID, placed_lid

from grashof.analysis import solve_position
from grashof.drawing.scene import Scene
from grashof.figures.shapes import placements, shapes_of
from grashof.figures.subject import Subject
from grashof.page.struts import strut_data
from grashof.problems import Box, load_linkage_spec


def test_drawings_have_struts_between_their_pivots() -> None:
    spec = placed_lid()
    subject, theta2 = Subject.of(spec), np.radians([60.0, 85.0, 110.0])
    scene = Scene(subject.linkage, (theta2,))
    for place, angle in zip(
        placements(subject, scene, solve_position(spec.linkage, theta2)), theta2, strict=True
    ):
        head = np.exp(1j * angle) * (120 + 20j)
        np.testing.assert_allclose(place["strut 0 base"], [10, -50])
        np.testing.assert_allclose(place["strut 0 pivot"], [head.real, head.imag])
        body = np.hypot(*(place["strut 0 end"] - place["strut 0 base"]))
        assert body <= 0.9 * subject.struts[0].sizes[0].compressed + 1e-9
        assert any(shape.look.get("label") == "strut or spring" for shape in shapes_of(subject, scene, place))
    plt.close("all")


def test_areas_are_not_drawn_as_struts() -> None:
    spec = load_linkage_spec(str(LID))
    assert Subject.of(spec).struts == ()
    assert strut_data(spec.linkage, None if spec.dynamics is None else spec.dynamics.effort) == {}


def test_pages_have_both_ends_by_their_links() -> None:
    spec = placed_lid()
    assert spec.dynamics is not None
    (strut,) = strut_data(spec.linkage, spec.dynamics.effort)["struts"]
    assert strut["ends"] == [{"link": 1, "at": (10, -50)}, {"link": 2, "at": (120, 20)}]
    assert spec.dynamics.effort is not None
    (part,) = spec.dynamics.effort.parts
    pulls = replace(
        part, kind="tension", between=(part.places[0], replace(part.places[1], at=Box((1, 1), (2, 2))))
    )
    effort = replace(spec.dynamics.effort, parts=(pulls,))
    assert strut_data(spec.linkage, effort)["struts"][0]["body"] == 0
