"""The command line: usage, exit codes, one line for each error."""

from __future__ import annotations

import os
import socket
import subprocess
import sys
from importlib.metadata import version
from importlib.util import find_spec
from pathlib import Path

import pytest
from command_runs import COMMAND, Grashof, assert_one_line, failing
from refusals import rows

from grashof.problems import catalogue, linkage_catalogue, linkage_text, load, problem_text

BAD = rows(r"""
poses = [[5, 4, 0], [3.5, 4, -5], [2, 3, -5], [1, 0, 0]] | poses = [[5, 4, 0]] | two or more
[3.5, 4, -5] | [nan, 4, -5] | finite
[3.5, 4, -5] | [3.5, 4] | motion.poses[1]
[1, 0, 0]] | [5, 4, 0]] | equal
[3.5, 4, -5] | [5, 4, 360] | equal
link_length = [0.3, 8] | link_length = [8, 0.3] | link_length
coupler_arms | coupler_arm | did you mean coupler_arms?
[requirements] | [objective]\nmaximise = 'power'\n[requirements] |
    it must be transmission, compactness, torque, another quantity
[requirements] | [requirements]\nkeep_out = [[[0, 0], [2, 2], [2, 0], [0, 2]]] |
    requirements.keep_out[0] crosses or touches itself at (1, 1)
[motion] | [motion | TOML
[1, 0, 0]] | [1, 0, 0], { x = 2 }] | has one of x and y
""")


@pytest.mark.parametrize(("old", "new", "said"), BAD)
def test_bad_input_is_one_line_and_writes_nothing(
    grashof: Grashof, tmp_path: Path, old: str, new: str, said: str
) -> None:
    text = problem_text("luggage")
    assert old in text
    (tmp_path / "mine.toml").write_text(text.replace(old, new), encoding="utf-8")
    done = grashof("solve", "mine.toml")
    assert_one_line(done, 2, said)
    assert [path.name for path in tmp_path.iterdir()] == ["mine.toml"]
    checked = grashof("check", "mine.toml")
    assert (checked.exit_code, checked.stdout, checked.stderr) == (2, "", done.stderr)


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ("solve luggage --starts 0", "--starts"),
        ("solve luggage --workers none", "--workers"),
        ("solve luggage --time-limit -1", "time_limit is -1.0"),
        ("solve luggage --time-limit nan", "time_limit is nan"),
        ("solve luggage --sed 1", "--seed"),
        ("solve luggage --effort 10001", "--effort"),
        ("solve luggage --effort nan", "--effort"),
        ("solve", "PROBLEM"),
        ("solve nowhere.toml", "nowhere.toml"),
        ("solve lugage", "'lugage' is neither a problem of the catalogue nor a file; did you mean luggage?"),
        ("solv luggage", "solve"),
        (f"solve luggage --out {'x' * 300}", "File name too long"),
        pytest.param(
            "solve luggage --scheduler x",
            "--scheduler x: missing port number",
            marks=[
                pytest.mark.extra,
                pytest.mark.skipif(find_spec("distributed") is None, reason="needs Dask"),
            ],
        ),
    ],
)
def test_bad_usage_is_one_line(grashof: Grashof, tmp_path: Path, arguments: str, said: str) -> None:
    done = grashof(*arguments.split())
    assert_one_line(done, 2, said)
    assert list(tmp_path.iterdir()) == []


def test_help_is_no_error(grashof: Grashof) -> None:
    assert grashof("--help").exit_code == 0
    assert "--time-limit" in grashof("solve", "--help").stdout
    assert "Usage" in grashof().output


def test_the_help_kept_as_text_is_that_of_the_commands(tmp_path: Path) -> None:
    def printed(command: list[str], **environment: str) -> str:
        done = subprocess.run(
            [*command, "--help"],
            cwd=tmp_path, env={**os.environ, "COLUMNS": "80", **environment},
            capture_output=True, text=True, check=True,
        )  # fmt: skip
        return done.stdout

    # To write src/grashof/help.txt again: COLUMNS=80 python -c "from grashof.cli import main; main()" --help
    assert printed([sys.executable, "-m", "grashof"]) == printed(COMMAND)
    narrow = printed([sys.executable, "-m", "grashof"], COLUMNS="60")
    assert max(map(len, narrow.splitlines())) <= 60
    assert narrow.split()[:4] == printed(COMMAND).split()[:4]


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs a disk that is full")
def test_help_that_cannot_be_written_is_one_line() -> None:
    with Path("/dev/full").open("w") as full:
        done = subprocess.run(
            [sys.executable, "-m", "grashof", "--help"],
            stdout=full,
            stderr=subprocess.PIPE,
            text=True,
            check=False,
        )  # fmt: skip
    assert (done.returncode, done.stderr) == (3, "grashof: standard output: No space left on device\n")


