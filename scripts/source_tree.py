"""The source of the package as a tree: modules, layers, rooms, and their imports."""

import re
from collections.abc import Mapping, Set
from functools import cache
from pathlib import Path

ROOT = Path(__file__).parents[1]
FOLDERS = {"problems": "grashof.problems", "analysis": "grashof.analysis", "synth": "grashof.synth"}
IMPORT = re.compile(r"^[ \t]*(?:from ([\w.]+) import (?:\(([^)]*)\)|(.+))|import (.+))$", re.MULTILINE)
# Every layer may import from those before it.
LAYERS = ("grashof.problems", "grashof.analysis", "grashof.synth", "grashof")


def name_of(path: Path) -> str:
    """Import name of a file, or of the folder of an `__init__.py`."""
    parts = path.relative_to(ROOT).with_suffix("").parts
    parts = parts[1:] if parts[0] == "src" else ("grashof", *parts)
    return ".".join(part for part in parts if part != "__init__")


SOURCES = {name_of(path): path for folder in (*FOLDERS, "src") for path in (ROOT / folder).rglob("*.py")}


@cache
def imported(name: str) -> frozenset[str]:
    """Modules that a module imports, lazily or not; a package where it takes a name from it."""
    found = set[str]()
    for module, listed, named, plain in IMPORT.findall(SOURCES[name].read_text(encoding="utf-8")):
        names = [
            each.split()[0] for each in re.sub("#.*", "", listed or named or plain).split(",") if each.strip()
        ]
        full = [f"{module}.{each}" for each in names] if module else names
        found |= {each if each in SOURCES or not module else module for each in full}
    return frozenset(found)


def layer_of(name: str) -> str:
    """Layer that a module lies in."""
    layer = ".".join(name.split(".")[:2])
    return layer if layer in LAYERS else "grashof"


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


def circle(arrows: Mapping[str, Set[str]]) -> list[str]:
    """A circle of arrows, empty where there is none."""
    left = dict(arrows)
    while True:
        reached = set().union(*left.values())
        free = [name for name, others in left.items() if name not in reached or not others & left.keys()]
        if not free:
            return sorted(left)
        for name in free:
            del left[name]


def circle_of_modules() -> list[str]:
    """Modules that import themselves by way of others."""
    arrows = {name: imported(name) - {name} for name in SOURCES}
    # A package takes names from its modules to pass them on.
    passing_on = {name for name, path in SOURCES.items() if path.name == "__init__.py"}
    return circle({name: others - passing_on for name, others in arrows.items()})


def circle_of_rooms() -> list[str]:
    """Rooms that import from one that imports from them; the `__init__` of a layer is not a room."""
    layers = set(LAYERS)
    return circle({name: others - layers for name, others in imports_of_rooms().items()})
