"""Every example in a docstring of the installed package runs and is right."""

import doctest
from importlib import import_module
from pkgutil import iter_modules

import numpy as np
import pytest

# By name: in an editable install the packages lie in folders of their own, not below `grashof`.
PACKAGES = (
    "grashof",
    "grashof.problems",
    "grashof.analysis",
    "grashof.synth",
    "grashof.figures",
    "grashof.page",
    "grashof.survey",
    "grashof.workshop",
)
MODULES = sorted(
    f"{package}.{module.name}"
    for package in PACKAGES
    for module in iter_modules(import_module(package).__path__)
    if not module.ispkg
)


@pytest.mark.parametrize("name", MODULES)
def test_examples_of(name: str) -> None:
    module = import_module(name)
    failed, _ = doctest.testmod(module, extraglobs={"np": np})
    assert failed == 0


def test_all_layers_are_seen() -> None:
    ends = {"problems.task", "analysis.verify", "synth.programme", "cli"}
    assert {f"grashof.{end}" for end in ends} <= set(MODULES)
