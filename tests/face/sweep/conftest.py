from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from command_runs import BASE

from grashof.sweep.task import solve_task

Write = Callable[..., Path]

# For tests without a search.
STUDY = """\
problem = "base.toml"
[vary]
"path.points[1].y" = { from = 0.5, to = 1.6, steps = 12 }
"""


@pytest.fixture
def write(tmp_path: Path) -> Write:
    """Write a study beside the base problem; its path."""
    (tmp_path / "base.toml").write_text(BASE, encoding="utf-8")

    def to(text: str = STUDY, name: str = "study.toml") -> Path:
        path = tmp_path / name
        path.parent.mkdir(exist_ok=True)
        path.write_text(text, encoding="utf-8")
        return path

    return to


@pytest.fixture(scope="session")
def solved() -> dict[str, Any]:
    """The result of a task."""
    result = solve_task("base", BASE, {"designs": 1, "time_limit": None})
    assert result is not None
    return result


@pytest.fixture
def texts(monkeypatch: pytest.MonkeyPatch, solved: dict[str, Any]) -> list[str]:
    """Texts of the problems solved so far, by a solver that takes no time and names them in its note."""
    solved_texts: list[str] = []

    def solve(name: str, text: str, options: Any, stop: object = None) -> dict[str, Any]:
        solved_texts.append(text)
        return {**solved, "note": text.splitlines()[6]}

    monkeypatch.setattr("grashof.sweep.solving.solve_task", solve)
    return solved_texts
