"""The files that a live page saves, and the texts that it copies."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

from grashof.live.requests import TOP, Job
from grashof.output.run_files import list_content, write_json, write_run
from grashof.problems import Problem, ProblemError, load_linkage_spec
from grashof.problems.files.design_link import SharedDesign, design_link
from grashof.problems.files.linkage_writing import mail_toml
from grashof.problems.files.problem_writing import problem_toml
from grashof.synth import Candidate, Result
from grashof.synth.designs.table import rows_of

TOML = "application/toml"
# Names and types of the files of a run, by the "file" of a job.
_LISTS = {
    "list": ("candidates.csv", "text/csv"),
    "designs": ("candidates.json", "application/json"),
    "report": ("report.html", "text/html"),
}


@dataclass(frozen=True, slots=True)
class Saved:
    """A file: its name, type and text."""

    name: str
    type: str
    text: str


def saved(job: Job, problem: Problem, there: Mapping[int, Candidate], found: Result | None) -> Saved:
    """The file of a job, of the problem and the verified designs on its page by their keys.

    `found` is their search, if it has ended. ProblemError where the file needs a design and none is chosen.
    """
    wanted, key = job.options["file"], job.options["key"]
    design = there.get(key)
    rank = 1 + list(there).index(key) if key in there else 0
    if wanted == "problem":
        return Saved(f"{job.name}.toml", TOML, problem_toml(problem))
    if wanted == "problem-link":
        return _link(job)
    if not there:
        raise ProblemError("there is no design to save")
    if wanted in _LISTS:
        return _of_list(job.name, *_LISTS[wanted], found or Result(problem, tuple(there.values())))
    if design is None:
        raise ProblemError("choose a verified design first")
    if wanted == "dxf":
        return _plates(job.name, problem, design)
    linkage = _linkage_file(problem, design, rank)
    return _link(job, linkage) if wanted == "link" else Saved(f"{job.name}-{design.id}.toml", TOML, linkage)


def _link(job: Job, linkage: str = "") -> Saved:
    """A link to the problem, with a linkage file for it."""
    link = design_link(SharedDesign(job.name, job.document, linkage), job.options["address"])
    return Saved(f"{job.name}.txt", "text/plain", link)


def _of_list(problem_name: str, name: str, kind: str, result: Result) -> Saved:
    """A file that `grashof solve` writes of the list."""
    settings = {"top": TOP, "made by": "grashof live"}
    with TemporaryDirectory() as folder:
        write_run(Path(folder), result, settings, 0, problem_text=problem_toml(result.problem))
        text = (Path(folder) / name).read_text(encoding="utf-8")
    return Saved(f"{problem_name}-{name}", kind, text)


def _plates(problem_name: str, problem: Problem, design: Candidate) -> Saved:
    """The plates of a design, as `grashof export` draws them."""
    from grashof.workshop.export import Making, export_files
    from grashof.workshop.plates import PlateSizes

    with TemporaryDirectory() as folder:
        path = Path(folder) / "plates.dxf"
        export_files(_listed(Path(folder), problem, design, 1), Making(PlateSizes()), {"dxf": path})
        text = path.read_text(encoding="utf-8")
    return Saved(f"{problem_name}-{design.id}.dxf", "image/vnd.dxf", text)


def _linkage_file(problem: Problem, design: Candidate, rank: int) -> str:
    """A design as `grashof show` prints it."""
    with TemporaryDirectory() as folder:
        return mail_toml(load_linkage_spec(_listed(Path(folder), problem, design, rank)))


def _listed(folder: Path, problem: Problem, design: Candidate, rank: int) -> str:
    """The name of a design in a list of its own, where it has a rank."""
    result = Result(problem, (design,))
    rows = [{**row, "rank": rank} for row in rows_of(problem, result.candidates)]
    write_json(folder / "candidates.json", list_content(result, rows))
    return f"{folder / 'candidates.json'}#{rank}"
