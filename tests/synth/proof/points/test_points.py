"""Linkages through as many points as leave no freedom: boxes with one exact linkage, and claims."""

from dataclasses import replace

import numpy as np
import pytest

from grashof.analysis import verify
from grashof.analysis.judge.planted import planted_path
from grashof.problems import Problem, load
from grashof.problems.values.arrays import ComplexArray, FloatArray
from grashof.synth import Claim
from grashof.synth.designs.candidate import Candidate
from grashof.synth.proof.points.boxes import boxes, holds_one, inverses
from grashof.synth.proof.points.equations import PointEquations
from grashof.synth.proof.points.followed import enclosed_designs, proof_of_points, unknowns_of
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.starts.precision_points import FOLLOWED, THROUGH
from grashof.synth.theory.nine_points import coupler_turns, linkages_through
from grashof.synth.theory.point_families import FOUR_BARS

KINDS = [("four-bar", 9), ("slider-crank", 8), ("inverted-slider-crank", 8)]


def planted(kind: str, count: int, seed: int) -> tuple[ScaledProblem, Candidate]:
    task, linkage = planted_path(np.random.default_rng([2, seed]), count, mechanism=kind)
    problem = Problem(task=task, mechanism=kind)
    verdict = verify(linkage, task, problem.requirements, problem=problem)
    return ScaledProblem.of(problem), Candidate(linkage, verdict, problem, 0, 0)


def passing(kind: str, count: int, seed: int) -> tuple[PointEquations, FloatArray]:
    """The equations of a planted linkage, and where it is, shape (1, K)."""
    scaled, design = planted(kind, count, seed)
    points: ComplexArray = scaled.problem.task.positions @ np.array([1, 1j])
    size = scaled.problem.task.size
    exact = np.asarray(points, np.clongdouble)
    return PointEquations((exact - exact[0]) / size, kind), unknowns_of(design, points, size)[None]  # type: ignore[arg-type]


def residual(kind: str, points: ComplexArray, x: FloatArray) -> FloatArray:
    """Misses of a linkage with unknowns x (K,), by its lengths: written anew, as precise as x."""
    turn = np.exp(1j * np.concatenate([[0 * x[0]], x[-(len(points) - 1) :]]))
    z = x[0:-1:2] + 1j * x[1::2] if kind == "four-bar" else x[0:6:2] + 1j * x[1:6:2]
    ways = [np.abs(points + turn * z[1] - z[0])]
    if kind == "four-bar":
        ways.append(np.abs(points + turn * z[3] - z[2]))
    elif kind == "slider-crank":
        ways.append(((points + turn * z[2]) * np.exp(-1j * x[6])).imag)
    else:
        ways.append(((z[2] - points) * np.exp(-1j * x[6]) / turn).imag)
    return np.concatenate([way[1:] - way[0] for way in ways])


def exact_zero(kind: str, points: ComplexArray, x: FloatArray) -> FloatArray:
    """The zero nearby, to 80 bits where the machine has them: Newton's method, derivatives by differences."""
    x = np.asarray(x, np.longdouble)
    h = np.longdouble(1e-7)
    for _ in range(6):
        steps = h * np.eye(len(x), dtype=np.longdouble)
        slopes = np.stack(
            [(residual(kind, points, x + d) - residual(kind, points, x - d)) / (2 * h) for d in steps], axis=1
        )
        x = x - np.linalg.solve(slopes.astype(float), residual(kind, points, x).astype(float))
    return x


@pytest.mark.parametrize(("kind", "count"), KINDS)
def test_a_box_holds_the_exact_linkage(kind: str, count: int) -> None:
    proven = 0
    for seed in range(8):
        equations, x = passing(kind, count, seed)
        middle, radius = boxes(equations, x)
        zero = exact_zero(kind, equations.points, x[0])
        if np.isfinite(radius).all():
            assert (np.abs(zero - middle[0]) < radius[0]).all()
            proven += 1
    assert proven >= 7


