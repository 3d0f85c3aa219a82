"""The documentation has the requirements that are declared, and links and paths that lead somewhere."""

import re
from dataclasses import fields
from pathlib import Path

from grashof.problems import Requirements
from grashof.problems.values.requirements.requirements import LIMITS
from grashof.problems.values.units import Unit

ROOT = Path(__file__).parents[1]
README = (ROOT / "README.md").read_text(encoding="utf-8")
PROBLEM = (ROOT / "docs" / "howto" / "problem-file.md").read_text(encoding="utf-8")
CONTRIBUTORS = ("docs/architecture.md", "docs/conventions.md", "CONTRIBUTING.md")
REQUIREMENTS = PROBLEM.split("\n[requirements]\n")[1].split("\n[objective]\n")[0]


def test_every_requirement_is_in_the_example() -> None:
    assert {field.name for field in fields(Requirements)} <= set(re.findall(r"\w+", REQUIREMENTS))


def test_keys_of_limits_that_are_angles_end_in_deg() -> None:
    angles = {name for name, limit in LIMITS.items() if limit.quantity.unit is Unit.ANGLE}
    assert {name for name in LIMITS if name.endswith("_deg")} == angles


def test_paths_that_are_named_exist() -> None:
    """For contributors every path, and of all pages the scripts."""
    texts = [(ROOT / page).read_text(encoding="utf-8") for page in CONTRIBUTORS]
    for page in ROOT.glob("docs/**/*.md"):
        texts += re.findall(r"\b(?:tests/)?scripts/[\w/]+\.py", page.read_text(encoding="utf-8"))
    paths = r"(?<![\w/.])(?:problems|analysis|synth|src|tests|scripts|docs|\.ci)/[\w/.*-]*"
    named = re.findall(paths, "\n".join(texts))
    assert [path for path in named if not any(ROOT.glob(path.rstrip("./")))] == []


def test_the_readme_is_short_and_links_the_pages_for_contributors() -> None:
    assert len(README.splitlines()) <= 80
    for page in CONTRIBUTORS:
        assert f"`{page}`" in README


def test_links_between_pages_lead_somewhere() -> None:
    built = ("examples/", "generated/")  # when the pages are built
    for page in (*ROOT.glob("docs/**/*.md"), ROOT / "README.md"):
        linked = re.findall(r"\]\((?!https?:)([^)#]+)[^)]*\)", page.read_text(encoding="utf-8"))
        lost = [name for name in linked if not name.startswith(built) and not (page.parent / name).exists()]
        assert lost == [], page


def test_the_batch_script_is_the_one_on_its_page() -> None:
    script = (ROOT / "docs" / "shards.sh").read_text(encoding="utf-8")
    page = (ROOT / "docs" / "howto" / "long-searches.md").read_text(encoding="utf-8")
    assert f"```sh\n{script}```" in page
