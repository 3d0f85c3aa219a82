"""The public names of the package, as pages for autosummary."""

from __future__ import annotations

from dataclasses import dataclass
from importlib import import_module
from itertools import groupby

from grashof.problems.values.text import counted


@dataclass(frozen=True, slots=True)
class Package:
    """A package whose names are public."""

    name: str
    title: str

    @property
    def page(self) -> str:
        """Name of its page."""
        return self.name.replace(".", "-")


PACKAGES = (
    Package("grashof", "What most programs need"),
    Package("grashof.problems", "Tasks, requirements, linkages, files"),
    Package("grashof.synth", "Searches and their results"),
    Package("grashof.synth.theory", "Dyads and cognates by theory"),
    Package("grashof.synth.shards", "Searches in parts"),
    Package("grashof.synth.merging", "Parts of a search made one list"),
    Package("grashof.analysis", "Motion, forces, the judge"),
    Package("grashof.figures", "Figures and animations"),
    Package("grashof.page", "Pages to decide by"),
    Package("grashof.survey", "Reports of a linkage"),
    Package("grashof.sweep", "Sweeps"),
    Package("grashof.workshop", "Plates, drawings, workbooks"),
    Package("grashof.models", "Models for other programs"),
    Package("grashof.live", "The live page"),
)


def public_names(package: str) -> list[str]:
    """The names that a package offers: those of ``__all__``, or what a module defines itself."""
    module = import_module(package)
    if (listed := getattr(module, "__all__", None)) is not None:
        return list(listed)
    return [
        name
        for name, value in vars(module).items()
        if not name.startswith("_") and getattr(value, "__module__", "") == module.__name__
    ]


def homes() -> dict[str, str]:
    """Full names of the public names, by the short ones; of a name in two packages that of the later one."""
    return {name: f"{each.name}.{name}" for each in PACKAGES for name in public_names(each.name)}


def _subject(package: str, name: str) -> str:
    """The folder inside the package in which a name is defined."""
    home = str(getattr(getattr(import_module(package), name), "__module__", ""))
    parts = home.removeprefix(f"{package}.").split(".")
    return parts[0].replace("_", " ") if home.startswith(f"{package}.") and len(parts) > 1 else ""


def package_page(package: Package) -> str:
    """The page of a package, in reStructuredText."""
    lines = [
        package.name,
        "=" * len(package.name),
        "",
        f"{package.title}.",
        "",
        f".. currentmodule:: {package.name}",
    ]
    names = sorted(public_names(package.name), key=lambda name: (_subject(package.name, name), name.lower()))
    for subject, group in groupby(names, key=lambda name: _subject(package.name, name)):
        if package.name == "grashof.analysis":  # the only long one
            title = subject or "constants and types"
            lines += ["", title, "-" * len(title)]
        lines += ["", ".. autosummary::", "   :toctree: names", "", *(f"   {name}" for name in group)]
    return "\n".join([*lines, ""])


def index_page() -> str:
    """The page that lists the packages, in reStructuredText."""
    lines = [
        "Python",
        "======",
        "",
        "Every public name, with shapes, units and examples; angles in radians.",
    ]
    lines += ["", ".. list-table::", ""]
    for each in PACKAGES:
        names = counted(len(public_names(each.name)), "name")
        lines += [f"   * - :doc:`{each.name} <{each.page}>`", f"     - {each.title}; {names}"]
    lines += ["", ".. toctree::", "   :hidden:", "", *(f"   {each.page}" for each in PACKAGES)]
    return "\n".join([*lines, ""])
