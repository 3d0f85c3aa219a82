"""The files of `grashof export`: the parts, models for other programs, and an Excel workbook."""

from __future__ import annotations

import math
import os
import tempfile
from collections.abc import Callable, Mapping, Sequence
from contextlib import ExitStack
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from grashof.models import Model, freecad, geogebra, linkage2, mjcf, solidworks
from grashof.problems import LinkageSpec, ProblemError, load_linkage_spec
from grashof.problems.files.linkage_file import load_design
from grashof.problems.values.checks import finite_number, positive_number
from grashof.problems.values.dynamics.dynamics_spec import METRES
from grashof.problems.values.errors import wrong_value
from grashof.problems.values.specs.linkage_spec import ListedDesign
from grashof.workshop.formats import dxf, svg
from grashof.workshop.plan import Plan, plan_parts
from grashof.workshop.plates import PlateSizes
from grashof.workshop.sheet import sheet
from grashof.workshop.solids import step, stl
from grashof.workshop.workbook import listed_candidates, workbook

if TYPE_CHECKING:
    import pandas as pd


@dataclass(frozen=True, slots=True)
class Format:
    """A kind of file, made from the parts and a heading, or from the model; `xlsx` is not among them."""

    ending: str
    parts: Callable[[Plan, str], str | bytes] | None = None
    model: Callable[[Model], str | bytes] | None = None


# By the options of the command.
FORMATS = {
    "dxf": Format(".dxf", parts=lambda plan, heading: dxf(sheet(plan, heading))),
    "svg": Format(".svg", parts=lambda plan, heading: svg(sheet(plan, heading))),
    "step": Format(".step", parts=lambda plan, _: step(plan)),
    "stl": Format(".stl", parts=lambda plan, _: stl(plan)),
    "mujoco": Format(".xml", model=mjcf),
    "geogebra": Format(".ggb", model=geogebra),
    "solidworks": Format(".txt", model=solidworks),
    "freecad": Format(".csv", model=freecad),
    "linkage2": Format(".linkage2", model=linkage2),
}
WORKBOOK = "xlsx"


@dataclass(frozen=True, slots=True)
class Making:
    """How big the parts are made, for which range of driver angles; the scale of a model is 0.05 or 1:20.

    `mm_per_unit` is for a length unit that is not mm, cm, m, in or ft.
    """

    sizes: PlateSizes
    scale: str = "1"
    mm_per_unit: float | None = None
    theta2_deg: tuple[float, float] | None = None


@dataclass(frozen=True, slots=True)
class Exported:
    """The result of an export: the plan, if one was made, the files, and a line for each refused format."""

    plan: Plan | None
    written: tuple[Path, ...]
    refused: tuple[str, ...]


def export_files(linkage: str, making: Making, files: dict[str, Path]) -> Exported:
    """Write files of `FORMATS` or xlsx; one that cannot represent the linkage does not affect the others.

    `linkage` is as for `load_linkage`; for a workbook alone also ``DIR/candidates.json#1,3,5``. ProblemError
    for bad input, or where no format can represent it; OSError for a full disk or a lost folder.
    """
    if not files:
        options = ", ".join(f"--{name}" for name in (*FORMATS, WORKBOOK))
        raise ProblemError(f"nothing to write; give a FILE for one or several of {options}")
    for kind, path in files.items():
        _refuse_path(kind, path)
    chosen, listed = _chosen(linkage)
    single = [kind for kind in files if kind != WORKBOOK]
    if single and len(chosen) > 1:
        raise ProblemError(f"--{single[0]} takes one design; {linkage} names {len(chosen)}")
    made, contents, refused = None, dict[str, str | bytes](), list[str]()
    for kind in files:
        try:
            if kind == WORKBOOK:
                designs = [one for one in chosen if isinstance(one, ListedDesign)]
                contents[kind] = workbook(chosen, listed_candidates(listed, designs) if listed else None)
            elif (of_parts := FORMATS[kind].parts) is not None:
                made = made or _plan(chosen[0], making)
                contents[kind] = of_parts(made, _heading(chosen[0], making))
            elif (of_model := FORMATS[kind].model) is not None:
                contents[kind] = of_model(Model.of(chosen[0]))
        except ProblemError as error:
            refused.append(str(error))
    refused = list(dict.fromkeys(refused))
    if not contents:
        raise ProblemError("\n".join(refused))
    _write_whole({files[kind]: content for kind, content in contents.items()})
    return Exported(made, tuple(files[kind] for kind in contents), tuple(refused))


def plan_lines(plan: Plan) -> list[str]:
    """The parts list and the notes, as lines for the terminal."""
    rows = plan.rows()
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    lines = ["  ".join(map(str.ljust, row, widths)).rstrip() for row in rows]
    return [*lines, *plan.notes]


