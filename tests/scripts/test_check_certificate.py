"""The checker of certificates confirms what is proven, and finds what was tampered with."""

from __future__ import annotations

import copy
import json
from collections.abc import Callable
from importlib import import_module
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

from grashof import load
from grashof.problems import ProblemError, problem_text
from grashof.synth import prove

SCRIPTS = Path(__file__).parents[2] / "scripts"
Certificate = dict[str, Any]


@pytest.fixture(scope="module")
def luggage(tmp_path_factory: pytest.TempPathFactory) -> Certificate:
    path = tmp_path_factory.mktemp("certificate") / "luggage.json"
    prove(load("luggage"), certificate=path)
    made: Certificate = json.loads(path.read_text())
    return made


@pytest.fixture
def checker(monkeypatch: pytest.MonkeyPatch) -> ModuleType:
    monkeypatch.syspath_prepend(SCRIPTS)
    return import_module("check_certificate")


def checked(checker: ModuleType, certificate: Certificate, folder: Path, *more: str) -> int:
    path = folder / "tried.json"
    path.write_text(json.dumps(certificate))
    code: int = checker.main([str(path), *more])
    return code


@pytest.mark.slow
def test_the_proof_of_luggage_is_confirmed(
    checker: ModuleType, luggage: Certificate, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    problem = tmp_path / "luggage.toml"
    problem.write_text(problem_text("luggage"))
    assert checked(checker, luggage, tmp_path, str(problem)) == 0
    assert "no four-bar within these limits transmits more than 27.3425" in capsys.readouterr().out
    luggage = copy.deepcopy(luggage)
    luggage["poses"][1][0] += 1e-3
    assert checked(checker, luggage, tmp_path, str(problem)) == 1


def first(certificate: Certificate, fate: str) -> int:
    found: int = certificate["fates"].index(fate)
    return found


def leaf_removed(one: Certificate) -> None:
    one["pairs"][1]["transmission"].pop()


def leaf_shrunk(one: Certificate) -> None:
    one["rectangles"][first(one, "missed")][4] *= 0.9


def reason_changed(one: Certificate) -> None:
    one["pairs"][0]["lengths"].append(one["pairs"][0]["transmission"].pop())


def fate_changed(one: Certificate) -> None:
    one["fates"][first(one, "either")] = "missed"


def role_changed(one: Certificate) -> None:
    one["fates"][one["first"][0]] = "barred"


def child_moved(one: Certificate) -> None:
    child = next(k for k, parent in enumerate(one["parents"]) if parent >= 0)
    one["rectangles"][child][0] += 0.01


def tube_shortened(one: Certificate) -> None:
    one["tubes"][one["first"][0]][4] *= 0.9


def upper_lowered(one: Certificate) -> None:
    one["upper_deg"] -= 0.1


def limits_widened(one: Certificate) -> None:
    one["limits"]["r2"] = [0.2, 8.0]
    one["limits"]["coupler_arms"] = [0.3, 9.0]


def piece_forgotten(one: Certificate) -> None:
    one["first"].pop()


@pytest.mark.slow
@pytest.mark.parametrize(
    "tamper",
    [
        leaf_removed, leaf_shrunk, reason_changed, fate_changed, role_changed, child_moved, tube_shortened,
        upper_lowered, limits_widened, piece_forgotten,
    ],
)  # fmt: skip
def test_tampering_is_found(
    checker: ModuleType, luggage: Certificate, tmp_path: Path, tamper: Callable[[Certificate], None]
) -> None:
    one = copy.deepcopy(luggage)
    tamper(one)
    assert checked(checker, one, tmp_path) == 1


def test_certificates_are_of_four_poses_and_files(tmp_path: Path) -> None:
    with pytest.raises(ProblemError, match="certificates of four whole poses only"):
        prove(load("straight-line"), certificate=tmp_path / "one.json")
    for path in (tmp_path, tmp_path / "none" / "one.json"):
        with pytest.raises(ProblemError, match="it must be a file that can be written"):
            prove(load("luggage"), certificate=path)
    assert not list(tmp_path.iterdir())
