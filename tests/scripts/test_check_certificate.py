"""The checker of certificates confirms what is proven, and finds tampering."""

from __future__ import annotations

import copy
import json
import subprocess
import sys
from collections.abc import Callable
from fractions import Fraction
from functools import partial
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
def checker(script: Callable[[str], ModuleType]) -> ModuleType:
    return script("check_certificate")


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


def changed(path: list[Any], change: Callable[[Any], Any]) -> Callable[[Certificate], None]:
    """A tampering: the part at a path replaced; a step of the path may be looked up in the certificate."""

    def tamper(one: Certificate) -> None:
        *steps, last = [step(one) if callable(step) else step for step in path]
        part: Any = one
        for step in steps:
            part = part[step]
        part[last] = change(part[last])

    return tamper


def child(certificate: Certificate, *fates: str) -> int:
    """The first rectangle with a parent, of one of these fates if any are stated."""
    pairs = enumerate(zip(certificate["parents"], certificate["fates"], strict=True))
    return next(k for k, (parent, fate) in pairs if parent >= 0 and (not fates or fate in fates))


def first_piece(certificate: Certificate) -> int:
    return int(certificate["first"][0])


def reason_changed(one: Certificate) -> None:
    one["pairs"][0]["lengths"].append(one["pairs"][0]["transmission"].pop())


study = partial(pytest.param, marks=pytest.mark.study)
WIDER = {"r2": [0.2, 8.0], "coupler_arms": [0.3, 9.0]}


@pytest.mark.slow
@pytest.mark.parametrize(
    ("tamper", "fault"),
    [
        (changed(["pairs", 1, "transmission"], lambda old: old[:-1]), "pairs without a reason: 1,"),
        # A leaf that holds a part of the curve.
        (changed(["rectangles", lambda one: child(one, "either"), 4], lambda old: old / 2), "halves: "),
        study(reason_changed, "pairs dropped by lengths: 1 not confirmed"),
        (changed(["tubes", first_piece, 4], lambda old: 0.9 * old), "tubes: "),
        (changed(["limits"], lambda old: old | WIDER), "not cover every place that the arms reach"),
        (changed(["first"], lambda old: old[:-1]), "neither dropped, nor kept, nor halved"),
        study(
            changed(["fates", lambda one: one["fates"].index("either")], lambda _: "missed"),
            "missed rectangles: 1 not confirmed",
        ),
        study(changed(["fates", first_piece], lambda _: "barred"), "1 not confirmed"),
        study(changed(["rectangles", child, 0], lambda old: old + 0.01), "halves: "),
        study(changed(["upper_deg"], lambda old: old - 0.1), "pairs dropped by transmission: "),
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


def test_a_proof_without_a_bound_has_no_certificate_and_says_so(grashof: Any, tmp_path: Path) -> None:
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
