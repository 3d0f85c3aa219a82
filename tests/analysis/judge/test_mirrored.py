"""Linkages that are their own mirror image: the judge places them, and reports those that are not."""

from typing import Any

import numpy as np
import pytest

from grashof.analysis import verify
from grashof.problems import FourBar, FunctionTask, Problem, ProblemError, Requirements

ARM, ANGLE = 0.3, 1.2  # rad
TRAPEZIUM = FourBar(o2=(0, 0), o4=(2, 0), r2=ARM, r3=2 - 2 * ARM * np.cos(ANGLE), r4=ARM, assembly=1)


def turned(linkage: FourBar, theta2: np.ndarray) -> np.ndarray:
    """Angle of link 4 by the intersection of two circles."""
    a = linkage.r2 * np.exp(1j * theta2)
    way = complex(*linkage.o4) - a
    along = (abs(way) ** 2 + linkage.r3**2 - linkage.r4**2) / (2 * abs(way))
    b = a + (along + 1j * float(linkage.assembly) * np.sqrt(linkage.r3**2 - along**2)) * way / abs(way)
    return np.unwrap(np.angle(b - complex(*linkage.o4)))


def task_of(linkage: FourBar, mirror: float, bend: float = 0.0) -> FunctionTask:
    """What the linkage does about its mirrored position, with a bend."""
    inputs = np.linspace(0, 0.5, 11)
    outputs = turned(linkage, ANGLE + inputs - mirror)
    outputs = outputs - outputs[0] + bend * (inputs - mirror) ** 2 - bend * mirror**2
    return FunctionTask(inputs, outputs, norm="max", mirror=mirror)


def test_the_output_has_no_error_in_the_mirrored_position() -> None:
    linkage = (
        TRAPEZIUM if turned(TRAPEZIUM, np.array([ANGLE]))[0] > np.pi / 2 else TRAPEZIUM.changed(assembly=-1)
    )
    task = task_of(linkage, 0.2, bend=0.1)
    verdict = verify(linkage, task, Requirements(rotatability="any"))
    assert verdict.ok
    assert verdict.theta2[0] == pytest.approx(ANGLE - 0.2, abs=1e-12)
    assert verdict.structural_error_max == pytest.approx(0.1 * 0.3**2, rel=1e-3)  # at the farther end


def test_a_linkage_off_its_mirror_image_has_a_defect() -> None:
    linkage = (
        TRAPEZIUM if turned(TRAPEZIUM, np.array([ANGLE]))[0] > np.pi / 2 else TRAPEZIUM.changed(assembly=-1)
    )
    task = task_of(linkage, 0.2)
    off = linkage.changed(r4=np.array(ARM * (1 + 1e-5)))
    (defect,) = verify(off, task, Requirements(rotatability="any")).defects
    assert defect.requirement == "mirror_deg"
    assert 1e-6 < defect.found < 1e-4


@pytest.mark.parametrize(
    ("given", "line"),
    [
        ({"mirror_deg": 90}, r"function.mirror_deg is 90; it must lie within the range, 0 to 60"),
        ({"mirror_deg": float("nan")}, "function.mirror_deg is nan; it must be a finite number"),
        ({"mirror_deg": 30, "link": "coupler"}, 'mirror_deg does not go with function.link = "coupler"'),
    ],
)
def test_mirrors_that_cannot_be_are_refused_in_a_line(given: dict[str, Any], line: str) -> None:
    with pytest.raises(ProblemError, match=line):
        FunctionTask.from_degrees([0, 20, 60], [0, 12, 50], **given)


def test_contradictions_with_a_mirror_are_refused_in_a_line() -> None:
    task = FunctionTask.from_degrees([0, 20, 60], [0, 12, 50], mirror_deg=30)
    for wanted, kind, line in (
        (
            {"exact": True},
            "four-bar",
            "requirements.exact is true; it must be false with function.mirror_deg",
        ),
        ({"theta2_start_deg": 10}, "four-bar", "theta2_start_deg does not go with function.mirror_deg"),
        ({}, "inverted-slider-crank", "function.mirror_deg is stated; mechanism must be four-bar"),
    ):
        with pytest.raises(ProblemError, match=line):
            Problem(task=task, requirements=Requirements(**wanted), mechanism=kind)
