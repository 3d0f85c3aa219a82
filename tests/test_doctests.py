"""Every example in a docstring of the installed package runs and is right."""

import doctest
from importlib import import_module
from pathlib import Path
from pkgutil import walk_packages

import numpy as np
import pytest

# By name: in an editable install the packages lie in folders of their own, not below `grashof`.
PACKAGES = ("grashof", "grashof.problems", "grashof.analysis", "grashof.synth")
ELSEWHERE = {"grashof.synth.theory.nine_points"}  # its tests have computed the same linkages
SEARCHING = {f"grashof.synth.{name}" for name in ("merging", "prove", "results.advice", "shards", "track")}
WITH_EXAMPLES = sorted({
    module.name
    for package in PACKAGES
    for module in walk_packages(import_module(package).__path__, f"{package}.")
    if not module.ispkg
    if ">>>" in Path(module.module_finder.path, f"{module.name.split('.')[-1]}.py").read_text("utf-8")  # type: ignore[union-attr]
} - ELSEWHERE)  # fmt: skip


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=[pytest.mark.slow] * (name in SEARCHING)) for name in WITH_EXAMPLES]
)
def test_examples_of(name: str) -> None:
    assert doctest.testmod(import_module(name), extraglobs={"np": np}).failed == 0


def test_all_layers_are_seen() -> None:
    for layer in ("problems", "analysis", "synth", "page"):
        assert any(name.startswith(f"grashof.{layer}.") for name in WITH_EXAMPLES)
