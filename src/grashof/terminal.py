"""What the terminal shows: progress while a search works, and the list to decide by."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import asdict
from io import StringIO
from textwrap import TextWrapper

import numpy as np
from rich import box
from rich.console import Console, JustifyMethod
from rich.progress import BarColumn, TextColumn, TimeElapsedColumn
from rich.progress import Progress as Bar
from rich.table import Table

from grashof.problems import DynamicsSpec, MotionTask, PathTask, Problem, Task, TransmissionOver
from grashof.problems.checks import FloatArray, counted
from grashof.streams import say
from grashof.synth import Candidate, Progress, Result
from grashof.synth.choice import FACTORS
from grashof.synth.result import pareto_optimal, same_error

_ROWS = 12
_PIPED_WIDTH = 140
_WIDE = 100  # columns; narrower terminals get fewer digits
_UNBOUNDED = 1000
# Columns that a narrow terminal does without, first to last.
UNITS = {"mu task": "deg", "mu turn": "deg", "torque": "N m"}  # of columns; lengths are in the problem's
_DROPPED = (("class",), ("O2", "O4"), ("like this",), ("best at",), ("size",), ("mu turn",))
_JUSTIFY: dict[str, JustifyMethod] = {"O2": "center", "O4": "center", "class": "left", "best at": "left"}
_TWO_LINES = ("error rms", "like this")


def console(*, stderr: bool = False) -> Console:
    """A console that does not fold its lines when it is piped, and marks nothing up by itself."""
    made = Console(stderr=stderr, highlight=False, markup=False)
    if not made.is_terminal:
        made.width = _PIPED_WIDTH
    return made


@contextmanager
def search_progress(
    name: str, begin: str = "searching", *, wanted: bool = True
) -> Iterator[Callable[[Progress], None]]:
    """Something to give as `progress=`: a bar on a terminal, plain lines elsewhere; on stderr.

    Parameters
    ----------
    name : str
        Of the problem.
    begin : str
        What the bar says until the first step is done.
    wanted : bool
        Whether the search ends once it has enough designs.
    """
    out = console(stderr=True)
    if not (out.is_terminal and sys.stderr.isatty()):  # the first alone can be forced by FORCE_COLOR
        yield lambda step: say(f"{name}: {_step(step, wanted)}", err=True)
        return
    columns = (TextColumn("{task.description}"), BarColumn(), TextColumn("{task.fields[step]}"))
    with Bar(*columns, TimeElapsedColumn(), console=out, transient=True) as bar:
        task = bar.add_task(name, total=None, step=begin)

        def show(step: Progress) -> None:
            total = step.enough if wanted else step.starts
            done = min(step.verified, total) if wanted else step.solved
            bar.update(task, completed=done, total=total, step=_step(step, wanted))

        yield show


def beginning(problem: Problem) -> str:
    """What a search begins with, in words."""
    task = problem.task
    met = isinstance(task, MotionTask) and task.is_whole and ends_with_enough(problem)
    return "tracing dyads and judging pairs" if met else "searching"


def ends_with_enough(problem: Problem) -> bool:
    """Whether the search ends once it has enough designs: where it begins with exact ones."""
    if problem.task.zones is not None:
        return problem.task.exact_by_default
    return problem.requirements.is_exact(problem.task) and problem.zones is None


def _step(step: Progress, wanted: bool) -> str:
    verified = f"{counted(step.verified, 'design')} verified{f' ({step.enough} wanted)' if wanted else ''}"
    return f"{verified}, {step.solved} of {step.starts} starts solved"


def print_table(result: Result, verified: int | None = None) -> None:
    """Print the best designs, with what an engineer decides by.

    Parameters
    ----------
    result : Result
    verified : int, optional
        How many designs were found, where `result` lists only the best of them.
    """
    for line in folded(heading(result, verified or len(result)).splitlines()):
        say(line)
    for line in _fitting(result, console().width):
        say(line)


def folded(lines: Sequence[str]) -> list[str]:
    """Lines of words that no terminal breaks within a word; as they are where they are piped."""
    out = console()
    if not (out.is_terminal and sys.stdout.isatty()):
        return list(lines)
    folding = TextWrapper(out.width, subsequent_indent="    ", break_on_hyphens=False)
    return [part for line in lines for part in folding.wrap(line)]


def _fitting(result: Result, width: int) -> list[str]:
    """Lines of the table with as many columns as fit; no number is ever cut."""
    digits = 4 if width >= _WIDE else 3
    for dropped in range(len(_DROPPED) + 1):
        page = Console(file=StringIO(), width=_UNBOUNDED, highlight=False, markup=False, color_system=None)
        left_out = [name for names in _DROPPED[:dropped] for name in names]
        with page.capture() as captured:
            page.print(_table(result, digits, left_out))
        lines = [line.rstrip() for line in captured.get().splitlines()]
        if max(map(len, lines)) <= width:
            break
    return lines


def best_rows(result: Result, digits: int = 4) -> list[dict[str, str]]:
    """The best design of each family in cells, with what an engineer decides by; angles in deg.

    "like this" is how many others the family has. Columns that are alike for all of them are left out.
    """
    front, families = pareto_optimal(result.problem, result.candidates), result.families[:_ROWS]
    left_out = [
        *(["error rms"] if result.problem.requirements.is_exact(result.problem.task) else []),
        *(["class"] if len(_classes(result)) == 1 else []),
        *([] if result.problem.objective.torque else ["torque"]),
        *([] if any(len(family) > 1 for family in families) else ["like this"]),
        *([] if any(family[0].best_at for family in families) else ["best at"]),
    ]
    rows = [
        {
            "#": f"{rank}{'*' if front[rank - 1] else ' '}",
            **_cells(result.problem, family[0], digits),
            "like this": str(len(family) - 1 or ""),
            "best at": family[0].best_at,
        }
        for rank, family in enumerate(families, start=1)
    ]
    return [{name: cell for name, cell in row.items() if name not in left_out} for row in rows]


def _table(result: Result, digits: int, left_out: Sequence[str]) -> Table:
    rows = best_rows(result, digits)
    table = Table(box=box.SIMPLE_HEAD, pad_edge=False, padding=(0, 1, 0, 0))
    names = [name for name in rows[0] if name not in left_out]
    for name in names:
        title = name.replace(" ", "\n") if name in _TWO_LINES or digits < 4 or "size" in left_out else name
        unit = f"\n{UNITS[name]}" if name in UNITS else ""
        table.add_column(f"{title}{unit}", justify=_JUSTIFY.get(name, "right"), no_wrap=True)
    for row in rows:
        table.add_row(*(row[name] for name in names))
    return table


def heading(result: Result, verified: int) -> str:
    """How many designs there are, how exact, and what the columns of `best_rows` mean."""
    exact = result.problem.requirements.is_exact(result.problem.task)
    verdicts = [candidate.verdict for candidate in result.candidates]
    error = f"largest position error {max(each.error_max for each in verdicts):.1e}"
    if not exact:  # as the column says it
        least = min(each.error(result.problem) for each in result.candidates)
        error = f"smallest error rms {least * result.problem.task.size:.2g}"
    classes = _classes(result)
    kind = f"{classes.pop()} " if len(classes) == 1 else ""
    families = len(result.families)
    found = counted(verified, f"distinct verified {kind}design")
    found += f" in {counted(families, 'family')}" if families < len(result) else ""
    if verified > len(result):  # nothing is known here of the class of the others
        listed = str(len(result))
        listed += f" in {counted(families, 'family')}" if families < len(result) else ""
        found = f"{verified} distinct designs verified, listed are the best {listed}"
        found += f" ({kind.strip()})" if kind else ""
    unit = result.problem.length_unit
    lengths = f" Lengths in {unit}." if unit else ""
    shown = f" The best {_ROWS}:" if families > _ROWS else ""
    if families < len(result):
        shown = f" The best of {f'the first {_ROWS} families' if families > _ROWS else 'each family'}:"
    counted_so = error_meaning(result.problem)
    return (
        f"{found}, {error}.{lengths}\n"
        f"{f'error rms: {counted_so}.' + chr(10) if counted_so else ''}"
        f"mu: worst transmission angle; *: Pareto-optimal in {goals(result.problem)}.{shown}"
    )


def error_meaning(problem: Problem) -> str:
    """What the error of least squares counts besides distances; empty where there is nothing else."""
    task = problem.task
    if not isinstance(task, MotionTask) or problem.requirements.is_exact(task) or not task.has_angle.any():
        return ""
    unit = f" {problem.length_unit}" if problem.length_unit else ""
    return f"of positions and angles together, 1 rad counted as {task.angle_length:.6g}{unit}"


def goals(problem: Problem) -> str:
    """What the Pareto mark is about, in words."""
    names = [] if problem.requirements.is_exact(problem.task) else ["error"]
    names += ["mu", "size"] if problem.dynamics is None else ["mu", "size", "torque"]
    return f"{', '.join(names[:-1])} and {names[-1]}"


def _classes(result: Result) -> set[str]:
    return {str(candidate.verdict.grashof_class) for candidate in result.candidates}


def _cells(problem: Problem, candidate: Candidate, digits: int) -> dict[str, str]:
    linkage, verdict = candidate.linkage, candidate.verdict
    task, turn = np.degrees([verdict.transmission_min_task, verdict.transmission_min_cycle])
    return {
        "error rms": f"{candidate.error(problem) * problem.task.size:.2g}",
        "mu task": f"{task:.1f}",
        "mu turn": f"{turn:.1f}" if verdict.full_rotation else "-",
        "torque": f"{candidate.torque_peak:.{digits}g}",
        "size": f"{verdict.size:.{digits}g}",
        **{f"r{i}": f"{length:.{digits}g}" for i, length in enumerate(linkage.lengths, start=1)},
        **{name: f"{x:.3g}, {y:.3g}" for name, (x, y) in (("O2", linkage.o2), ("O4", linkage.o4))},
        "class": str(verdict.grashof_class),
    }


def summary(problem: Problem) -> list[str]:
    """A problem in a few lines, with the requirements as they will be applied."""
    task, wanted = problem.task, problem.requirements.resolved(problem.task.size)
    unit = f" {problem.length_unit}" if problem.length_unit else ""
    lengths = ", ".join(
        f"r{i} {low:g} to {high:g}" for i, (low, high) in enumerate(wanted.link_lengths, start=1)
    )
    arms = wanted.coupler_arms or (0.0, np.inf)
    lines = [
        f"{problem.name}: {problem.title}" if problem.title else problem.name,
        f"  {_task(task, unit)}; {_exactness(problem)}",
        f"  rotatability {wanted.rotatability}, margin {wanted.rotatability_margin:g}; "
        f"order {_yes(wanted.order)}, same branch {_yes(wanted.same_branch)}",
        f"  transmission at least {wanted.transmission_min_deg:g} deg over the {wanted.transmission_over}",
        f"  links{unit and f' in{unit}'}: {lengths}; ratio up to {wanted.link_ratio_max:g}; "
        f"coupler arms {arms[0]:g} to {arms[1]:g}",
    ]
    for name in ("o2", "o4", "a", "b"):
        place = getattr(problem.requirements, name)
        if place is not None:
            lines.append(f"  {name}: x {place.x[0]:g} to {place.x[1]:g}, y {place.y[0]:g} to {place.y[1]:g}")
    if wanted.keep_out:
        names = ", ".join(wanted.keep_out_for)
        lines.append(f"  kept out of {counted(len(wanted.keep_out), 'area')}: {names}")
    angles = {key: getattr(wanted, key) for key in ("ground_angle_deg", "theta2_start_deg")}
    lines += [f"  {key} {value:g}" for key, value in angles.items() if value is not None]
    if problem.manufacturing is not None:
        made = problem.manufacturing
        lines.append(f"  made to within {made.length_tolerance:g}{unit}, band {made.band:g}{unit}")
    if problem.dynamics is not None:
        lines.append(f"  {_driven(problem.dynamics)}")
    return [
        *lines,
        f"  best: {_best(problem)}",
        f"  search: {_search(problem)}",
    ]


def _best(problem: Problem) -> str:
    """What designs are ranked by, as `ranking_key` does it."""
    over = "turn" if problem.requirements.transmission_over is TransmissionOver.CYCLE else "task"
    words = {
        "transmission": f"greatest worst transmission angle over the {over}",
        "compactness": "smallest size",
        "torque": "smallest peak torque",
    }
    weights = {words[name]: weight for name, weight in asdict(problem.objective).items() if weight}
    best = next(iter(weights))
    if len(weights) > 1:
        best = f"a weighted sum: {', '.join(f'{word} {weight:g}' for word, weight in weights.items())}"
    missed = _missed(problem)
    if problem.by_objective:
        return f"{best}{missed and f', {missed}'}"
    return (
        f"least error (rms; errors up to {same_error(problem):g} sizes are equal, then {best}); "
        f"the list offers more transmission or less size within {FACTORS[-1]:g} times that error"
    )


def _missed(problem: Problem) -> str:
    """By how much targets may be missed while the objective decides; empty where they are met."""
    factor, zones = problem.requirements.error_factor, problem.zones
    if factor is not None:
        return f"as long as the error (rms) is at most {factor:g} times the least"
    if zones is None:
        return ""
    unit = f" {problem.length_unit}" if problem.length_unit else ""
    said = [_span(zones[0], unit), _span(np.degrees(zones[1]), " deg")]
    return f"as long as each target is missed by at most {' and '.join(filter(None, said))}"


def _span(sizes: FloatArray, unit: str) -> str:
    """A number, or the range of some, with its unit; empty where all are infinite."""
    known = sizes[np.isfinite(sizes)]
    if not len(known):
        return ""
    low, high = f"{known.min():.6g}", f"{known.max():.6g}"
    return f"{low}{unit}" if low == high else f"{low} to {high}{unit}"


def _search(problem: Problem) -> str:
    """How long is searched."""
    search = problem.search
    enough = f", {search.enough} designs" if ends_with_enough(problem) else ""
    effort = f", effort {search.effort:g}" if search.effort != 1 else ""
    return f"up to {search.starts} starts{enough}, seed {search.seed}{effort}"


def _driven(spec: DynamicsSpec) -> str:
    links = (
        "uniform links" if spec.masses is None else f"links of {', '.join(f'{m:g}' for m in spec.masses)} kg"
    )
    each = "" if spec.mass_per_length is None else f" of {spec.mass_per_length:g} kg a length unit"
    x, y = spec.gravity
    payload = f", payload {spec.payload:g} kg" if spec.payload else ""
    return f"dynamics: {links}{each}{payload}; driver at {spec.speed_rpm:g} rpm; gravity {x:g}, {y:g} m/s2"


def _task(task: Task, unit: str) -> str:
    if isinstance(task, PathTask):
        kind = "closed path" if task.closed else "path"
        timing = "" if task.timing is None else f" timed over {abs(np.degrees(task.timing[-1])):g} deg"
        return f"{kind} through {len(task)} points{timing}, size {task.size:g}{unit}"
    size = f"size {task.size:g}{unit}, angle_length {task.angle_length:g}{unit}"
    return f"motion through {len(task)} poses, {size}"


def _exactness(problem: Problem) -> str:
    if problem.task.zones is not None:
        return "zones about the targets"
    if not problem.requirements.is_exact(problem.task):
        return "least squares"
    return f"every target met within {problem.requirements.tolerance:g} sizes"


def _yes(value: bool) -> str:
    return "yes" if value else "no"