@pytest.mark.parametrize(("kind", "count"), KINDS)
def test_the_slopes_are_those_of_the_equations(kind: str, count: int) -> None:
    equations, x = passing(kind, count, 0)
    none = np.zeros_like(x)
    slopes = equations.rows(x, none).slopes[0]
    for k in range(x.shape[1]):
        step = none.copy()
        step[0, k] = 1e-6
        ahead, behind = (equations.rows(x + d, none).value[0] for d in (step, -step))
        assert np.abs((ahead - behind) / 2e-6 - slopes[:, k]).max() < 1e-9


@pytest.mark.parametrize(("kind", "count"), KINDS)
@pytest.mark.parametrize("width", [1e-4, 1e-2, 0.3, 3.0])
def test_slopes_in_a_box_keep_within_the_spread(kind: str, count: int, width: float) -> None:
    # Corners and random points; the spread is not idle either.
    rng, closest = np.random.default_rng(0), 0.0
    for seed in range(3):
        equations, x = passing(kind, count, seed)
        radius = width * rng.uniform(0, 1, x.shape) * (rng.uniform(size=x.shape) < 0.5)
        at = equations.rows(x, radius)
        shifts = np.concatenate(
            [rng.uniform(-1, 1, (300, x.shape[1])), rng.choice([-1, 1], (300, x.shape[1]))]
        )
        moved = equations.rows(x + radius * shifts, 0 * shifts).slopes
        off = np.abs(moved - at.slopes[0])
        assert (off <= at.spread[0]).all()
        closest = max(closest, float((off / (at.spread[0] + 1e-12)).max()))
    assert closest > 0.7


@pytest.mark.parametrize(("kind", "count"), KINDS)
def test_a_design_beside_the_exact_one_has_the_exact_one_in_its_box(kind: str, count: int) -> None:
    scaled, design = planted(kind, count, 1)
    linkage = design.linkage
    moved = replace(linkage, r2=linkage.r2 * (1 + 1e-7))
    beside = replace(design, linkage=moved, values=None)  # type: ignore[arg-type]
    exact, near = (enclosed_designs(scaled, [one]) for one in (design, beside))
    assert exact.within[0] < 1e-9
    assert 1e-8 < near.within[0] < 1e-6
    assert (np.abs(exact.middle - near.middle) < exact.radius + near.radius).all()
    far = replace(design, linkage=replace(linkage, r2=linkage.r2 * 1.001), values=None)  # type: ignore[arg-type]
    assert np.isnan(enclosed_designs(scaled, [far]).within[0])


def test_a_double_zero_is_not_claimed() -> None:
    # A and B in one place, and O2 and O4: both dyads ask for the same, and the coupler may turn at will.
    equations, x = passing("four-bar", 9, 1)
    double = np.concatenate([x[:, :4], x[:, :4], x[:, 8:]], axis=1)
    assert np.isnan(boxes(equations, double)[1]).all()
    # A linkage at points where a path turns back: two solutions meet, and one of the turns is counted twice.
    assert np.isnan(boxes(replace(equations, points=equations.points * 0), x)[1]).all()


def test_different_zeros_have_boxes_apart_and_no_box_of_both_is_accepted() -> None:
    # Either dyad first: two zeros of the same equations.
    equations, x = passing("four-bar", 9, 1)
    other = x[:, [4, 5, 6, 7, 0, 1, 2, 3, *range(8, 16)]]
    middle, radius = boxes(equations, np.concatenate([x, other]))
    assert (np.abs(middle[0] - middle[1]) > radius[0] + radius[1]).any()
    inverse = inverses(equations.rows(middle, 0 * middle).slopes)
    both = np.abs(middle[:1] - middle[1:]) + np.full((2, 1), 1e-3)
    assert not holds_one(equations, middle, inverse, np.zeros_like(middle), both).any()


