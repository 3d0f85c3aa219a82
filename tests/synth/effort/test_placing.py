"""Struts and springs placed: planted ones are found, strokes kept, and the search's effort is the judge's."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from grashof.analysis.cylinder.travel import travel
from grashof.analysis.effort.case import EffortCase
from grashof.analysis.effort.deviation import effort_curves, effort_figures
from grashof.problems import Box, DynamicsSpec, FourBar, LinkageSpec, ProblemError, Region
from grashof.problems.files.effort_schema import usual_sizes
from grashof.problems.values.dynamics.effort import EffortSpec
from grashof.problems.values.dynamics.struts import EffortPlace, PartSpec
from grashof.synth import place_parts
from grashof.synth.effort.aim import Aim
from grashof.synth.effort.placing import placed

LID = FourBar(o2=(0, 0), o4=(60, 10), r2=180, r3=90, r4=190, coupler_point=(200, 40), body_angle=0.3)
HAND = EffortPlace(3, Box((420, 420), (60, 60)))
GAS = usual_sizes("gas", "mm")
PULLS = usual_sizes("tension", "mm")
COILS = usual_sizes("torsion", "mm")
FOOT = EffortPlace(1, Box((-60, 160), (-120, -20)))
HEAD = EffortPlace(2, Box((40, 160), (-30, 30)))
ON_BODY = EffortPlace("body", Box((-80, 120), (-60, 40)))


def case_of(*parts: PartSpec, **wanted: Any) -> EffortCase:
    """The lid opened over 50 deg of its driver, at two temperatures."""
    effort = EffortSpec(HAND, over="driver", temperatures_c=(-10.0, 40.0), parts=parts, **wanted)
    ends = np.radians([60.0, 110.0])
    moved = travel(LID, ends, np.array([1, 1]), (float(ends[0]), float(ends[1])))
    assert moved is not None
    loads = DynamicsSpec(payload=6.0, gravity=(0, -9.81), effort=effort)
    return EffortCase(LID, loads, 1e-3, moved)


def excess(case: EffortCase, effort: EffortSpec | None) -> float:
    """The greatest excess of placed parts by the judge, without other misses."""
    assert effort is not None
    assert effort.is_placed
    figures = effort_figures(replace(case, dynamics=replace(case.dynamics, effort=effort)))
    assert figures.misses == ()
    return figures.deviation.excess


@pytest.mark.parametrize(
    "parts",
    [
        (PartSpec("gas", (FOOT, HEAD), GAS[:40], count=2),),
        (PartSpec("gas", (FOOT, ON_BODY), GAS[40:90]), PartSpec("tension", (FOOT, HEAD), PULLS)),
        (PartSpec("torsion", (1, 4), COILS, count=2, free_angle_deg=(-30.0, 250.0)),),
    ],
    ids=["gas", "gas and tension", "torsion"],
)  # fmt: skip
def test_the_effort_of_candidates_is_the_judges(parts: tuple[PartSpec, ...]) -> None:
    """At every sample, temperature and size, and so are the lengths."""
    case = case_of(*parts, wanted=((0.0, 0.0), (50.0, 0.0)))
    aim, rng = Aim.of(case), np.random.default_rng(0)
    for _ in range(4):
        x = rng.random(aim.unknowns)
        rows = np.array([rng.integers(len(part.sizes)) for part in parts])
        found = aim.at(x[None], rows[None])
        fixed = []
        first = 0
        for part, known, row in zip(parts, aim.parts, rows.tolist(), strict=True):
            z = x[first : first + known.unknowns]
            first += known.unknowns
            if part.free_angle_deg is not None:
                low, high = part.free_angle_deg
                angle = low + (high - low) * z[0]
                fixed.append(replace(part, sizes=(part.sizes[row],), free_angle_deg=(angle, angle)))
                continue
            ends = []
            for place, (s, t) in zip(part.places, z.reshape(2, 2), strict=True):
                (left, right), (low, high) = place.at.x, place.at.y
                ends.append(place.placed(left + (right - left) * s, low + (high - low) * t))
            fixed.append(replace(part, sizes=(part.sizes[row],), between=(ends[0], ends[1])))
        judged = replace(case, dynamics=replace(case.dynamics, effort=replace(case.spec, parts=tuple(fixed))))
        places = (
            case.travel.start
            + (case.travel.end - case.travel.start) * (1 - np.cos(np.linspace(0, np.pi, 41))) / 2
        )
        effort = np.abs(judged.at(places).effort).ravel()
        mine = found.excess.reshape(
            -1, found.excess.shape[1] // 2 if parts[0].kind == "gas" else len(aim.without)
        )
        np.testing.assert_allclose(mine[:, -41:].max(), effort.max(), rtol=1e-9)
        if parts[0].kind == "gas":
            np.testing.assert_allclose(mine[:, -41:].ravel(), effort, rtol=1e-7, atol=1e-7)


@pytest.mark.slow
def test_a_planted_strut_is_found() -> None:
    """The effort that one strut gives at one temperature is wanted; its own deviation is rounding."""
    own = PartSpec("gas", (FOOT.placed(40, -70), HEAD.placed(120, 10)), (GAS[30],))
    truth = replace(case_of(own, band=(-1.0, 1.0)), travel=case_of(band=(0, 1)).travel)
    single = replace(truth.spec, temperatures_c=(20.0,))
    truth = replace(truth, dynamics=replace(truth.dynamics, effort=single))
    _, state = effort_curves(truth, 13)
    rows = tuple(zip(state.angle_deg.tolist(), state.effort[0].tolist(), strict=True))
    case = case_of(PartSpec("gas", (FOOT, HEAD), GAS), wanted=((0.0, *rows[0][1:]), *rows[1:]))
    case = replace(case, dynamics=replace(case.dynamics, effort=replace(case.spec, temperatures_c=(20.0,))))
    assert excess(case, placed(case)) < 0.01 * np.abs(state.effort).max()


def test_strokes_are_kept_where_they_are_active() -> None:
    """Weak struts need a long arm, and short ones have none."""
    short = tuple(size for size in GAS if size.stroke == 40 and size.force_extended <= 100)
    case = case_of(PartSpec("gas", (FOOT, HEAD), short), band=(-5.0, 5.0))
    found = placed(case)
    figures = effort_figures(replace(case, dynamics=replace(case.dynamics, effort=found)))
    least, most = figures.lengths[0]
    assert figures.misses == ()
    assert min(most % 1, 1 - most % 1) < 1e-3 or min(least % 1, 1 - least % 1) < 1e-3  # sizes are whole


def test_an_end_stays_on_its_segment() -> None:
    rail = EffortPlace(1, Region(on=[(-60, -120), (140, -20)]))
    case = case_of(PartSpec("gas", (rail, HEAD), GAS), band=(-10.0, 25.0))
    found = placed(case)
    assert excess(case, found) < 0
    assert found is not None
    x, y = found.parts[0].places[0].point
    assert y == pytest.approx(-120 + (x + 60) / 2)
    assert -60 <= x <= 140


def test_the_best_end_in_a_polygon_is_on_its_side() -> None:
    """The foot belongs outside: moved there, the strut would do better."""
    corners = np.array([(-60.0, -120.0), (100.0, -60.0), (-20.0, -20.0)])
    wanted = {"wanted": ((0.0, 30.0), (50.0, -20.0))}
    plate = EffortPlace(1, Region(inside=corners.tolist()))
    case = case_of(PartSpec("gas", (plate, HEAD), GAS[::4]), **wanted)
    found = placed(case)
    assert found is not None
    place = np.array(found.parts[0].places[0].point)
    sides = np.roll(corners, -1, axis=0) - corners
    normals = np.stack([-sides[:, 1], sides[:, 0]], axis=1) / np.hypot(*sides.T)[:, None]
    depth = ((place - corners) * normals).sum(axis=1)
    assert -1e-9 < depth.min() < 1e-3
    around = case_of(PartSpec("gas", (FOOT, HEAD), GAS[::4]), **wanted)
    assert excess(around, placed(around)) < 0.8 * excess(case, found)


@pytest.mark.slow
def test_a_bent_polygon_is_as_good_as_the_better_of_its_boxes() -> None:
    """An L of two boxes on the body; each alone is a case of its own."""
    flat, tall = Box((-80, 120), (-60, -30)), Box((-80, -40), (-60, 40))
    bent = Region(inside=[(-80, -60), (120, -60), (120, -30), (-40, -30), (-40, 40), (-80, 40)])
    parts = [PartSpec("gas", (FOOT, EffortPlace("body", at)), GAS) for at in (bent, flat, tall)]
    rows = {"wanted": ((0.0, 30.0), (50.0, -20.0))}
    for wanted in (rows, {"band": (-5.0, 5.0)}, {"stays_deg": (5.0, 45.0)}):
        cases = [case_of(part, **wanted) for part in parts]
        whole, *alone = (excess(case, placed(case)) for case in cases)
        best = min(alone)
        assert whole <= best + 0.02 * abs(best)


@pytest.mark.slow
def test_two_parts_are_no_worse_than_one() -> None:
    one = PartSpec("gas", (FOOT, HEAD), GAS)
    two = PartSpec("torsion", (1, 4), COILS, free_angle_deg=(0.0, 180.0))
    wanted = {"wanted": ((0.0, 12.0), (25.0, 2.0), (50.0, -6.0))}
    alone, both = case_of(one, **wanted), case_of(one, two, **wanted)
    assert excess(both, placed(both)) < 0.9 * excess(alone, placed(alone))


def test_a_usual_compression_spring_is_placed() -> None:
    """It balances most of the lid, which a hand carries with 30 N without it."""
    case = case_of(PartSpec("compression", (FOOT, HEAD), usual_sizes("compression", "mm")), band=(-2.0, 2.0))
    assert effort_figures(case_of(band=(-2.0, 2.0))).without.excess > 25
    assert excess(case, placed(case)) < 0


@pytest.mark.slow
def test_the_same_seed_places_the_same() -> None:
    case = case_of(PartSpec("gas", (FOOT, HEAD), GAS[::9]), stays_deg=(5.0, 45.0))
    assert placed(case, 3) == placed(case, 3)


def test_parts_of_a_file_are_placed_and_none_is_an_error() -> None:
    case = case_of(PartSpec("gas", (FOOT, HEAD), GAS), band=(-10.0, 25.0))
    stated = replace(case.spec, travel_deg=(60.0, 110.0))
    spec = LinkageSpec(LID, "lid", length_unit="mm", dynamics=replace(case.dynamics, effort=stated))
    done = place_parts(spec)
    assert done.dynamics is not None
    assert done.dynamics.effort is not None
    assert excess(case, done.dynamics.effort) < 0
    assert place_parts(done) == done
    long = tuple(size for size in GAS if size.extended > 1000)
    part = replace(stated.parts[0], sizes=long)
    bad = replace(spec, dynamics=replace(case.dynamics, effort=replace(stated, parts=(part,))))
    with pytest.raises(ProblemError, match=r"^lid: no size of effort\.parts lasts the travel"):
        place_parts(bad)
