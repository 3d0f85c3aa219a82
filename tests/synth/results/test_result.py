"""Results: order, Pareto marks, names, and what an empty one says."""

import pickle
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from grashof.problems import FourBar, NoSolutionError, Objective, Problem, TransmissionOver
from grashof.synth import Candidate, Result
from grashof.synth.designs.families import listed
from grashof.synth.designs.ranking import pareto_optimal, ranked

Designs = tuple[Candidate, ...]
bounded = settings(max_examples=25)


def with_figures(candidate: Candidate, error: float, transmission: float, size: float) -> Candidate:
    """The candidate as if the judge had found these numbers."""
    verdict = replace(
        candidate.verdict,
        position_error=np.full(4, error),
        transmission_min_task=transmission,
        transmission_min_cycle=1.0 - transmission,
        size=size,
    )
    return replace(candidate, verdict=verdict)


def test_a_table_of_weights_adds_up(luggage_designs: Designs, luggage: Problem) -> None:
    both = replace(luggage, objective=Objective(transmission=3, compactness=0.5))
    for candidate in luggage_designs[:5]:
        share, size = candidate.verdict.transmission_min_task / (np.pi / 2), candidate.verdict.size
        assert candidate.score(both) == pytest.approx(3 * share - 0.5 * size / np.sqrt(32), rel=1e-12)


def test_of_two_alike_the_better_one_stays(luggage_designs: Designs, luggage: Problem) -> None:
    good = luggage_designs[3]
    linkage = good.linkage
    nudged = FourBar(
        o2=linkage.o2 + 1e-3, o4=linkage.o4, r2=linkage.r2, r3=linkage.r3, r4=linkage.r4,
        coupler_point=linkage.coupler_point, assembly=linkage.assembly, body_angle=linkage.body_angle,
    )  # fmt: skip
    worse = replace(good, linkage=nudged, verdict=replace(good.verdict, transmission_min_task=0.01))
    other = luggage_designs[0]
    assert ranked(luggage, [worse, other, good]) == ranked(luggage, [good, other])
    assert ranked(luggage, []) == ()


def test_the_order_of_arrival_does_not_change_the_ranks(luggage_designs: Designs, luggage: Problem) -> None:
    shuffled = [luggage_designs[i] for i in np.random.default_rng(1).permutation(len(luggage_designs))]
    assert ranked(luggage, shuffled) == ranked(luggage, luggage_designs)
    assert listed(luggage, shuffled) == luggage_designs


# Few values, so that ties occur; in sizes.
figures_of_designs = st.lists(
    st.tuples(
        st.sampled_from([0.0, 1e-12, 3e-9, 1e-3]),
        st.sampled_from([0.1, 0.2, 0.3]),
        st.sampled_from([1.0, 2.0, 5.0]),
    ),
    max_size=8,
)


@bounded
@given(figures_of_designs)
def test_pareto_marks_are_those_of_brute_force(
    luggage_designs: Designs, luggage: Problem, figures: list[tuple[float, float, float]]
) -> None:
    luggage, size = replace(luggage, dynamics=None), luggage.task.size
    designs = tuple(with_figures(luggage_designs[0], e * size, t, s) for e, t, s in figures)
    for over in TransmissionOver:
        problem = replace(luggage, requirements=replace(luggage.requirements, transmission_over=over))
        sign = 1 if over is TransmissionOver.TASK else -1  # the cycle's figures run the other way
        # Errors up to the tolerance are exact and count as equal.
        costs = [(0.0 if e < 1e-6 else e, -sign * t, s) for e, t, s in figures]
        expected = [
            not any(all(x <= y for x, y in zip(b, c, strict=True)) and b != c for b in costs) for c in costs
        ]
        assert pareto_optimal(problem, designs).tolist() == expected


def test_an_unknown_torque_counts_as_infinite(luggage_designs: Designs, luggage: Problem) -> None:
    """As of a design without a motion that joins its targets."""
    one = luggage_designs[0]
    unknown, endless, known = (replace(one, values=None) for _ in range(3))
    for each, peak in ((unknown, np.nan), (endless, np.inf), (known, 1.0)):
        each.values._known["torque_peak"] = peak
    assert pareto_optimal(luggage, (known, unknown)).tolist() == [True, False]
    assert pareto_optimal(luggage, (endless, unknown)).tolist() == [True, True]
    driven = replace(luggage, objective=Objective(0, 0, 1))
    assert [each.score(driven) for each in (unknown, endless)] == [-np.inf, -np.inf]
    assert known.score(driven) == pytest.approx(-1 / driven.reference_torque, rel=1e-15)


def test_ids_name_designs(luggage_designs: Designs) -> None:
    ids = [candidate.id for candidate in luggage_designs]
    assert len(set(ids)) == len(ids)
    assert all(len(name) == 8 and int(name, 16) >= 0 for name in ids)
    for candidate in luggage_designs[:5]:
        assert pickle.loads(pickle.dumps(candidate)).id == candidate.id
        assert replace(candidate, start=99, iterations=3).id == candidate.id


def test_an_id_is_that_of_the_numbers_to_six_digits(luggage_designs: Designs, luggage: Problem) -> None:
    first = luggage_designs[0]

    def named(**changed: Any) -> str:
        numbers: dict[str, Any] = {
            "o2": (1.0, 2.0), "o4": (4.0, -0.0), "r2": 1.0, "r3": 4.0, "r4": 3.5,
            "coupler_point": (0.5, -2.0), "assembly": -1, "body_angle": 0.3,
        }  # fmt: skip
        return replace(first, linkage=FourBar(**(numbers | changed))).id

    assert named() == named(r2=1.0 + 1e-9) == named(o4=(4.0, 0.0))
    others = [
        named(r2=1.001), named(o2=(1.0, 2.001)), named(assembly=1), named(body_angle=0.31), named(r4=3.501),
    ]  # fmt: skip
    assert len({named(), *others}) == 6


def test_an_id_is_the_same_in_every_process(luggage_designs: Designs) -> None:
    """Written down, because lists of different runs are compared by it."""
    norton = FourBar(o2=(0, 0), o4=(100, 0), r2=40, r3=120, r4=80)
    assert replace(luggage_designs[0], linkage=norton).id == "d270d193"


def test_an_empty_result_says_why(luggage: Problem) -> None:
    empty = Result(luggage, note="no design: nothing fits")
    assert len(empty) == 0
    with pytest.raises(NoSolutionError, match=r"^no design: nothing fits$"):
        _ = empty.best


def test_values_show_themselves_in_one_line(luggage_result: Result) -> None:
    best, problem = luggage_result.best, luggage_result.problem
    mu = np.degrees(best.verdict.transmission_min_task)
    assert repr(best).startswith(f"<Candidate {best.id}: crank-rocker, r1 to r4 ")
    assert f"mu {mu:.1f} deg over the task" in repr(best)
    assert f"<Result of luggage: {len(luggage_result)} designs; best {best.id}" in repr(luggage_result)
    assert repr(Result(problem, note="nothing")) == "<Result of luggage: 0 designs; nothing>"
    assert repr(problem) == "<Problem luggage: MotionTask of 4 targets>"
    assert max(len(repr(value)) for value in (best, problem, luggage_result)) < 160
