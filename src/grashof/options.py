"""The options of the commands: a field each, in the order of the help."""

from __future__ import annotations

from dataclasses import dataclass, fields
from functools import partial
from inspect import Parameter
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, get_type_hints

import typer

from grashof.problems.values.efforts import EFFORTS
from grashof.problems.values.errors import wrong_value
from grashof.study.on_request import FIT_POINTS, ON_REQUEST, STEP

if TYPE_CHECKING:
    from grashof.study.asked import Asked

TOP = 50  # families in a list by default
JSON = "--json"


def _option(text: str, *names: str, **details: Any) -> Any:
    return typer.Option(*names, help=text, **details)


_unset = partial(_option, show_default=False)

ProblemName = Annotated[str, typer.Argument(metavar="PROBLEM", help="Name in the catalogue, or a TOML file.")]
LinkageName = Annotated[
    str,
    typer.Argument(
        metavar="LINKAGE",
        help="Name in the catalogue of linkages, a linkage file, DIR/candidates.json#3 (rank or id), "
        "or a link from grashof live.",
    ),
]
_Workers = Annotated[int, _option("Processes; they change the time, not the result.", min=1)]
_Top = Annotated[
    int | None,
    _option(
        "Most families of like designs in the list.", min=1, show_default=f"{TOP}, or search.enough if more"
    ),
]
_Gap = Annotated[float, _option("Deg up to which proofs bring their bounds together.", min=1e-4, max=90)]
_Scheduler = Annotated[str | None, _unset("Dask scheduler to work on, such as tcp://host:8786.")]
_Drawings = Annotated[int, _option("Designs to draw.", min=0)]
_Json = Annotated[bool, _option("Print the outcome and the list as one JSON document.", JSON)]


@dataclass(frozen=True, slots=True, kw_only=True)
class SolveOptions:
    """How to search, and files to write; None where the problem, or its default, states it."""

    out: Annotated[Path | None, _unset("Folder for the results; NAME-designs by default.")] = None
    starts: Annotated[int | None, _unset("Most Ipopt solves.", min=1)] = None
    seed: Annotated[int | None, _unset("Random seed.", min=0)] = None
    workers: _Workers = 1
    time_limit: Annotated[float | None, _unset("Seconds after which no new solves begin.")] = None
    gap: _Gap = 0.01
    prove: Annotated[bool, _option("Give proofs minutes where they need them, not seconds.", "--prove")] = (
        False
    )
    top: _Top = None
    drawings: _Drawings = 3
    effort: Annotated[
        float | None,
        _unset("How long to look for better designs; 1 is usual.", min=EFFORTS[0], max=EFFORTS[1]),
    ] = None
    resume: Annotated[bool, _option("Continue the unfinished search in --out.", "--resume")] = False
    scheduler: _Scheduler = None
    shard: Annotated[
        str | None, _unset("Part I of N of the search; grashof merge follows.", metavar="I/N")
    ] = None
    log: Annotated[Path | None, _unset("File to append a log to: rounds, starts, lost processes.")] = None
    json: _Json = False


@dataclass(frozen=True, slots=True, kw_only=True)
class MergeOptions:
    """Shards of the list, and files to write."""

    partial: Annotated[bool, _option("Accept the shards that are done.", "--partial")] = False
    workers: _Workers = 1
    top: _Top = None
    drawings: _Drawings = 3
    json: _Json = False


@dataclass(frozen=True, slots=True, kw_only=True)
class SweepOptions:
    """Where a study is solved, and how many designs are listed."""

    out: Annotated[Path | None, _unset("Folder for the results; NAME-sweep by default.")] = None
    workers: _Workers = 1
    resume: Annotated[bool, _option("Continue the sweep that the folder holds.", "--resume")] = False
    top: Annotated[int | None, _unset("Best designs listed of each combination.", min=1)] = None
    scheduler: _Scheduler = None


@dataclass(frozen=True, slots=True, kw_only=True)
class ProveOptions:
    """The claim to prove, and the time for it."""

    at_least: Annotated[
        float | None, _unset("Only decide whether a design has this many deg.", min=0, max=90)
    ] = None
    gap: _Gap = 0.01
    time_limit: Annotated[float | None, _unset("Seconds after which the current bound counts.")] = None
    certificate: Annotated[
        Path | None,
        _unset("File for the proof of four poses, for scripts/check_certificate.py.", metavar="FILE"),
    ] = None


