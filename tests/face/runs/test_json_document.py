"""`--json`: one document on stdout whatever ends the command, and the exit code that it has without."""

from __future__ import annotations

import json
import signal
from collections.abc import Callable
from dataclasses import replace
from math import nan
from pathlib import Path
from typing import Any

import pytest
from command_runs import Grashof, failing
from refusals import rows

from grashof import load
from grashof.output import run_files
from grashof.output.document import Document
from grashof.output.process import Interruption
from grashof.problems import Problem, SolverError
from grashof.synth import Result

QUICK = ("--drawings", "0", "--json")
ALWAYS = {"status", "exit_code", "error", "folder", "files", "grashof", "note", "ended", "proof", "designs"}


def no_constant(name: str) -> None:
    """JSON has no such number."""
    raise AssertionError(name)


def read(text: str) -> dict[str, Any]:
    """The only document of a text, by the rules of JSON."""
    found: dict[str, Any] = json.loads(text, parse_constant=no_constant)
    assert found.keys() >= ALWAYS
    return found


@pytest.mark.usefixtures("found_at_once")
def test_the_document_is_the_list_that_is_written(grashof: Grashof, tmp_path: Path) -> None:
    plain = grashof("solve", "luggage", "--drawings", "0", "--out", "plain")
    done = grashof("solve", "luggage", *QUICK)
    assert (done.exit_code, done.stderr) == (0, plain.stderr.replace("plain", "luggage-designs"))
    document, folder = read(done.stdout), tmp_path / "luggage-designs"
    written = json.loads((folder / "candidates.json").read_text())
    assert {key: document[key] for key in written} == written
    record = json.loads((folder / "run.json").read_text())
    shared = document.keys() & record.keys() - {"designs"}
    assert shared >= {"complete", "ended", "note", "proof", "intervals", "files", "least_error"}
    assert {key: document[key] for key in shared} == {key: record[key] for key in shared}
    assert (document["status"], document["exit_code"], document["error"]) == ("found", 0, "")
    assert set(document["files"]) == {path.name for path in folder.iterdir()}
    assert tmp_path / document["folder"] == folder
    (tmp_path / "document.json").write_text(done.stdout)  # a list of designs, as candidates.json is
    assert grashof("judge", "document.json#2", "luggage").exit_code == 0


