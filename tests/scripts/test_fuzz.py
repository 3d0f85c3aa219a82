"""Mutated files: refused in clear lines or right, and none of them brings the program down."""

# ruff: noqa: S311

from __future__ import annotations

import random
import signal
import tomllib
from collections import Counter
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from types import ModuleType

import pytest

from grashof import load
from grashof.problems import ProblemError
from grashof.problems.files.linkage_schema import FILES
from grashof.problems.files.problem_schema import ProblemFile
from grashof.problems.files.tables import tables_of

Script = Callable[[str], ModuleType]
pytestmark = pytest.mark.skipif(
    not hasattr(signal, "SIGPROF"), reason="no timers of processor time: hangs are not found"
)


@pytest.mark.slow
def test_the_seeds_are_right_and_use_every_key(script: Script, tmp_path: Path) -> None:
    mutants, fuzz = script("mutants"), script("fuzz")
    mutants.write_files(tmp_path)
    for seeds, file in (
        (mutants.problem_seeds(), ProblemFile),
        *((mutants.linkage_seeds(), file) for file in FILES.values()),
    ):
        used: dict[str, set[str]] = {}
        for seed in seeds:
            text = mutants.toml_text(seed.document)
            assert tomllib.loads(text) == seed.document
            (tmp_path / "seed.toml").write_text(text, encoding="utf-8")
            figures: Counter[str] = Counter()
            assert fuzz.examine(tmp_path / "seed.toml", seed.kind, figures, lambda: False) is None
            assert figures["accepted"] == 1, text
            for path, table in mutants.tables_of(seed.document):
                used.setdefault(path, set()).update(table)
        for path, table in tables_of(file):
            if path.count(".") == 0:
                others = {"weights", "table", *(["travel_deg"] if file is ProblemFile else [])}
                assert set(table.model_fields) - others <= used[path.replace("[]", "")], path


@pytest.mark.slow
def test_mutants_are_refused_or_right(
    script: Script, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    mutants, fuzz = script("mutants"), script("fuzz")
    seeds = [*mutants.problem_seeds(), *mutants.linkage_seeds()]
    figures = fuzz.fuzz(300, 7, 0.0, tmp_path / "findings", seeds)
    assert not any(figures[kind] for kind in fuzz.FINDINGS), capsys.readouterr().out
    assert figures["files"] == figures["refused"] + figures["accepted"] == 300
    assert min(figures["refused"], figures["accepted"]) > 60


@pytest.mark.study
def test_designs_and_reports_of_mutants_are_right(
    script: Script, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    fuzz = script("fuzz")
    figures = fuzz.fuzz(400, 11, 0.1, tmp_path / "findings", fuzz.seeds())
    assert not any(figures[kind] for kind in fuzz.FINDINGS), capsys.readouterr().out
    assert min(figures["designs judged"], figures["reports"]) > 0


def test_the_same_seed_makes_the_same_mutants(script: Script) -> None:
    mutants = script("mutants")
    seeds = mutants.problem_seeds()
    first, second = (
        [mutator.mutant() for _ in range(50)]
        for mutator in (mutants.Mutator(seeds, random.Random(3)) for _ in range(2))
    )
    assert first == second


def test_what_is_wrong_is_found(script: Script, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    fuzz, path = script("fuzz"), tmp_path / "mutant.toml"
    path.write_text('kind = "path"\n[path]\npoints = [[0, 0], [1, 0], [2, 1]]\n')

    def found(*, searched: bool = False) -> str | None:
        finding = fuzz.examine(path, "problem", Counter(), lambda: searched)
        return None if finding is None else str(finding.kind)

    def endless(_: Path) -> None:
        while True:
            pass

    def unclear(_: Path) -> None:
        raise ProblemError("something is wrong")

    assert found() is None
    for loads, kind in ((len, fuzz.TRACEBACK), (endless, fuzz.HANG), (unclear, fuzz.UNCLEAR)):
        with monkeypatch.context() as patched:
            patched.setattr(fuzz, "load", loads)
            patched.setattr(fuzz, "LOADING", 0.1)
            assert found() == kind
    asked = load("luggage")
    designs = fuzz.synthesize(asked, starts=2, enough=1)
    stricter = replace(asked, requirements=replace(asked.requirements, transmission_min_deg=80))
    monkeypatch.setattr(fuzz, "synthesize", lambda *_, **__: replace(designs, problem=stricter))
    assert found(searched=True) == fuzz.WRONG


@pytest.mark.study
@pytest.mark.parametrize("number", range(21))
def test_every_seed_of_a_linkage_is_reported_on_whatever_is_asked(
    script: Script, number: int, tmp_path: Path
) -> None:
    """Every section of every kind with all keys that there are: none of them ends in another error."""
    mutants, fuzz = script("mutants"), script("fuzz")
    seeds = mutants.linkage_seeds()
    assert len(seeds) == 21
    path = tmp_path / "seed.toml"
    path.write_text(mutants.toml_text(seeds[number].document), encoding="utf-8")
    figures: Counter[str] = Counter()
    assert fuzz.examine(path, "linkage", figures, lambda: True) is None
    assert (figures["accepted"], figures["reports"]) == (1, 1)