@pytest.mark.slow
@pytest.mark.study
def test_all_linkages_through_the_nine_points_of_the_catalogue_are_enclosed() -> None:
    points = load("nine-points").task.positions @ np.array([1, 1j])
    found, solutions = linkages_through(points, np.random.default_rng(0))
    assert solutions == FOUR_BARS.count
    o2, o4, a, b, p = found.T
    joints = np.stack([o2 - points[0], a - p, o4 - points[0], b - p], axis=1)
    turns = np.angle(coupler_turns(found, points)[:, 1:])
    unknowns = np.concatenate([joints.view(np.float64), turns], axis=1)
    exact = np.asarray(points, np.clongdouble)
    equations = PointEquations(exact - exact[0], "four-bar")  # type: ignore[arg-type]
    middle, radius = boxes(equations, unknowns)
    assert len(found) == 21
    assert np.isfinite(radius).all()
    assert (np.abs(unknowns - middle) + radius).max() < 1e-9 * np.abs(unknowns).max()
    for k in range(len(found)):
        apart = (np.abs(middle[k] - middle) > radius[k] + radius).any(axis=1)
        assert np.count_nonzero(~apart) == 1
    for k in (0, 20):
        zero = exact_zero("four-bar", equations.points, unknowns[k])
        assert (np.abs(zero - middle[k]) < radius[k]).all()


def test_wrong_slopes_prove_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    equations, x = passing("four-bar", 9, 1)
    assert np.isfinite(boxes(equations, x)[1]).all()
    right = PointEquations.rows

    def rows(self: PointEquations, unknowns: FloatArray, radius: FloatArray) -> object:
        at = right(self, unknowns, radius)
        sign = np.where(np.arange(at.slopes.shape[1]) == 3, -1.0, 1.0)[:, None]
        return replace(at, slopes=at.slopes * sign) if radius.any() else at

    monkeypatch.setattr(PointEquations, "rows", rows)
    assert np.isnan(boxes(equations, x)[1]).all()


def said_of(
    scaled: ScaledProblem,
    design: Candidate,
    *,
    stopped: bool = False,
    whole: bool = True,
    enough: bool = False,
    **counts: int,
) -> tuple[Claim, str]:
    """The claim about a list of one design, and the reason, without the enclosures."""
    named = {{"through": THROUGH, "followed": FOLLOWED}[name]: value for name, value in counts.items()}
    made = proof_of_points(scaled, [design], named, stopped=stopped, whole=whole, enough=enough)
    assert made is not None
    assert (made.complete, made.upper) == (False, None)
    assert made.lower == pytest.approx(np.degrees(design.verdict.transmission_min_task))
    return made.claim, made.why.rpartition("; ")[0]


def test_only_a_whole_search_without_losses_is_followed() -> None:
    one = planted("four-bar", 9, 1)
    assert said_of(*one, through=9, followed=1442) == (Claim.FOLLOWED, "1442 of 1442 known solutions")
    short = "1442 of 1442 known solutions; as many designs as requested are listed, not all"
    assert said_of(*one, through=9, followed=1442, whole=False, enough=True) == (Claim.FOLLOWED, short)
    assert said_of(*one, whole=False, enough=True)[0] is Claim.REFUSED
    lost = (Claim.REFUSED, "of 1442 known solutions 2 were lost on the way")
    assert said_of(*one, through=9, followed=1440) == lost
    assert said_of(*one, through=9, followed=1443)[0] is Claim.REFUSED
    assert said_of(*one, through=9)[0] is Claim.REFUSED
    ended = "before the 1442 known solutions were followed"
    assert said_of(*one) == (Claim.REFUSED, f"the search ended {ended}")
    assert said_of(*one, stopped=True) == (Claim.REFUSED, f"the search was stopped {ended}")
    for parts in ({"whole": False}, {"stopped": True}):
        said = said_of(*one, through=9, followed=1442, **parts)  # type: ignore[arg-type]
        assert said == (Claim.REFUSED, "not all linkages that pass the points were tried")
    inverted = said_of(*planted("inverted-slider-crank", 8, 1))
    assert inverted == (Claim.REFUSED, "the search does not follow the 2220 solutions that are known")


def test_other_tasks_have_no_such_claim() -> None:
    for kind, count in (("four-bar", 8), ("slider-crank", 7)):
        scaled, design = planted(kind, count, 0)
        assert proof_of_points(scaled, [design], {}, stopped=False, whole=True) is None
    for name in ("luggage", "path-8-points", "path-18-timed"):
        scaled = ScaledProblem.of(load(name))
        assert proof_of_points(scaled, [], {}, stopped=False, whole=True) is None