def test_proof_and_unknown_numbers(
    grashof: Grashof, few: Result, proven: Result, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("grashof.synth.synthesize", lambda *_, **__: replace(proven, least_error=nan))
    document = read(grashof("solve", "luggage", *QUICK).stdout)
    assert proven.proof is not None
    assert document["proof"] == proven.proof.stated
    assert (document["least_error"], document["most_error"]) == (None, None)


def test_no_design(grashof: Grashof, tmp_path: Path, few: Result, monkeypatch: pytest.MonkeyPatch) -> None:
    none = replace(few, candidates=(), nearest=few.candidates[:1], note="nothing reaches 60 deg")
    monkeypatch.setattr("grashof.synth.synthesize", lambda *_, **__: none)
    done = grashof("solve", "luggage", *QUICK)
    document = read(done.stdout)
    assert (done.exit_code, document["status"], document["exit_code"]) == (1, "none", 1)
    assert (document["note"], document["designs"], document["problem"]) == (none.note, [], "luggage")
    assert set(document["files"]) == {"nearest.csv", "report.html", "run.json"}


REFUSED = rows("""
nowhere | 'nowhere' is neither a problem of the catalogue nor a file
luggage --starts -1 | Invalid value for '--starts'
luggage --out mine/file | File exists
luggage --shard 1/2 | --json does not go with --shard
luggage --log x.toml | --log x.toml: is a problem file
""")


@pytest.mark.parametrize(("arguments", "said"), REFUSED)
def test_bad_input(grashof: Grashof, tmp_path: Path, arguments: str, said: str) -> None:
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine/file").write_text("mine")
    done = grashof("solve", *arguments.split(), *QUICK)
    document = read(done.stdout)
    assert (done.exit_code, document["status"], document["exit_code"]) == (2, "bad input", 2)
    assert said in document["error"]
    assert f"grashof: {document['error']}\n" == done.stderr
    assert (document["folder"], document["designs"]) == (None, [])


def test_every_error_of_a_file_is_a_line(grashof: Grashof, tmp_path: Path) -> None:
    (tmp_path / "mine.toml").write_text('kind = "motion"\nheading = 1\n[motion]\nposes = 3\n')
    document = read(grashof("solve", "mine.toml", *QUICK).stdout)
    assert [line.split(" is ")[0] for line in document["error"].splitlines()] == [
        "mine.toml: motion.poses",
        "mine.toml: heading",
    ]


FAILURES = [
    (SolverError("the scheduler is lost"), 3, "environment error", "the scheduler is lost"),
    (OSError(28, "No space left on device"), 3, "environment error", "[Errno 28] No space left on device"),
    (KeyboardInterrupt(), 130, "interrupted", "interrupted"),
    (IndexError("7"), 3, "environment error", "unexpected error: IndexError: 7; GRASHOF_TRACEBACK=1"),
]


@pytest.mark.parametrize(("error", "code", "status", "said"), FAILURES)
def test_failures(
    grashof: Grashof, monkeypatch: pytest.MonkeyPatch, error: BaseException, code: int, status: str, said: str
) -> None:
    monkeypatch.setattr("grashof.synth.synthesize", failing(error))
    done = grashof("solve", "luggage", *QUICK)
    document = read(done.stdout)
    assert (done.exit_code, document["exit_code"], document["status"]) == (code, code, status)
    assert document["error"].startswith(said)


@pytest.mark.usefixtures("found_at_once")
def test_a_full_disk_costs_no_design(
    grashof: Grashof, few: Result, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(run_files, "write_json", failing(OSError(28, "No space left on device")))
    done = grashof("solve", "luggage", *QUICK)
    document = read(done.stdout)
    assert (done.exit_code, document["status"]) == (3, "environment error")
    assert "No space left on device" in document["error"]
    assert [each["id"] for each in document["designs"]] == [each.id for each in few.candidates]
    assert (document["folder"], document["files"]) == (None, [])


def _interrupting(result: Result) -> Callable[..., Result]:
    def synthesize(_: Problem, *, stop: Interruption, **__: Any) -> Result:
        signal.raise_signal(signal.SIGINT)
        assert stop()
        return result

    return synthesize


@pytest.mark.parametrize("designs", [0, 3])
def test_ctrl_c(grashof: Grashof, few: Result, monkeypatch: pytest.MonkeyPatch, designs: int) -> None:
    so_far = replace(few, candidates=few.candidates[:designs], complete=False, note="interrupted early")
    monkeypatch.setattr("grashof.synth.synthesize", _interrupting(so_far))
    done = grashof("solve", "luggage", *QUICK)
    document = read(done.stdout)
    assert (done.exit_code, document["status"], document["exit_code"]) == (130, "interrupted", 130)
    assert (len(document["designs"]), document["complete"]) == (designs, False)
    assert document["note"] == "interrupted early"
    assert document["folder"] == ("luggage-designs" if designs else None)


def test_a_time_limit(grashof: Grashof) -> None:
    done = grashof("solve", "path-ellipse", "--time-limit", "0.05", *QUICK)
    document = read(done.stdout)
    assert done.exit_code == document["exit_code"] == (0 if document["designs"] else 1)
    assert document["note"] or document["ended"]


def test_a_merge_without_shards(grashof: Grashof, tmp_path: Path) -> None:
    done = grashof("merge", "nowhere", "--json")
    assert (done.exit_code, read(done.stdout)["status"]) == (2, "bad input")


def test_designs_without_a_run_are_the_same(few: Result) -> None:
    document = Document()
    document.note_list(few)
    assert document.content["designs"] == run_files.list_content(few)["designs"]
    assert document.content["length_unit"] == load("luggage").length_unit
