"""The package as a whole: its map of folders, its layers, the cost of importing it."""

import re
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

sys.path.append(str(Path(__file__).parents[1] / "scripts"))  # where its map is drawn

from source_tree import (
    FOLDERS,
    LAYERS,
    ROOT,
    SOURCES,
    circle_of_modules,
    circle_of_rooms,
    imported,
    imports_of_rooms,
    layer_of,
    room,
)


def test_package_map_names_every_folder() -> None:
    settings = tomllib.loads((ROOT / "pyproject.toml").read_text())["tool"]["setuptools"]
    homes = {name: folder for folder, name in FOLDERS.items()}
    assert settings["package-dir"] == {**homes, "grashof": "src/grashof"}
    # Packages inside need no place of their own in the map: they lie where their names say.
    with_code = {path.parent for path in SOURCES.values()}
    assert with_code == {SOURCES[name].parent for name in settings["packages"]}
    assert all((folder / "__init__.py").exists() for folder in with_code)


def test_layers_import_only_from_below() -> None:
    ranks = {name: LAYERS.index(layer_of(name)) for name in SOURCES}
    imports = [(name, other) for name in SOURCES for other in imported(name)]
    ours = [(name, other) for name, other in imports if other.split(".")[0] == "grashof"]
    assert [pair for pair in ours if LAYERS.index(layer_of(pair[1])) > ranks[pair[0]]] == []
    assert [name for name, other in imports if other.startswith("casadi") and ranks[name] < 2] == []


def test_below_problems_nobody_asks_which_kind_a_task_is() -> None:
    kinds = r"(Function|Motion|Path|Stroke)Task"
    asking = re.compile(
        rf"isinstance\([^()]*,[^()]*\b{kinds}|\btask\)? (is|==) {kinds}|\btask\.kind (==|!=|in)\b"
    )
    for name, path in SOURCES.items():
        if layer_of(name) != LAYERS[0]:
            assert not asking.search(path.read_text(encoding="utf-8")), name


@pytest.mark.slow
def test_there_are_no_circles_of_modules_or_rooms() -> None:
    assert circle_of_modules() == []
    assert circle_of_rooms() == []


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


HEAVY = {"casadi", "jinja2", "matplotlib", "numpy", "pandas", "pydantic", "rich", "scipy", "shapely"}


def command_of(*arguments: str) -> str:
    """A statement that runs the command to its end, without what it prints."""
    quiet = "contextlib.redirect_stdout(io.StringIO()), contextlib.suppress(SystemExit)"
    main = f"sys.argv = {['grashof', *arguments]}\nwith {quiet}:\n    grashof.__main__.main()"
    return f"import contextlib, io, sys, grashof.__main__\n{main}"


def test_importing_grashof_loads_nothing_heavy() -> None:
    loaded = modules_after("import grashof")
    assert not loaded & {*HEAVY, "importlib.metadata", "logging", "re", "typer", "typing"}


def test_help_loads_nothing_heavy() -> None:
    assert not modules_after(command_of("--help")) & {*HEAVY, "re", "typer", "typing"}
    for arguments in ("solve", "--help"), ("analyse", "--help"), ("--version",):
        loaded = modules_after(command_of(*arguments))
        assert "typer" in loaded
        assert not loaded & HEAVY, arguments
    # With Typer itself, which checks values by pydantic.
    assert not modules_after(command_of("problems")) & (HEAVY - {"pydantic"})


@pytest.mark.slow
def test_a_worker_process_loads_only_what_it_solves_with() -> None:
    loaded = modules_after("import grashof.synth.search.attempt")
    assert "casadi" in loaded
    assert not loaded & {"scipy.optimize", "scipy.interpolate", "scipy.integrate", "scipy.spatial"}
    assert not loaded & {"matplotlib", "pandas", "pydantic", "rich", "shapely"}


@pytest.mark.slow
def test_a_run_loads_neither_pandas_nor_trees(tmp_path: Path) -> None:
    options = ["--starts", "4", "--drawings", "0", "--out", str(tmp_path / "run")]
    loaded = modules_after(command_of("solve", "luggage", *options))
    assert (tmp_path / "run" / "candidates.csv").stat().st_size > 1000
    assert not loaded & {"matplotlib", "pandas", "scipy.linalg", "scipy.optimize", "scipy.spatial"}


@pytest.mark.slow
def test_a_drawing_loads_no_tables_and_no_solver() -> None:
    loaded = modules_after("import grashof.figures.files")
    assert "matplotlib" in loaded
    assert not loaded & {"casadi", "pandas", "pydantic", "pyarrow", "rich"}


def test_the_public_verbs() -> None:
    import grashof

    plots = {"plot_linkage", "plot_coupler_curve", "plot_kinematics", "plot_dynamics", "plot_design_space"}
    assert set(grashof.__all__) == {"GrashofError", "load", "synthesize", "track", "animate"} | plots
    assert all(callable(getattr(grashof, name)) for name in grashof.__all__)
    with pytest.raises(AttributeError, match="no attribute 'solve'"):
        _ = grashof.solve
