"""Every example in a docstring of the installed package runs and is right."""

import doctest
from importlib import import_module
from pkgutil import walk_packages

import numpy as np
import pytest

# By name: in an editable install the packages lie in folders of their own, not below `grashof`.
PACKAGES = ("grashof", "grashof.problems", "grashof.analysis", "grashof.synth")
ELSEWHERE = {"grashof.synth.theory.nine_points"}  # its tests have computed the same linkages
MODULES = sorted({
    module.name
    for package in PACKAGES
    for module in walk_packages(import_module(package).__path__, f"{package}.")
    if not module.ispkg
})  # fmt: skip


@pytest.mark.parametrize("name", [name for name in MODULES if name not in ELSEWHERE])
def test_examples_of(name: str) -> None:
    module = import_module(name)
    failed, _ = doctest.testmod(module, extraglobs={"np": np})
    assert failed == 0


def test_all_layers_are_seen() -> None:
    ends = {
        "problems.values.tasks.task",
        "analysis.judge.verify",
        "synth.programme.start",
        "output.terminal",
        "cli",
    }
    assert {f"grashof.{end}" for end in ends} <= set(MODULES)