def _refuse_path(kind: str, path: Path) -> None:
    ending = FORMATS[kind].ending if kind in FORMATS else f".{kind}"
    if path.suffix.lower() != ending:
        raise ProblemError(f"--{kind} {path}: the file name must end in {ending}")
    try:
        taken, there = path.is_dir(), path.parent.is_dir()
    except OSError as error:  # a name too long
        raise ProblemError(f"--{kind} {path}: {error.strerror}") from None
    if taken:
        raise ProblemError(f"--{kind} {path}: is a folder; it must be a file")
    if not there:
        raise ProblemError(f"--{kind} {path}: there is no folder {path.parent}")


def _chosen(linkage: str) -> tuple[list[LinkageSpec | ListedDesign], Path | None]:
    """The linkage or designs that LINKAGE names, and the list that contains them."""
    file, mark, names = linkage.rpartition("#")
    if not (mark and file.endswith(".json")):
        return [load_linkage_spec(linkage)], None
    path = Path(file)
    designs = {one.rank: one for one in (load_design(path, name.strip()) for name in names.split(","))}
    return list(designs.values()), path


def _plan(one: LinkageSpec | ListedDesign, making: Making) -> Plan:
    spec, theta2 = (one.spec, one.theta2[0]) if isinstance(one, ListedDesign) else (one, None)
    within = None
    if making.theta2_deg is not None:
        low, high = (math.radians(finite_number(angle, "theta2_deg")) for angle in making.theta2_deg)
        within = (low, high)
    made = plan_parts(spec.linkage, making.sizes, _millimetres(spec, making), within=within, theta2=theta2)
    notes = made.notes
    if spec.output_arm is not None:
        arm = f"the output arm, {spec.output_arm:g} {spec.length_unit} about O4"
        notes += (f"{arm}, is not among the parts",)
    if isinstance(one, ListedDesign) and len(set(one.assembly)) > 1:
        both = "the targets need both assemblies"
        notes += (f"{both}; only the motion on that of the first one is considered",)
    return replace(made, notes=notes)


def _millimetres(spec: LinkageSpec, making: Making) -> float:
    """Millimetres of the parts for one unit of the linkage."""
    given, unit = making.mm_per_unit, spec.length_unit
    if unit in METRES:
        if given is not None:
            raise ProblemError(
                f"mm_per_unit is given, but length_unit of {spec.name} is {unit}; give --scale instead"
            )
        given = METRES[unit] * 1000
    elif given is None:
        raise ProblemError(
            f"length_unit of {spec.name} is {unit!r}, not one of {', '.join(METRES)}; give "
            "--mm-per-unit NUMBER, the millimetres of one unit"
        )
    return _ratio(making.scale) * positive_number(given, "mm_per_unit")


def _ratio(scale: str) -> float:
    numerator, _, denominator = scale.partition(":")
    try:
        return positive_number(float(numerator), "scale") / positive_number(float(denominator or 1), "scale")
    except ValueError:
        raise wrong_value("scale", scale, "a number above 0 or a ratio such as 1:20") from None


def _heading(one: LinkageSpec | ListedDesign, making: Making) -> str:
    spec = one.spec if isinstance(one, ListedDesign) else one
    return f"{spec.title or spec.name}, scale {making.scale}"


def write_dxf(path: str | os.PathLike[str], plan: Plan, title: str = "") -> None:
    """Write the parts, the assembly and the parts list as DXF, in mm.

    Parameters
    ----------
    path : str or path-like
    plan : Plan
    title : str
        Above the parts list.

    Raises
    ------
    ProblemError
        ezdxf is not installed.
    OSError
        The file cannot be written; an older one stays.
    """
    _write_whole({Path(path): dxf(sheet(plan, title))})


def write_svg(path: str | os.PathLike[str], plan: Plan, title: str = "") -> None:
    """Write the same drawing as SVG, in mm; parameters as for `write_dxf`."""
    _write_whole({Path(path): svg(sheet(plan, title))})


def write_xlsx(
    path: str | os.PathLike[str],
    chosen: Sequence[LinkageSpec | ListedDesign],
    candidates: pd.DataFrame | None = None,
) -> None:
    """Write an Excel workbook; parameters as for `workbook`.

    Raises
    ------
    ProblemError
        openpyxl is not installed.
    OSError
        The file cannot be written; an older one stays.
    """
    _write_whole({Path(path): workbook(chosen, candidates)})


def _write_whole(contents: Mapping[Path, str | bytes]) -> None:
    """Write files beside their places, and move them there when all are complete.

    OSError names the file whose disk is full or folder is lost; every file is then as it was before.
    """
    with ExitStack() as folders:
        fresh = {}
        for path, content in contents.items():
            try:
                beside = tempfile.TemporaryDirectory(dir=path.parent, prefix=".writing-")
                fresh[path] = Path(folders.enter_context(beside)) / path.name
                fresh[path].write_bytes(content.encode("utf-8") if isinstance(content, str) else content)
            except OSError as error:
                raise OSError(error.errno, error.strerror, str(path)) from None
        for path, file in fresh.items():
            file.replace(path)
