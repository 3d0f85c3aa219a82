"""Linkages of every kind, turning and swinging, on both assemblies, in several units."""

import numpy as np
import pytest
from linkages_of_rows import SIX_BARS

from grashof.analysis import full_rotation
from grashof.analysis.judge.planted import (
    random_full_crank,
    random_inverted_slider_crank,
    random_slider_crank,
)
from grashof.models import Model
from grashof.problems import DynamicsSpec, FourBar, LinkageSpec, load_linkage, load_linkage_spec

DRIVEN = DynamicsSpec(
    speed_rpm=-90.0, masses=(0.4, 1.2, 0.7), inertias=(0.01, 0.05, 0.02), gravity=(0.0, -9.81)
)


def models() -> list[Model]:
    rng = np.random.default_rng(23)
    found = []
    for make in (random_full_crank, random_slider_crank, random_inverted_slider_crank):
        for number, unit in enumerate(("m", "mm", "in", "")):
            linkage = make(rng)
            name = f"{linkage.mechanism.word} in {unit or 'no unit'}"
            spec = LinkageSpec(linkage, name, length_unit=unit, dynamics=DRIVEN if number % 2 else None)
            found.append(Model.of(spec))
    rocker = FourBar(o2=(1, 0), o4=(5, 1), r2=3.5, r3=3, r4=2, coupler_point=(1, 1), assembly=-1)
    assert not full_rotation(rocker)
    found.append(Model.of(LinkageSpec(rocker, "swinging", length_unit="m")))
    for number, (name, linkage) in enumerate(SIX_BARS.items()):
        found.append(Model.of(LinkageSpec(linkage, name, length_unit=("m", "mm", "in", "")[number % 4])))
    found.append(Model.of(LinkageSpec(load_linkage("klann"), "leg", length_unit="m")))
    return [*found, Model.of(load_linkage_spec("pumpjack"))]


@pytest.fixture(params=models(), ids=lambda model: model.spec.name)
def model(request: pytest.FixtureRequest) -> Model:
    found: Model = request.param
    return found
