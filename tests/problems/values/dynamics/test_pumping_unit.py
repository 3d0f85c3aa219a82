"""What may be said of a pumping unit."""

from typing import Any

import pytest
from refusals import refusal

from grashof.problems import FourBar, LinkageSpec, ProblemError
from grashof.problems.values.dynamics.pumping_unit import PumpingUnitSpec

TURNS = [[0, 9e3], [180, 2e4], [360, 9e3]]


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"well": "north"}, "well is 'north'; it must be right or left"),
        ({"crank": "left"}, "crank is 'left'; it must be clockwise or counter-clockwise"),
        ({"counterbalance": float("nan")}, "counterbalance is nan; it must be a finite number"),
        ({"rating": 0.0}, "rating is 0; it must be a number greater than zero"),
        ({"rating": -1.0}, "rating is -1; it must be a number greater than zero"),
        ({"rod_load": 1e21}, "rod_load is 1e"),
        ({"over": "position"}, "over does not go with a constant load; it needs values"),
        ({"values": TURNS, "rod_load": 1.0}, "rod_load is given besides values; give one of them"),
        ({"values": [[0, 1]]}, "values has 1 rows; it must have two or more"),
        (
            {"values": [[0, 1], [10, 2]]},
            "values cover crank 0 to 10 deg; they must cover a turn, as 0 to 360",
        ),
        ({"values": [[0, 1], [360, 2]]}, "values end otherwise than they begin"),
        ({"values": [[0, 1], [90, 1], [80, 2], [360, 1]]}, "values[2] has crank 80; it must rise"),
        ({"values": [[0, 1, 2], [360, 1]]}, "values[0] is"),
        ({"values": [[0, 1, 2], [2, 1, 2]], "over": "position"}, "values cover positions 0 to 2; they must"),
        ({"values": TURNS, "over": "theta2"}, "over is 'theta2'; it must be crank or position"),
    ],
)
def test_what_is_refused(given: dict[str, Any], message: str) -> None:
    line = refusal(PumpingUnitSpec, **given)
    assert message in line
    assert "\n" not in line


def test_what_is_stated_gives_the_value_again() -> None:
    unit = PumpingUnitSpec(well="left", rating=1e5, values=TURNS)
    assert PumpingUnitSpec(**unit.stated) == unit
    assert (unit.side, unit.sense) == (-1, 1)


def test_a_unit_needs_its_arm() -> None:
    with pytest.raises(ProblemError, match="output_arm is missing; pumping_unit needs that of the horsehead"):
        LinkageSpec(FourBar((0, 0), (4, 0), 1, 4, 3), "it", pumping_unit=PumpingUnitSpec())
