"""The documentation has the requirements that are declared, and links and paths that lead somewhere."""

import re
from dataclasses import fields
from pathlib import Path

import pytest

from grashof.problems import Requirements
from grashof.problems.values.requirements.requirements import LIMITS
from grashof.problems.values.units import Unit

ROOT = Path(__file__).parents[1]
README = (ROOT / "README.md").read_text(encoding="utf-8")
PROBLEM = (ROOT / "docs" / "howto" / "problem-file.md").read_text(encoding="utf-8")
REQUIREMENTS = PROBLEM.split("\n[requirements]\n")[1].split("\n[objective]\n")[0]


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


def test_the_readme_is_a_screen_or_two() -> None:
    assert len(README.splitlines()) <= 80


@pytest.mark.parametrize(
    "page", [*sorted(ROOT.glob("docs/**/*.md")), ROOT / "README.md"], ids=lambda page: page.stem
)
def test_links_between_pages_lead_somewhere(page: Path) -> None:
    linked = re.findall(r"\]\((?!https?:)([^)#]+)[^)]*\)", page.read_text(encoding="utf-8"))
    built = ("examples/", "generated/")  # when the pages are built
    assert [name for name in linked if not name.startswith(built) and not (page.parent / name).exists()] == []


def test_the_batch_script_is_the_one_on_its_page() -> None:
    script = (ROOT / "docs" / "shards.sh").read_text(encoding="utf-8")
    page = (ROOT / "docs" / "howto" / "long-searches.md").read_text(encoding="utf-8")
    assert f"```sh\n{script}```" in page