@dataclass(frozen=True, slots=True, kw_only=True)
class AnalyseOptions:
    """Contents of an analysis, and its files."""

    out: Annotated[Path | None, _unset("Folder for the results; NAME-analysis by default.")] = None
    speed_rpm: Annotated[float | None, _unset("Of the driver, clockwise below 0; the file's by default.")] = (
        None
    )
    pictures: Annotated[
        bool, _option("Plots of all sections as PNG and SVG, not in the page alone.", "--pictures")
    ] = False
    at: Annotated[str | None, _unset("Driver angles, deg, to look at closely: 0,90,180,270.")] = None
    seconds: Annotated[
        float | None,
        _option(
            "Length of a history over time, or of the free motion, s.",
            show_default="no history; 5 of the free motion",
        ),
    ] = None
    step: Annotated[float | None, _option("Of the history, s.", show_default=str(STEP))] = None
    start_deg: Annotated[
        float | None,
        _option("Driver angle at its beginning.", show_default="0, or the end of the driver's first range"),
    ] = None
    with_: Annotated[str | None, _unset(f"Longer sections, of {', '.join(ON_REQUEST)}.", "--with")] = None
    every: Annotated[bool, _option("All of these.", "--all")] = False
    fit_from_deg: Annotated[
        float | None,
        _option(
            "Driver angle from which paths are fitted.",
            show_default="the task motion of a design, or the full range of the driver",
        ),
    ] = None
    fit_to_deg: Annotated[float | None, _unset("Driver angle at which the fits of the paths end.")] = None
    fit_points: Annotated[int, _option("Number of points of each fit.")] = FIT_POINTS
    dwell_deg: Annotated[
        float | None, _unset("Report how long link 4 (link 6) dwells in a band of this width.")
    ] = None
    balance: Annotated[bool, _option("Report counterweights, before and after.", "--balance")] = False
    flywheel: Annotated[float | None, _unset("Report the flywheel for this fluctuation of speed: 0.05.")] = (
        None
    )
    tolerance: Annotated[
        float | None,
        _unset("Report how far P and link 4 (6) move for this deviation of dimensions (length unit)."),
    ] = None
    release: Annotated[
        float | None,
        _unset("Report the free motion from this driver angle, from rest by default.", metavar="DEG"),
    ] = None
    release_rpm: Annotated[float | None, _unset("Speed of the driver at the release.")] = None

    def asked(self) -> Asked:
        """The options as an analysis has them; ProblemError for angles that are not numbers."""
        from grashof.study.asked import Asked

        given = {each.name: getattr(self, each.name) for each in fields(Asked) if hasattr(self, each.name)}
        own: dict[str, Any] = {
            "at_deg": _numbers(self.at, "--at"),
            "sections": ON_REQUEST if self.every else _words(self.with_),
            "release_deg": self.release,
        }
        return Asked(**given, **own)


@dataclass(frozen=True, slots=True, kw_only=True)
class LiveOptions:
    """Where the live page is served."""

    port: Annotated[int, _option("Of the server; 0 takes a free one.", min=0, max=65535)] = 0
    browser: Annotated[bool, _option("Open the page in the browser.", "--browser/--no-browser")] = True


@dataclass(frozen=True, slots=True, kw_only=True)
class AnimateOptions:
    """Where an animation goes, and how long it is."""

    out: Annotated[Path | None, _unset("File, .gif or .mp4; NAME.gif by default.")] = None
    seconds: Annotated[float, _option("Length of the motion.", min=0.1, max=20)] = 4.0
    fps: Annotated[float, _option("Frames a second.", min=1, max=50)] = 25.0


@dataclass(frozen=True, slots=True, kw_only=True)
class ExportOptions:
    """The files to write, by the names of `workshop.export`, and how big the parts are."""

    dxf: Annotated[Path | None, _unset("Drawing of the parts to cut, and how they stack.")] = None
    svg: Annotated[Path | None, _unset("The same drawing.")] = None
    step: Annotated[Path | None, _unset("The parts as solids, assembled.")] = None
    stl: Annotated[Path | None, _unset("The same as flats.")] = None
    mujoco: Annotated[Path | None, _unset("Model for MuJoCo, an .xml file.")] = None
    geogebra: Annotated[Path | None, _unset("Worksheet for GeoGebra, a .ggb file.")] = None
    solidworks: Annotated[Path | None, _unset("Equations for SolidWorks, a .txt file.")] = None
    freecad: Annotated[Path | None, _unset("Table for FreeCAD, a .csv file.")] = None
    linkage2: Annotated[Path | None, _unset("Document of the program Linkage.")] = None
    xlsx: Annotated[Path | None, _unset("Excel workbook: the list, and a sheet for each design.")] = None
    width: Annotated[float, _option("Of the links, mm.")] = 20.0
    hole: Annotated[float, _option("Diameter of holes and pins, mm.")] = 6.0
    thickness: Annotated[float, _option("Of the material, mm.")] = 5.0
    clearance: Annotated[
        float | None,
        _option("Least gap between parts on one layer, mm.", show_default="a twentieth of the width"),
    ] = None
    scale: Annotated[str, _option("Of a model: 0.05 or 1:20.")] = "1"
    mm_per_unit: Annotated[float | None, _unset("Where the length unit is not mm, cm, m, in or ft.")] = None
    theta2_deg: Annotated[
        tuple[float, float] | None,
        _unset("Range of driver angles used; the full range by default.", metavar="LOW HIGH"),
    ] = None


def parameters(options: type[Any]) -> list[Parameter]:
    """The fields of a class of options as parameters of a command, from which Typer makes its options."""
    hints = get_type_hints(options, include_extras=True)
    return [
        Parameter(each.name, Parameter.KEYWORD_ONLY, default=each.default, annotation=hints[each.name])
        for each in fields(options)
    ]


def _words(given: str | None) -> tuple[str, ...]:
    return tuple(word.strip() for word in given.split(",")) if given is not None else ()


def _numbers(given: str | None, option: str) -> tuple[float, ...]:
    try:
        return tuple(map(float, _words(given)))
    except ValueError:
        raise wrong_value(option, given, "numbers with commas between them, such as 0,90,180") from None
