"""Mechanisms as rows: links, joints and parameters follow from a driver and dyads."""

import pickle

import numpy as np
import pytest
from linkages_of_rows import SIX_BARS, row_name

from grashof.problems import FourBar, InvertedSliderCrank, ProblemError, SixBar, SliderCrank
from grashof.problems.values.linkages.mechanism import MECHANISMS, Mechanism
from grashof.problems.values.linkages.mechanisms import linkage_of

LEG = SixBar((0, 0), (4, 0), 1, 4, 3, c=(5, 1), d=(6, 2), r5=3, r6=2.5, hosts=(3, 1), coupler_point=(4, 1))
PRESS = SixBar((1, 0), (4, 0), 1, 4, 3, c=(5, 1), r5=3, slide_angle_2=0.5, hosts=(3, 1), point_link=6)
EVERY = (
    FourBar((0, 1), (4, 0), 1, 4, 3, (1, 2), -1, 0.3),
    SliderCrank((0, 1.25), 1, np.pi, -0.25, 0.7, (0.1 + 0.2, -1e20), -1, 1e-300),
    InvertedSliderCrank((0, 1.25), (4.5, -0.5), 1, -0.5, (0.3, 2), -1, 1e-300),
    LEG,
    PRESS,
)


def test_every_six_bar_has_an_example_that_pages_drawings_and_plates_are_tested_with() -> None:
    shown = {linkage.mechanism.dyads for linkage in SIX_BARS.values()}
    assert shown == {row.dyads for row in MECHANISMS if len(row.dyads) > 1}


@pytest.mark.parametrize("row", MECHANISMS, ids=row_name)
def test_links_joints_and_slides_close_as_many_loops_as_there_are_dyads(row: Mechanism) -> None:
    """Kutzbach: 3 (links - 1) - 2 (joints and slides) = 1 degree of freedom."""
    assert 3 * (len(row.links) - 1) - 2 * (len(row.joints) + len(row.slides)) == 1
    assert all(len(links) == 2 for links in row.joints.values())
    assert sum("p" in link.points for link in row.links) == 1
    assert set(row.lengths) <= {*(each.name for each in row.parameters), "r1"}


def test_points_lie_on_the_links_that_a_textbook_names() -> None:
    assert [link.labels for link in LEG.mechanism.links] == [
        ("O2", "O4", "D"), ("O2", "A"), ("A", "B", "C"), ("O4", "B"), ("C", "E", "P"), ("D", "E"),
    ]  # fmt: skip
    assert PRESS.mechanism.slides == ((1, 6),)
    assert PRESS.mechanism.links[5].labels == ("E", "P")


@pytest.mark.parametrize("linkage", EVERY, ids=lambda each: each.mechanism.word)
def test_a_value_comes_back_from_pickle_json_index_scale_and_its_own_words(linkage: FourBar) -> None:
    twin = pickle.loads(pickle.dumps(linkage))
    assert (twin, hash(twin)) == (linkage, hash(linkage))
    with pytest.raises(ProblemError, match=r"r2 is -1; it must be greater than zero"):
        linkage.changed(r2=-1)
    assert linkage_of(linkage.mechanism.word, linkage.stated) == linkage
    assert eval(repr(linkage), {type(linkage).__name__: type(linkage)}) == linkage  # noqa: S307
    assert linkage.stacked([linkage, linkage])[1] == linkage[None, None][0, 0] == linkage
    assert linkage[None, None].shape == (1, 1)
    shift = np.array([3.0, -2.0])
    there = linkage.scaled(2.0, shift)
    for name in {"r2", "offset"} & {*linkage.columns}:
        assert there.columns[name] == 2 * linkage.columns[name]  # type: ignore[operator]
    back = there.scaled(0.5, -2.0 * shift)
    for one, other in zip(back.parameters, linkage.parameters, strict=True):
        np.testing.assert_allclose(one, other, atol=1e-15)
    assert hash(back.changed(body_angle=linkage.body_angle)) == hash(linkage)


def test_columns_of_a_six_bar_are_those_of_the_contract() -> None:
    assert list(LEG.columns) == [
        "r1", "r2", "r3", "r4", "r5", "r6", "o2_x", "o2_y", "o4_x", "o4_y", "c_u", "c_v", "d_u", "d_v",
        "p_u", "p_v", "assembly", "assembly_2", "body_angle_deg", "hosts", "point_link",
    ]  # fmt: skip
    assert (LEG.columns["hosts"], LEG.columns["point_link"]) == ("3-1", "5")
    assert PRESS.columns["slide_angle_2_deg"] == pytest.approx(np.degrees(0.5))


def test_another_six_bar_is_another_kind() -> None:
    other = LEG.changed(point_link=3)
    assert other.mechanism.links[2].points == ("a", "b", "c", "p")
    assert other != LEG
    assert LEG != PRESS


@pytest.mark.parametrize(
    ("given", "wrong"),
    [
        ({"hosts": (4, 3)}, r"hosts is \(4, 3\); it must be one of \[3, 1\], \[2, 4\]"),
        ({"hosts": (3, 3)}, "hosts is"),
        ({"point_link": 1}, "point_link is 1; it must be the number of a moving link, 2 to 6"),
        ({"r6": None}, "r6 is missing without slide_angle_2"),
        ({"slide_angle_2": 0.1}, "d is given with slide_angle_2"),
        ({"d": None, "r6": None, "slide_angle_2": 0.1, "hosts": (2, 3)}, "a slide lies on the ground"),
        ({"offset_2": 0.1}, "offset_2 is given without slide_angle_2"),
        ({"r5": -1}, "r5 is -1; it must be greater than zero"),
        ({"assembly_2": 0}, "assembly_2 is 0"),
    ],
)
def test_bad_six_bars_are_refused(given: dict[str, object], wrong: str) -> None:
    stated = {**LEG.stated, **given}
    with pytest.raises(ProblemError, match=wrong):
        SixBar(**stated)  # type: ignore[arg-type]
    with pytest.raises(ProblemError, match=r"mechanism is watt-1; links \[3, 1\] carry C and D"):
        linkage_of("watt-1", LEG.stated)