def test_check_and_problems(grashof: Grashof, tmp_path: Path) -> None:
    done = grashof("check", "luggage")
    assert done.exit_code == 0
    for said in (
        "4 poses",
        "5.65685 m",
        "angle over the task: from 15 deg",
        "link length: 0.3 to 8 m",
        "full-crank",
    ):
        assert said in done.stdout
    listed = [line.split(maxsplit=1) for line in grashof("problems").stdout.splitlines()]
    assert [tuple(line) for line in listed] == [(name, load(name).title) for name in catalogue()]
    text = grashof("problems", "luggage").stdout
    (tmp_path / "copy.toml").write_text(text, encoding="utf-8")
    assert grashof("check", "copy.toml").exit_code == 0
    assert grashof("problems", "nothing").exit_code == 2


def test_linkages_of_the_catalogue(grashof: Grashof) -> None:
    listed = grashof("linkages").stdout.splitlines()
    assert tuple(line.split()[0] for line in listed) == linkage_catalogue()
    assert grashof("linkages", "pumpjack").stdout == linkage_text("pumpjack")
    assert "did you mean pumpjack?" in grashof("linkages", "pumpjak").stderr
    assert grashof("check", "nothing").exit_code == 2


def test_the_version(grashof: Grashof) -> None:
    done = grashof("--version")
    assert (done.exit_code, done.stdout) == (0, f"grashof {version('grashof')}\n")


def test_control_characters_of_names_do_not_reach_the_terminal(grashof: Grashof, tmp_path: Path) -> None:
    path = tmp_path / "red\x1b[31m.toml"
    done = grashof("check", path)
    assert done.exit_code == 2
    assert "red?[31m.toml: there is no such file" in done.stderr
    path.write_text(problem_text("luggage"), encoding="utf-8")
    assert grashof("check", path).stdout.startswith("red?[31m: Luggage")


def test_an_unexpected_error_ends_with_one_line(grashof: Grashof, monkeypatch: pytest.MonkeyPatch) -> None:
    broken = failing(ZeroDivisionError("division\nby zero"))
    monkeypatch.setattr("grashof.wording.problem.summary", broken)
    monkeypatch.delenv("GRASHOF_TRACEBACK", raising=False)
    done = grashof("check", "luggage")
    assert done.exit_code == 3
    line = done.stderr.removesuffix("\n")
    assert line.startswith("grashof: unexpected error: ZeroDivisionError: division by zero;")
    assert "\n" not in line
    monkeypatch.setenv("GRASHOF_TRACEBACK", "1")
    done = grashof("check", "luggage")
    assert done.exit_code == 3
    assert "Traceback (most recent call last)" in done.stderr
    assert done.stderr.splitlines()[-1] == line


@pytest.mark.study
def test_no_backend_of_matplotlib_interferes(tmp_path: Path) -> None:
    environment = {**os.environ, "MPLBACKEND": "nonsense"}
    code = "import sys; from grashof.cli import main; sys.argv[0] = 'grashof'; main()"
    done = subprocess.run(
        [sys.executable, "-c", code, "animate", "pumpjack", "--seconds", "0.2", "--fps", "10"],
        cwd=tmp_path, env=environment, capture_output=True, text=True, timeout=120, check=False,
    )  # fmt: skip
    assert (done.returncode, done.stderr) == (0, "pumpjack.gif\n")


def test_every_error_of_a_file_has_its_line(grashof: Grashof, tmp_path: Path) -> None:
    path = tmp_path / "bad.toml"
    path.write_text('kind = "motion"\n[motion]\nposes = [[1, 2], [3, 4, 5], 6]\n[search]\nseed = -1\n')
    done = grashof("check", path)
    assert done.exit_code == 2
    assert done.stderr.splitlines() == [
        f"grashof: {path}: motion.poses[0] is [1, 2], 2 numbers; it must be a pose [x, y, angle in degrees]",
        f"grashof: {path}: motion.poses[2] is 6; it must be a pose [x, y, angle in degrees]",
        f"grashof: {path}: search.seed is -1; it must be a whole number from 0",
    ]


def test_a_port_that_is_taken_is_refused(grashof: Grashof) -> None:
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
        done = grashof("live", "--port", port, "--no-browser")
    assert_one_line(done, 3, f"grashof: --port {port}: ", "; 0 takes a free one")
