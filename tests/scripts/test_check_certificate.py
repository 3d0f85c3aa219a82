"""The checker of certificates confirms what is proven, and finds tampering."""

from __future__ import annotations

import copy
import json
import subprocess
import sys
from collections.abc import Callable
from fractions import Fraction
from importlib import import_module
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest
from typer.testing import CliRunner

from grashof import load
from grashof.cli import app
from grashof.problems import ProblemError, problem_text
from grashof.synth import prove
from grashof.synth.proof.poses import certificate

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
def test_the_commands_in_the_documentation_prove_and_confirm(grashof: Any, tmp_path: Path) -> None:
    path, problem = tmp_path / "luggage.json", tmp_path / "luggage.toml"
    problem.write_text(problem_text("luggage"))
    assert grashof("prove", "luggage", "--certificate", str(path)).exit_code == 0
    command = [sys.executable, str(SCRIPTS / "check_certificate.py"), str(path), str(problem)]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0
    assert "no four-bar within these limits transmits more than 27.3425" in done.stdout
    path.write_text(path.read_text().replace("3.5", "3.501", 1))
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 1
    assert "poses" in done.stdout


def first(certificate: Certificate, fate: str) -> int:
    found: int = certificate["fates"].index(fate)
    return found


def leaf_removed(one: Certificate) -> None:
    one["pairs"][1]["transmission"].pop()


def leaf_shrunk(one: Certificate) -> None:
    """One that holds a part of the curve."""
    pairs = zip(one["parents"], one["fates"], strict=True)
    one["rectangles"][next(k for k, (parent, fate) in enumerate(pairs) if parent >= 0 and fate == "either")][
        4
    ] *= 0.5


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
    ("tamper", "fault"),
    [
        (leaf_removed, "pairs without a reason: 1,"),
        (leaf_shrunk, "halves: "),
        (reason_changed, "pairs dropped by lengths: 1 not confirmed"),
        (tube_shortened, "tubes: "),
        (limits_widened, "not cover every place that the arms reach"),
        (piece_forgotten, "neither dropped, nor kept, nor halved"),
        pytest.param(fate_changed, "missed rectangles: 1 not confirmed", marks=pytest.mark.study),
        pytest.param(role_changed, "1 not confirmed", marks=pytest.mark.study),
        pytest.param(child_moved, "halves: ", marks=pytest.mark.study),
        pytest.param(upper_lowered, "pairs dropped by transmission: ", marks=pytest.mark.study),
    ],
)
def test_tampering_is_found_for_its_own_reason(
    checker: ModuleType, luggage: Certificate, tmp_path: Path, capsys: pytest.CaptureFixture[str],
    tamper: Callable[[Certificate], None], fault: str,
) -> None:  # fmt: skip
    one = copy.deepcopy(luggage)
    tamper(one)
    assert checked(checker, one, tmp_path) == 1
    assert fault in capsys.readouterr().out


def test_certificates_are_json_and_others_are_refused(
    checker: ModuleType, luggage: Certificate, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert certificate._finite({"r1": [0.0, np.inf], "order": True}) == {"r1": [0.0, None], "order": True}
    assert checked(checker, {**luggage, "size": np.inf}, tmp_path) == 1
    assert "Infinity is not a number" in capsys.readouterr().out


def test_polynomials_hold_exact_values_whatever_is_rounded(checker: ModuleType) -> None:
    """Sums, products, inverses and roots at random points, in fractions."""
    enclosures, rng = import_module("enclosures"), np.random.default_rng(1)
    terms, n = enclosures.TERMS, 40
    sizes = 10.0 ** rng.uniform(-8, 0, (10, n))
    first, other = (enclosures.Poly(rng.normal(size=(10, n)) * sizes, np.zeros(n)) for _ in range(2))
    first.c[0] = rng.uniform(20, 30, n)
    made = [first + other, first - other, first * other, first * other * first, first.inverse(), first.root()]
    for k in range(n):
        s, t = (Fraction(float(x)) for x in rng.choice([-1, 1, rng.uniform(-1, 1)], 2))

        def at(poly: Any, k: int = k, s: Fraction = s, t: Fraction = t) -> Fraction:
            parts = zip(poly.c[:, k], terms, strict=True)
            return sum((Fraction(float(c)) * s**i * t**j for c, (i, j) in parts), Fraction(0))

        x, y = at(first), at(other)
        for poly, value in zip(made, [x + y, x - y, x * y, x * y * x, 1 / x], strict=False):
            assert abs(at(poly) - value) <= Fraction(float(poly.r[k]))
        root, off = at(made[-1]), Fraction(float(made[-1].r[k]))
        assert (root - off) ** 2 <= x <= (root + off) ** 2


@pytest.fixture
def grashof() -> Callable[..., Any]:
    return lambda *arguments: CliRunner().invoke(app, arguments)


def test_a_proof_without_a_bound_is_told_and_so_is_its_lack_of_a_certificate(
    grashof: Any, tmp_path: Path
) -> None:
    path = tmp_path / "one.json"
    done = grashof("prove", "luggage", "--at-least", "20", "--certificate", str(path))
    assert done.exit_code == 0
    assert done.stdout.startswith("Proven: a design that the judge accepts has")
    assert f"certificate {path}: not written, for no bound was reached" in done.stderr
    assert not path.exists()


def test_certificates_are_of_four_poses_and_files(tmp_path: Path) -> None:
    with pytest.raises(ProblemError, match="certificates of four whole poses only"):
        prove(load("straight-line"), certificate=tmp_path / "one.json")
    for path in (tmp_path, tmp_path / "none" / "one.json"):
        with pytest.raises(ProblemError, match="it must be a file that can be written"):
            prove(load("luggage"), certificate=path)
    assert not list(tmp_path.iterdir())
