"""The documentation has the quantities, columns and requirements that are declared, and paths that exist."""

import re
from dataclasses import fields
from pathlib import Path

import pytest

from grashof.problems import Requirements
from grashof.problems.values.quantities import Unit
from grashof.problems.values.requirements import LIMITS
from grashof.synth.designs.table import COLUMNS, LISTED

ROOT = Path(__file__).parents[1]
README = (ROOT / "README.md").read_text(encoding="utf-8")
# Columns by name, with the unit of their row.
ROWS = {
    name: unit.strip()
    for names, unit in re.findall(r"^\| (`[^|]+) \|([^|]*)\|[^|]+\|$", README, re.MULTILINE)
    for name in re.findall(r"`(\w+)`", names)
}
REQUIREMENTS = README.split("\n[requirements]\n")[1].split("\n[objective]\n")[0]


@pytest.mark.parametrize("name", COLUMNS)
def test_every_column_has_a_row(name: str) -> None:
    assert name in ROWS


def test_no_row_is_of_a_column_that_is_gone() -> None:
    assert set(ROWS) == set(COLUMNS)


@pytest.mark.parametrize("quantity", LISTED, ids=lambda each: each.key)
def test_rows_state_the_unit(quantity) -> None:  # type: ignore[no-untyped-def]
    assert ROWS[quantity.column] == quantity.unit


@pytest.mark.parametrize("name", [field.name for field in fields(Requirements)])
def test_every_requirement_is_in_the_example(name: str) -> None:
    assert re.search(rf"\b{name}\b", REQUIREMENTS)


@pytest.mark.parametrize("name", LIMITS)
def test_a_limit_that_is_an_angle_says_so_by_its_key(name: str) -> None:
    assert name.endswith("_deg") == (LIMITS[name].quantity.unit is Unit.ANGLE)


@pytest.mark.parametrize("page", ["docs/architecture.md", "docs/conventions.md", "CONTRIBUTING.md"])
def test_paths_that_are_named_exist(page: str) -> None:
    text = (ROOT / page).read_text(encoding="utf-8")
    named = re.findall(r"(?<![\w/.])(?:problems|analysis|synth|src|tests|scripts|docs|\.ci)/[\w/.*-]*", text)
    assert [path for path in named if not any(ROOT.glob(path.rstrip("./")))] == []


def test_the_readme_links_the_pages_for_those_who_change_the_code() -> None:
    for page in ("docs/architecture.md", "docs/conventions.md", "CONTRIBUTING.md"):
        assert f"`{page}`" in README


def test_the_batch_script_is_the_one_in_the_readme() -> None:
    script = (ROOT / "docs" / "shards.sh").read_text(encoding="utf-8")
    assert f"```sh\n{script}```" in (ROOT / "README.md").read_text(encoding="utf-8")
