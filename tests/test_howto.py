"""The Python of the pages, run as it stands there, a page after the other."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

import matplotlib as mpl
import pytest

DOCS = Path(__file__).parents[1] / "docs"
BLOCK = re.compile(r"^```python\n(.*?)^```", re.MULTILINE | re.DOTALL)
IN_A_CELL = "howto/live.md"  # shown by a cell of a notebook; `test_widget` has it
SLOW = {"howto/figures.md", "howto/sweeps.md"}


def pages() -> list[str]:
    found = (path for path in DOCS.rglob("*.md") if BLOCK.search(path.read_text(encoding="utf-8")))
    return sorted(path.relative_to(DOCS).as_posix() for path in found if path.parent.name != "tutorials")


@pytest.mark.quick("howto/export.md")
@pytest.mark.parametrize(
    "page",
    [
        pytest.param(page, marks=pytest.mark.slow) if page in SLOW else page
        for page in pages()
        if page != IN_A_CELL
    ],
)
def test_the_python_of_a_page_runs(page: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "docs").mkdir()
    for file in DOCS.glob("*.toml"):
        shutil.copy(file, tmp_path / "docs")
    names: dict[str, object] = {}
    with mpl.rc_context({"backend": "agg"}):
        for text in BLOCK.findall((DOCS / page).read_text(encoding="utf-8")):
            exec(compile(text, page, "exec"), names)  # noqa: S102
    if "designs" in names:  # of `track`: in their order, and moved ones are designs again
        tracked = names["designs"]
        assert isinstance(tracked, list | tuple)
        assert sum(each.verdict.ok for each in tracked) >= 8
    for name in ("links.dxf", "space.pdf", "luggage.gif", "candidates.csv"):
        if f'"{name}"' in "".join(BLOCK.findall((DOCS / page).read_text(encoding="utf-8"))):
            assert (tmp_path / name).stat().st_size > 1000


@pytest.mark.slow
def test_own_constraint_of_the_page_is_kept(tmp_path: Path) -> None:
    first = BLOCK.findall((DOCS / "howto/own-constraint.md").read_text(encoding="utf-8"))[0]
    names: dict[str, object] = {}
    exec(compile(first, "own-constraint", "exec"), names)  # noqa: S102
    designs = names["result"].candidates  # type: ignore[attr-defined]
    assert designs
    assert all(abs(each.linkage.o2[0] - each.linkage.o4[0]) <= 2 + 1e-6 for each in designs)
