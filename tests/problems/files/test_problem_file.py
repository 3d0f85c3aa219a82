"""Loading problems: the catalogue, and files."""

import os
import subprocess
import sys
from fnmatch import fnmatchcase
from importlib import resources
from pathlib import Path

import pytest
from refusals import refusal

from grashof.problems import ProblemError, Rotatability, TransmissionOver, catalogue, load, problem_text

GOOD = 'kind = "motion"\ntitle = "mine"\n[motion]\nposes = [[0, 0, 0], [3, 4, 90]]\n'


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path


def refused(problem: str | os.PathLike[str]) -> str:
    said = refusal(load, problem)
    assert "\n" not in said
    return said


@pytest.mark.parametrize("name", catalogue())
def test_every_problem_of_the_catalogue_loads_with_title_and_source(name: str) -> None:
    problem = load(name)
    assert problem.name == name
    assert problem.title
    assert problem.source
    assert len(problem.task) >= 2


def test_the_catalogue_is_sorted_and_is_the_folder() -> None:
    data = resources.files("grashof.problems") / "data"
    files = [*data.iterdir(), *(data / "practice").iterdir()]
    assert list(catalogue()) == sorted(file.name[:-5] for file in files if file.name.endswith(".toml"))
    assert {"luggage", "coupler-angle"} <= set(catalogue())


def test_the_luggage_problem_is_that_of_the_report() -> None:
    luggage = load("luggage")
    assert luggage.task.positions.tolist() == [[5, 4], [3.5, 4], [2, 3], [1, 0]]
    assert luggage.requirements.rotatability is Rotatability.FULL_CRANK
    assert luggage.requirements.link_length == luggage.requirements.coupler_arms == (0.3, 8.0)
    assert luggage.requirements.transmission_min_deg == 15
    assert luggage.requirements.transmission_over is TransmissionOver.TASK
    assert luggage.task.body is not None
    assert luggage.task.body.tolist() == [[0, 0], [1, 0], [1, 1], [0, 1]]
    assert [outline.tolist() for outline in luggage.outlines] == [[[0, 0], [5, 0], [5, 4], [8, 4]]]
    assert luggage.length_unit == "m"


def test_the_text_of_an_unknown_problem() -> None:
    with pytest.raises(
        ProblemError, match=r"^'lugage' is not a problem of the catalogue; did you mean luggage\?$"
    ):
        problem_text("lugage")


@pytest.mark.parametrize("way", [Path, str, lambda path: f"./{path.name}", lambda path: path.name])
def test_a_file_by_its_path(folder: Path, way: type) -> None:
    path = folder / "mine.toml"
    path.write_bytes(b"\xef\xbb\xbf" + GOOD.replace("\n", "\r\n").encode())  # as editors on Windows do
    problem = load(way(path))
    assert (problem.name, problem.title) == ("mine", "mine")
    assert problem.task.size == 5.0


def test_a_bare_name_is_the_catalogue_first_and_then_a_file(folder: Path) -> None:
    for name in ("luggage", "mine"):
        (folder / name).write_text(GOOD, encoding="utf-8")
    assert load("mine").title == "mine"
    assert load("luggage").title != "mine"
    assert load("./luggage").title == "mine"
    assert load(Path("luggage")).title == "mine"


NEITHER = "is neither a problem of the catalogue nor a file;"
NOWHERE = "there is no such file;"


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("lugage", f"'lugage' {NEITHER} did you mean luggage?"),
        ("", f"'' {NEITHER} *"),
        ("lugage.toml", f"lugage.toml: {NOWHERE} did you mean luggage?"),
        ("no/such/folder", f"no/such/folder: {NOWHERE} *"),
        ("sub", "sub: is a folder; it must be a problem file"),
        ("mine.toml/luggage.toml", "mine.toml/luggage.toml: *"),
        ("latin.toml", "latin.toml: is not UTF-8 text, at byte 12"),
        ("a\0b.toml", r"'a\x00b.toml': cannot be read: embedded null*"),
        ("x" * 5000 + ".toml", "x" * 5000 + ".toml: cannot be read: *"),
        ("x" * 5000, "'xxx*"),
    ],
    ids=lambda text: text[:30],
)
def test_names_of_other_files_are_refused(folder: Path, name: str, said: str) -> None:
    (folder / "sub").mkdir()
    (folder / "mine.toml").write_text(GOOD, encoding="utf-8")
    (folder / "latin.toml").write_bytes('title = "Gelände"'.encode("latin-1"))
    assert fnmatchcase(refused(name).replace(os.sep, "/"), said.replace("luggage?", "luggage[?]"))


@pytest.mark.skipif(not hasattr(os, "geteuid") or os.geteuid() == 0, reason="root reads everything")
def test_a_file_without_permission(folder: Path) -> None:
    path = folder / "locked.toml"
    path.write_text(GOOD, encoding="utf-8")
    path.chmod(0)
    assert refused("locked.toml") == "locked.toml: cannot be read: Permission denied"


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ('kind = "motion"\nposes = [1,,2]', "is not TOML: Invalid value (at line 2, column 12)"),
        ("a = 1\na = 2\n", "is not TOML: a key or table is given twice (at line 2, column 6)"),
        ("a = " + "[" * 100_000, "is not TOML: "),
    ],
)
def test_a_file_that_is_not_toml(folder: Path, text: str, expected: str) -> None:
    (folder / "bad.toml").write_text(text, encoding="utf-8")
    assert refused("bad.toml").startswith(f"bad.toml: {expected}")


def test_errors_inside_a_file_begin_with_its_name(folder: Path) -> None:
    (folder / "bad.toml").write_text(GOOD + "[requirements]\nlink_lenght = [1, 2]\n", encoding="utf-8")
    assert refused("bad.toml") == "bad.toml: requirements.link_lenght is unknown; did you mean link_length?"
    (folder / "empty.toml").touch()
    assert refused("empty.toml") == "empty.toml: kind is missing"


def test_importing_the_package_loads_no_libraries_for_files() -> None:
    code = "import sys, grashof.problems; print(sorted({'pydantic', 'casadi', 'shapely'} & set(sys.modules)))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == "[]\n"
