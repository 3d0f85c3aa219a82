"""The package as a whole: its map of folders, its layers, what importing it costs."""

import ast
import subprocess
import sys
import tomllib
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
FOLDERS = {"problems": "grashof.problems", "analysis": "grashof.analysis", "synth": "grashof.synth"}
# Every layer may import from those before it.
LAYERS = ("grashof.problems", "grashof.analysis", "grashof.synth", "grashof")


def test_package_map_names_every_folder() -> None:
    settings = tomllib.loads((ROOT / "pyproject.toml").read_text())["tool"]["setuptools"]
    with_code = {path.parent.relative_to(ROOT).as_posix() for path in ROOT.glob("*/__init__.py")}
    with_code |= {path.parent.relative_to(ROOT).as_posix() for path in ROOT.glob("src/*/__init__.py")}
    assert set(settings["package-dir"].values()) == with_code == {*FOLDERS, "src/grashof"}
    # Packages inside the face need no place of their own in the map: they lie where their names say.
    face = {f"grashof.{path.parent.name}" for path in (ROOT / "src" / "grashof").glob("*/__init__.py")}
    assert {*settings["package-dir"], *face} == set(settings["packages"])
    nested = [path for folder in FOLDERS for path in (ROOT / folder).glob("*/__init__.py")]
    assert nested == []


def imports(path: Path) -> Iterator[str]:
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            yield node.module or ""


@pytest.mark.parametrize("folder", FOLDERS)
def test_layers_import_only_from_below(folder: str) -> None:
    mine = LAYERS.index(FOLDERS[folder])
    for path in (ROOT / folder).glob("*.py"):
        for name in imports(path):
            if name == "grashof" or name.startswith("grashof."):
                layer = ".".join(name.split(".")[:2])
                assert layer in LAYERS[: mine + 1], f"{path.name} imports {name}"
            if folder != "synth":
                assert not name.startswith("casadi"), f"{path.name} imports casadi"


def modules_after(statement: str) -> set[str]:
    code = f"{statement}\nimport sys\nprint(*sys.modules)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    return set(done.stdout.split())


def test_importing_grashof_loads_no_solver_and_no_plots() -> None:
    loaded = modules_after("import grashof")
    assert not loaded & {"casadi", "jinja2", "matplotlib", "pandas", "pydantic", "rich", "shapely"}


def test_a_worker_process_loads_only_what_it_solves_with() -> None:
    loaded = modules_after("import grashof.synth.attempt")
    assert "casadi" in loaded
    assert not loaded & {"matplotlib", "pandas", "pydantic", "rich", "shapely"}


def test_the_public_verbs() -> None:
    import grashof

    plots = {"plot_linkage", "plot_coupler_curve", "plot_kinematics", "plot_dynamics", "plot_design_space"}
    assert set(grashof.__all__) == {"GrashofError", "load", "synthesize", "animate"} | plots
    assert all(callable(getattr(grashof, name)) for name in grashof.__all__)
    with pytest.raises(AttributeError, match="no attribute 'solve'"):
        _ = grashof.solve
