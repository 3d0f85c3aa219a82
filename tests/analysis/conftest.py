"""Fixtures of the analysis: published figures, and the linkages of `drawn_linkages`."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import drawn_linkages
import numpy as np
import numpy.typing as npt
import pytest

from grashof.problems import FourBar


@pytest.fixture(scope="session")
def golden() -> dict[str, Any]:
    """The reference figures, 20 digits each; with their conventions."""
    return json.loads((Path(__file__).parents[1] / "data" / "golden.json").read_text(encoding="utf-8"))


@pytest.fixture(scope="session")
def golden_linkages(golden: dict[str, Any]) -> dict[str, FourBar]:
    """The linkages whose states golden.json gives, all with assembly +1."""
    jack, bag = golden["pumpjack_report_geometry"]["inputs"], golden["bag_mechanism_exact"]
    unit = {name: float(size) for name, size in golden["pumpjack_lufkin_C912D_427_144"]["inputs_in"].items()}
    r1, *lengths = map(float, golden["table7_lengths_theta1_0"]["r"])
    return {
        "pumpjack": _reported(jack, [np.cos(0.4) / 2, np.sin(0.4) / 2]),
        "lufkin": FourBar((0, 0), (unit["I"], unit["H"] - unit["G"]), unit["R"], unit["P"], unit["C"]),
        "bag": _reported(bag, bag["coupler_ratio"], -float(bag["states_at_poses"][0]["theta3"])),
        "table7": FourBar((0, 0), (r1, 0), *lengths),
    }


def _reported(given: dict[str, Any], ratio: npt.ArrayLike, body_angle: float = 0.0) -> FourBar:
    """A linkage whose coupler point is given as a share of its r3."""
    lengths = [float(given[name]) for name in ("r2", "r3", "r4")]
    o2, o4, share = (np.array(pair, dtype=np.float64) for pair in (given["O2"], given["O4"], ratio))
    return FourBar(o2, o4, *lengths, coupler_point=lengths[1] * share, body_angle=body_angle)


@pytest.fixture(scope="session")
def golden_states(golden: dict[str, Any]) -> list[tuple[str, int, float, dict[str, Any]]]:
    """Every state of these linkages: name, assembly, speed of the driver in rad/s, figures."""
    pumpjack, bag = golden["pumpjack_report_geometry"]["states"], golden["bag_mechanism_exact"]
    lufkin = golden["pumpjack_lufkin_C912D_427_144"]["states(omega2=1 rad/s, inches)"]
    states = [
        *(("pumpjack", 1, 2 * np.pi / 3, state) for state in pumpjack["sigma=+1"]),
        *(("pumpjack", -1, 2 * np.pi / 3, state) for state in pumpjack["sigma=-1"]),
        *(("lufkin", 1, 1.0, state) for state in lufkin),
        *(("bag", 1, 1.0, state) for state in [*bag["states_at_poses"], *bag["states"]]),
        *(("table7", 1, 1.0, state) for state in golden["table7_lengths_theta1_0"]["states"]),
    ]
    assert len(states) == 10 + 2 + 8 + 9
    return states


@pytest.fixture(scope="session")
def close_loop() -> Callable[..., Any]:
    return drawn_linkages.close_loop


@pytest.fixture(scope="session")
def four_bars() -> Callable[..., Any]:
    return drawn_linkages.four_bars


@pytest.fixture(scope="session")
def linkages() -> Callable[..., Any]:
    return drawn_linkages.linkages
