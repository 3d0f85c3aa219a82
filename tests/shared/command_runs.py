"""Shared by tests of the command line: the command here and in a process of its own, a small problem."""

import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

Grashof = Callable[..., Any]  # the fixture of this name
# Solved quickly.
BASE = """\
kind = "path"
length_unit = "mm"
[path]
points = [[0, 0], [1, 1], [2, 0]]
[search]
starts = 1
enough = 1
effort = 0.2
"""
COMMAND = [sys.executable, "-c", "from grashof.cli import main; main()"]


def script_done(script: str, folder: Path) -> subprocess.CompletedProcess[str]:
    """A script that ran to its end in a folder, with processes of its own."""
    (folder / "script.py").write_text(script, encoding="utf-8")
    command = [sys.executable, "script.py"]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=400)
    assert done.returncode == 0, done.stderr
    return done


def assert_one_line(done: Any, code: int, *words: str) -> None:
    """The exit code, and one line on stderr with these words."""
    assert done.exit_code == code
    (line,) = done.stderr.splitlines()
    assert line.startswith("grashof: ")
    for word in words:
        assert word in line


def failing(error: BaseException) -> Callable[..., None]:
    """A function that raises an error whatever it is given."""

    def fail(*_: object, **__: object) -> None:
        raise error

    return fail
