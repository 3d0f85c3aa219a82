"""The scene of a linkage: its slides lie where its motion has them, whatever guides them."""

from __future__ import annotations

import numpy as np
import pytest
from linkages_of_rows import SIX_BARS

from grashof.analysis import solve_position
from grashof.drawing.scene import Scene
from grashof.problems import FourBar, InvertedSliderCrank, Linkage, SliderCrank

SLIDER = SliderCrank((0.5, -1), 1, 3, 0.4, 0.6, (1, 0.7), -1)
INVERTED = InvertedSliderCrank((0.2, 0.1), (2, 1), 1, -0.3, (3, 0.5))
SLIDING = [SLIDER, INVERTED, *(each for each in SIX_BARS.values() if each.mechanism.slides)]
PINNED = [
    FourBar((0, 0), (4, 0), 1, 4, 3),
    *(each for each in SIX_BARS.values() if not each.mechanism.slides),
]


@pytest.mark.parametrize("linkage", SLIDING)
def test_a_pin_runs_along_the_line_of_its_slide(linkage: Linkage) -> None:
    theta2 = np.linspace(0, 2 * np.pi, 73)
    scene, state = Scene(linkage, (theta2,)), solve_position(linkage, theta2)
    (slide,) = scene.slides
    origin, pin = (
        state.point(name) @ np.array([1, 1j])
        for name in (linkage.mechanism.links[slide.guide - 1].points[0], slide.pin)
    )
    place = (pin - origin) * np.exp(-1j * slide.direction(state))
    np.testing.assert_allclose(place.real, slide.travel(state), rtol=0, atol=1e-12)
    np.testing.assert_allclose(place.imag, slide.offset, rtol=0, atol=1e-12)
    assert scene.reach(slide) == pytest.approx((place.real.min(), place.real.max()), abs=1e-12)
    assert [body.link.number for body in scene.bodies if body.slides] == [slide.slider]
    assert [body.link.number for body in scene.bodies if body.guides] == [slide.guide] * slide.carried


@pytest.mark.parametrize("linkage", PINNED)
def test_links_with_pins_alone_are_bars_and_plates(linkage: Linkage) -> None:
    scene = Scene(linkage)
    stand = {name: place[0] for name, place in scene.places(solve_position(linkage, [0.3])).items()}
    assert scene.slides == ()
    for body in scene.bodies:
        (line,) = body.lines(stand)
        assert set(line) == set(body.link.points)
        assert body.areas(stand) == ((line,) if len(body.link.points) > 2 else ())


@pytest.mark.parametrize("linkage", [*SLIDING, *PINNED])
def test_points_in_the_frame_of_a_link_are_where_the_motion_has_them(linkage: Linkage) -> None:
    scene, state = Scene(linkage), solve_position(linkage, 0.7)
    along = {slide.slider: slide.angle for slide in scene.slides if not slide.carried}  # not across
    for link in linkage.mechanism.links[1:]:
        turn = np.exp(1j * (state.angles | along)[link.number])
        places = {name: complex(*state.point(name)) for name in link.points}
        for name, at in scene.frame(link).items():
            there = (places[name] - places[link.points[0]]) / turn
            assert complex(*at) == pytest.approx(there, abs=1e-12)
