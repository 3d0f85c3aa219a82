"""Records of searches: wherever a search ended, it resumes to the same list."""

import json
import shutil
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

import grashof.synth.search.journal as journal_module
from grashof import load, synthesize
from grashof.problems import MotionTask, PathTask, Problem, ProblemError, Requirements
from grashof.synth import Result

LINE = [[20.0, 20 + 5.0 * k] for k in range(6)]
CONVEYOR = MotionTask.from_degrees([[0, 0, 0], [60, 90, 15], [180, 140, 40], [300, 90, 70], [360, 0, 90]])
KINDS = {
    "poses": (load("luggage"), {"starts": 60, "enough": 50}),
    "poses fitted": (Problem(task=CONVEYOR, requirements=Requirements(exact=False)), {"effort": 0.35}),
    "points met": (load("path-vertical-line"), {"starts": 30, "enough": 6}),
    "points fitted": (load("path-ellipse"), {"effort": 0.35}),
    "pairs fitted": (load("function-dosing-slide"), {}),
    "limit positions": (load("quick-return"), {"enough": 6}),
    "none": (
        Problem(task=PathTask(LINE), requirements=Requirements(link_length=(1.0, 12.0))),
        {"starts": 10, "enough": 2, "effort": 0.2},
    ),
}


@pytest.fixture(autouse=True)
def every_step_in_a_file(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(journal_module, "EVERY", 0.0)


def table(result: Result) -> str:
    return result.to_frame().to_csv() + result.note + result.ended


@pytest.mark.quick("poses fitted")
@pytest.mark.usefixtures("small_search")
@pytest.mark.parametrize("kind", KINDS)
def test_a_killed_search_resumes_to_the_same_list(
    kind: str, tmp_path: Path, mortal: Any, caplog: pytest.LogCaptureFixture
) -> None:
    caplog.set_level("INFO", logger="grashof")
    problem, options = KINDS[kind]
    whole, folder = synthesize(problem, **options), tmp_path / "search"
    result, tries = None, 0
    while result is None:
        mortal.left, tries = 20, tries + 1
        try:
            result = synthesize(problem, **options, record=folder)
        except mortal.killed:
            assert tries < 40
    assert tries > (kind == "poses")
    assert table(result) == table(whole)
    assert result.history.resumed == tries - 1
    assert (result.history.steps_recorded > 0) is (tries > 1)
    assert (f"resumed from a record of {result.history.steps_recorded} steps" in caplog.messages) is (
        tries > 1
    )
    assert not folder.exists()


@pytest.fixture(scope="module")
def fitted(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, str]:
    """The record of a search that was stopped, and the list of the full search."""
    problem, options = KINDS["poses fitted"]
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(journal_module, "EVERY", 0.0)
        folder = recorded(tmp_path_factory.mktemp("record") / "search", files=4)
    return folder, table(synthesize(problem, **options))


def recorded(folder: Path, files: int = 2) -> Path:
    """The record of a search that was stopped after a few steps, a file each."""
    problem, options = KINDS["poses fitted"]
    synthesize(problem, **options, record=folder, stop=lambda: len(list(folder.glob("0*.json"))) >= files)
    return folder


@pytest.mark.slow
@pytest.mark.quick("0.1")
@pytest.mark.parametrize("stop", [0.1, 0.4, 0.8])
def test_a_stopped_search_resumes_to_the_same_list(tmp_path: Path, stop: float) -> None:
    problem, options = KINDS["poses fitted"]
    begun = time.monotonic()
    whole = synthesize(problem, **options)
    end = time.monotonic() + stop * (time.monotonic() - begun)
    synthesize(problem, **options, record=tmp_path / "search", stop=lambda: time.monotonic() > end)
    assert table(synthesize(problem, **options, record=tmp_path / "search")) == table(whole)


def longer(value: Any, inside: bool = False) -> Any:
    """The same record with every coupler a hundredth longer."""
    if isinstance(value, dict):
        return {key: longer(each, inside or key == "r3") for key, each in value.items()}
    if isinstance(value, list):
        return [longer(each, inside) for each in value]
    return value * 1.01 if inside and isinstance(value, float) else value


def tampered(text: str, change: Callable[[Any], Any]) -> str:
    """A file of a record whose results are changed, with a sum that is right."""
    steps = json.loads(text)["steps"]
    changed = [{"step": step["step"], "result": change(step["result"])} for step in steps]
    return json.dumps(journal_module.content_of(changed))


DAMAGES: dict[str, Callable[[str], str]] = {
    "truncated": lambda text: text[: len(text) // 2],
    "other": lambda text: json.dumps({"steps": [{"step": 1}]}),
    "empty": lambda text: "",
    "linkages that miss": lambda text: tampered(text, longer),
    "a word for a result": lambda text: tampered(text, lambda _: "verified"),
    "fewer attempts": lambda text: tampered(text, lambda _: {"list": []}),
}


@pytest.mark.quick("other", "linkages that miss", "fewer attempts")
@pytest.mark.parametrize("damage", DAMAGES)
def test_damaged_or_false_records_are_repeated(tmp_path: Path, damage: str, fitted: tuple[Path, str]) -> None:
    problem, options = KINDS["poses fitted"]
    record, whole = fitted
    folder = tmp_path / "search"
    shutil.copytree(record, folder)
    for path in folder.glob("0*.json"):
        path.write_text(DAMAGES[damage](path.read_text(encoding="utf-8")), encoding="utf-8")
    found = synthesize(problem, **options, record=folder)
    assert table(found) == whole
    assert found.history is not None
    assert found.history.steps_recorded <= 2  # no design came from the quick pass and the first screening


def test_the_record_of_another_search_is_refused(tmp_path: Path) -> None:
    problem, options = KINDS["poses fitted"]
    folder = recorded(tmp_path / "search")
    with pytest.raises(ProblemError, match="is the record of a search for another problem"):
        synthesize(load("path-ullah"), **options, record=folder)
    with pytest.raises(ProblemError, match="a search with seed 0; here it is 3"):
        synthesize(problem, **options, seed=3, record=folder)
    head = json.loads((folder / "search.json").read_text(encoding="utf-8"))
    for changed, said in (
        (head | {"casadi version": "1.0"}, "a search with casadi version '1.0'; here it is '3"),
        (head | {"format": 0}, "a search with format 0; here it is 2"),
        (head | {"seed": "0"}, "a search with seed '0'; here it is 0"),
        (head | {"seed": False}, "a search with seed False; here it is 0"),
        ([], "is not the record of a search"),
    ):
        (folder / "search.json").write_text(json.dumps(changed), encoding="utf-8")
        with pytest.raises(ProblemError, match=said):
            synthesize(problem, **options, record=folder)
    assert list(folder.glob("0*.json"))


@pytest.mark.slow
def test_other_files_in_its_folder_are_left_alone(tmp_path: Path) -> None:
    problem, options = KINDS["poses fitted"]
    folder = recorded(tmp_path / "search")
    others = [folder / name for name in ("0-notes.json", "2026.json", "9")]
    for path in others:
        path.write_text("mine", encoding="utf-8")
    assert table(synthesize(problem, **options, record=folder)) == table(synthesize(problem, **options))
    assert {path.read_text(encoding="utf-8") for path in others} == {"mine"}
    assert sorted(folder.iterdir()) == sorted(others)


def test_functions_of_the_user_are_not_recorded(tmp_path: Path) -> None:
    with pytest.raises(ProblemError, match="record does not go with constraints or an objective"):
        synthesize(load("luggage"), constraints=[lambda d: d.r2 - 3], record=tmp_path / "search")


def test_a_short_search_leaves_no_record(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(journal_module, "EVERY", 1000.0)
    problem = replace(load("luggage"))
    synthesize(problem, starts=4, record=tmp_path / "search")
    assert not (tmp_path / "search").exists()
