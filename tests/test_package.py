"""The package as a whole: its map of folders, its layers, what importing it costs."""

import ast
import re
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
FOLDERS = {"problems": "grashof.problems", "analysis": "grashof.analysis", "synth": "grashof.synth"}
# Every layer may import from those before it.
LAYERS = ("grashof.problems", "grashof.analysis", "grashof.synth", "grashof")


def name_of(path: Path) -> str:
    """Import name of a file, or of the folder of an `__init__.py`."""
    parts = path.relative_to(ROOT).with_suffix("").parts
    parts = parts[1:] if parts[0] == "src" else ("grashof", *parts)
    return ".".join(part for part in parts if part != "__init__")


SOURCES = {name_of(path): path for folder in (*FOLDERS, "src") for path in (ROOT / folder).rglob("*.py")}


def test_package_map_names_every_folder() -> None:
    settings = tomllib.loads((ROOT / "pyproject.toml").read_text())["tool"]["setuptools"]
    homes = {name: folder for folder, name in FOLDERS.items()}
    assert settings["package-dir"] == {**homes, "grashof": "src/grashof"}
    # Packages inside need no place of their own in the map: they lie where their names say.
    with_code = {path.parent for path in SOURCES.values()}
    assert with_code == {SOURCES[name].parent for name in settings["packages"]}
    assert all((folder / "__init__.py").exists() for folder in with_code)


def imported(name: str) -> set[str]:
    """Modules that a module imports, lazily or not; a package where it takes a name from it."""
    found = set()
    for node in ast.walk(ast.parse(SOURCES[name].read_text())):
        if isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            module = node.module or ""
            full = [f"{module}.{alias.name}" for alias in node.names]
            found |= {each if each in SOURCES else module for each in full}
    return found


@pytest.mark.parametrize("name", SOURCES)
def test_layers_import_only_from_below(name: str) -> None:
    mine = layer_of(name)
    for other in imported(name):
        if other == "grashof" or other.startswith("grashof."):
            assert LAYERS.index(layer_of(other)) <= LAYERS.index(mine), f"{name} imports {other}"
        if mine in LAYERS[:2]:
            assert not other.startswith("casadi"), f"{name} imports casadi"


def layer_of(name: str) -> str:
    layer = ".".join(name.split(".")[:2])
    return layer if layer in LAYERS else "grashof"


def circle(arrows: dict[str, set[str]]) -> list[str]:
    """Some circle of arrows, empty where there is none."""
    left = dict(arrows)
    while True:
        reached = set().union(*left.values())
        free = [name for name, others in left.items() if name not in reached or not others & left.keys()]
        if not free:
            return sorted(left)
        for name in free:
            del left[name]


@pytest.mark.slow
def test_no_module_imports_itself_by_way_of_others() -> None:
    arrows = {name: imported(name) - {name} for name in SOURCES}
    # A package takes names from its modules to pass them on.
    passing_on = {name for name, path in SOURCES.items() if path.name == "__init__.py"}
    assert circle({name: others - passing_on for name, others in arrows.items()}) == []


def room(name: str) -> str:
    """Package that a module lies in."""
    return name if SOURCES[name].name == "__init__.py" else name.rpartition(".")[0]


def imports_of_rooms() -> dict[str, set[str]]:
    """Other rooms that the modules of each room import from."""
    arrows: dict[str, set[str]] = {}
    for name in SOURCES:
        if SOURCES[name].name != "__init__.py":
            others = {room(other) for other in imported(name) if other in SOURCES}
            arrows.setdefault(room(name), set()).update(others - {room(name)})
    return arrows


@pytest.mark.slow
def test_no_room_imports_from_one_that_imports_from_it() -> None:
    layers = set(LAYERS)
    assert circle({name: others - layers for name, others in imports_of_rooms().items()}) == []


@pytest.mark.slow
def test_the_table_of_rooms_states_what_they_import() -> None:
    page = (ROOT / "docs" / "architecture.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| `([\w/]+)` \|[^|]+\|([^|]*)\|([^|]*)\|$", page, re.MULTILINE)
    stated = {path: [set(re.findall(r"\w+", cell)) for cell in cells] for path, *cells in rows}
    found = {}
    for name, others in imports_of_rooms().items():
        mine = layer_of(name)
        beside = {other.rpartition(".")[2] for other in others if layer_of(other) == mine}
        below = {layer_of(other).rpartition(".")[2] for other in others if layer_of(other) != mine}
        path = next(path.parent for source, path in SOURCES.items() if room(source) == name)
        found[path.relative_to(ROOT).as_posix()] = [beside, below]
    assert stated == found


def modules_after(statement: str) -> set[str]:
    code = f"{statement}\nimport sys\nprint(*sys.modules)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    return set(done.stdout.split())


def test_importing_grashof_loads_no_solver_and_no_plots() -> None:
    loaded = modules_after("import grashof")
    assert not loaded & {"casadi", "jinja2", "matplotlib", "pandas", "pydantic", "rich", "shapely"}


@pytest.mark.slow
def test_a_worker_process_loads_only_what_it_solves_with() -> None:
    loaded = modules_after("import grashof.synth.search.attempt")
    assert "casadi" in loaded
    assert not loaded & {"scipy.optimize", "scipy.interpolate", "scipy.integrate", "scipy.spatial"}
    assert not loaded & {"matplotlib", "pandas", "pydantic", "rich", "shapely"}


@pytest.mark.slow
def test_a_run_loads_neither_pandas_nor_trees(tmp_path: Path) -> None:
    arguments = [
        "grashof",
        "solve",
        "luggage",
        "--starts",
        "4",
        "--drawings",
        "0",
        "--out",
        str(tmp_path / "run"),
    ]
    run = "import contextlib, grashof.cli\nwith contextlib.suppress(SystemExit):\n    grashof.cli.main()"
    loaded = modules_after(f"import sys\nsys.argv = {arguments}\n{run}")
    assert (tmp_path / "run" / "candidates.csv").stat().st_size > 1000
    assert not loaded & {"matplotlib", "pandas", "scipy.linalg", "scipy.optimize", "scipy.spatial"}


def test_the_public_verbs() -> None:
    import grashof

    plots = {"plot_linkage", "plot_coupler_curve", "plot_kinematics", "plot_dynamics", "plot_design_space"}
    assert set(grashof.__all__) == {"GrashofError", "load", "synthesize", "track", "animate"} | plots
    assert all(callable(getattr(grashof, name)) for name in grashof.__all__)
    with pytest.raises(AttributeError, match="no attribute 'solve'"):
        _ = grashof.solve
