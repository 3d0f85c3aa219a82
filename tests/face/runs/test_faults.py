"""Full disks, closed streams, folders for files: one clear line, the right exit code, no older file lost."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from command_runs import COMMAND, Grashof, assert_one_line, failing
from matplotlib.animation import FuncAnimation
from refusals import rows

from grashof.output import run_files
from grashof.output.analysis_files import write_report
from grashof.output.process import say
from grashof.problems import load_linkage_spec
from grashof.survey import report_on
from grashof.synth.search import journal
from grashof.synth.starts import coupler_search

FULL = OSError(28, "No space left on device")
QUICK = ("--starts", "2", "--drawings", "0")


def in_shell(streams: str, *arguments: str, cwd: Path) -> subprocess.CompletedProcess[str]:
    """The command in a process of its own, with streams as a shell states them."""
    command = ["sh", "-c", f'exec "$0" "$@" {streams}', *COMMAND, *arguments]
    return subprocess.run(command, cwd=cwd, capture_output=True, text=True, timeout=120)


@pytest.fixture
def full(monkeypatch: pytest.MonkeyPatch) -> None:
    """A disk on which no bytes have room, though names have."""
    for owner, name in ((Path, "write_bytes"), (Path, "write_text"), (FuncAnimation, "save")):
        monkeypatch.setattr(owner, name, failing(FULL))


@pytest.fixture
def analysed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[dict[Path, bytes]]:
    """Files of an older analysis, which must stay."""
    monkeypatch.setattr("grashof.figures.section_plots.plots", lambda _: [])
    folder = tmp_path / "pumpjack-analysis"
    write_report(folder, report_on(load_linkage_spec("pumpjack")))
    before = {path: path.read_bytes() for path in folder.iterdir()}
    yield before
    assert {path: path.read_bytes() for path in folder.iterdir()} == before


@pytest.mark.slow
def test_a_full_disk_keeps_the_older_analysis(
    grashof: Grashof, analysed: dict[Path, bytes], full: None
) -> None:
    assert len(analysed) > 5
    assert_one_line(grashof("analyse", "pumpjack"), 3, "No space left on device", "pumpjack-analysis")


@pytest.mark.usefixtures("full")
@pytest.mark.parametrize(
    ("name", "arguments"),
    [
        ("motion.gif", ("animate", "pumpjack", "--seconds", "0.1", "--out")),
        ("parts.svg", ("export", "pumpjack", "--scale", "1:20", "--svg")),
        ("parts.dxf", ("export", "pumpjack", "--scale", "1:20", "--dxf")),
    ],
)
def test_a_full_disk_keeps_the_older_file(
    grashof: Grashof, tmp_path: Path, name: str, arguments: tuple[str, ...]
) -> None:
    with (tmp_path / name).open("w") as file:
        file.write("old")
    assert_one_line(grashof(*arguments, name), 3, "No space left on device", name)
    assert (tmp_path / name).read_text() == "old"
    assert [path.name for path in tmp_path.iterdir()] == [name]


MISPLACED = rows("""
solve folder | folder: is a folder; it must be a problem file
check folder.toml | folder.toml: is a folder; it must be a problem file
analyse folder | folder: is a folder; it must be a linkage file
analyse folder.json#1 | folder.json: is a folder; it must be a list of designs
animate pumpjack --out folder.gif | folder.gif: is a folder; it must be a file
export pumpjack --svg folder.svg | folder.svg: is a folder; it must be a file
solve luggage --out file | --out file: File exists; it must be a folder
analyse pumpjack --out file | --out file: File exists; it must be a folder
analyse pumpjack --out file/below | it must be a folder that can be written
animate pumpjack --out file/below.gif | it must be a file in a folder that can be written
export pumpjack --svg file/below.svg | there is no folder file
""")


@pytest.mark.parametrize(("arguments", "said"), MISPLACED)
def test_a_folder_for_a_file_and_a_file_for_a_folder(
    grashof: Grashof, tmp_path: Path, arguments: str, said: str
) -> None:
    for kind in ("", ".toml", ".json", ".gif", ".svg"):
        (tmp_path / f"folder{kind}").mkdir()
    (tmp_path / "file").write_text("mine")
    before = set(tmp_path.rglob("*"))
    assert_one_line(grashof(*arguments.split()), 2, said)
    assert set(tmp_path.rglob("*")) == before
    assert (tmp_path / "file").read_text() == "mine"


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no device that is always full")
@pytest.mark.parametrize("command", ["problems", "--version"])
def test_stdout_that_takes_nothing_is_reported_in_one_line(tmp_path: Path, command: str) -> None:
    done = in_shell(">/dev/full", command, cwd=tmp_path)
    assert done.returncode == 3
    assert done.stderr == "grashof: standard output: No space left on device\n"


@pytest.mark.slow
@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no device that is always full")
def test_stderr_that_takes_nothing_costs_no_result(tmp_path: Path) -> None:
    done = in_shell("2>/dev/full", "solve", "luggage", *QUICK, cwd=tmp_path)
    assert done.returncode == 0
    assert "verified" in done.stdout
    assert json.loads((tmp_path / "luggage-designs" / "run.json").read_text())["designs"] > 0


@pytest.mark.slow
@pytest.mark.skipif(sys.platform == "win32", reason="a shell of another kind")
@pytest.mark.parametrize("streams", [">&-", pytest.param(">&- 2>&-", marks=pytest.mark.slow)])
def test_closed_streams_cost_no_result(tmp_path: Path, streams: str) -> None:
    done = in_shell(streams, "solve", "luggage", *QUICK, cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert "Error" not in done.stderr
    assert json.loads((tmp_path / "luggage-designs" / "run.json").read_text())["designs"] > 0


def test_a_line_that_stdout_cannot_take_is_an_error(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr("typer.echo", failing(FULL))
    with (tmp_path / "out").open("w") as stream:
        monkeypatch.setattr(sys, "stdout", stream)
        monkeypatch.setattr(sys, "stderr", stream)
        say("progress", err=True)
        with pytest.raises(OSError, match="standard output: No space left on device"):
            say("a result")


@pytest.fixture
def recorded(monkeypatch: pytest.MonkeyPatch) -> None:
    """Every step of a search goes into its record at once."""
    monkeypatch.setattr(journal, "EVERY", 0.0)


@pytest.mark.usefixtures("recorded")
def test_a_full_disk_costs_neither_the_table_nor_the_search(
    grashof: Grashof, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with monkeypatch.context() as patch:
        patch.setattr(run_files, "write_json", failing(FULL))
        done = grashof("solve", "luggage", *QUICK)
    assert done.exit_code == 3
    assert "No space left on device" in done.stderr
    assert "search so far; --resume continues it" in done.stderr
    assert "distinct verified" in done.stdout
    folder = tmp_path / "luggage-designs"
    assert [path.name for path in folder.iterdir()] == ["search"]
    again = grashof("solve", "luggage", *QUICK, "--resume")
    assert (again.exit_code, again.stdout) == (0, done.stdout)
    assert json.loads((folder / "run.json").read_text())["run"]["steps_recorded"] > 0
    assert not (folder / "search").exists()


@pytest.mark.slow
@pytest.mark.usefixtures("recorded")
def test_a_record_that_cannot_be_written_ends_the_record_alone(
    grashof: Grashof, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(path: Path, _: object) -> None:
        raise OSError(28, "No space left on device", str(path))

    before = grashof("solve", "luggage", *QUICK)
    monkeypatch.setattr(journal, "write_whole", fail)
    done = grashof("solve", "luggage", *QUICK)
    assert (done.exit_code, done.stdout) == (0, before.stdout)
    assert done.stderr.count("No space left on device; the search continued without its record") == 1
    folder = tmp_path / "luggage-designs"
    assert "No space left on device" in json.loads((folder / "run.json").read_text())["run"]["record_lost"]
    assert not (folder / "search").exists()


@pytest.mark.slow
@pytest.mark.usefixtures("recorded")
def test_a_kind_that_fails_costs_no_design_of_another(
    grashof: Grashof, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "line.toml").write_text(LINE, encoding="utf-8")
    monkeypatch.setattr(coupler_search, "search", failing(IndexError("7 is out of bounds")))
    done = grashof("solve", "line.toml", *QUICK)
    assert done.exit_code == 3
    assert "grashof: unexpected error: IndexError: 7 is out of bounds" in done.stderr
    assert "the search failed; listed is what was verified until then" in done.stderr
    assert "search so far; --resume continues it" in done.stderr
    designs = json.loads((tmp_path / "line-designs" / "candidates.json").read_text())["designs"]
    assert {each["mechanism"] for each in designs} == {"four-bar"}
    assert json.loads((tmp_path / "line-designs" / "run.json").read_text())["run"]["ending"] == "failed"


LINE = """kind = "motion"
mechanism = ["four-bar", "slider-crank"]
[motion]
poses = [[0, 0, 0], [3, 1, 40], [5, 4, 70]]
"""


UNSEARCHABLE = rows("""
["slider-crank", "four-bar"] | [0, 0, 0], [3, 1, 40], [0, 0, 0], [5, 4, 70] | true |
    mechanism four-bar: motion.poses[0] and motion.poses[2] are equal
"inverted-slider-crank" | [0, 0, 0], [3, 1, 40] | false | three or more where requirements.exact
""")


@pytest.mark.parametrize(("kinds", "poses", "exact", "said"), UNSEARCHABLE)
@pytest.mark.parametrize("command", ["check", "solve"])
def test_a_task_that_a_kind_cannot_be_searched_for_is_refused_first(
    grashof: Grashof, tmp_path: Path, command: str, kinds: str, poses: str, exact: str, said: str
) -> None:
    text = f'kind = "motion"\nmechanism = {kinds}\n[motion]\nposes = [{poses}]\n'
    text += f"[requirements]\nexact = {exact}\n"
    (tmp_path / "two.toml").write_text(text, encoding="utf-8")
    assert_one_line(grashof(command, "two.toml"), 2, said)
