"""The terminal: progress of a search, and the table of the best designs."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from io import StringIO
from itertools import chain
from textwrap import TextWrapper

import numpy as np
from rich import box
from rich.console import Console, JustifyMethod
from rich.table import Table

from grashof.output.process import say
from grashof.problems import Problem
from grashof.problems.values.arrays import FloatArray
from grashof.problems.values.linkages.mechanisms import LENGTHS, having, without_noise
from grashof.problems.values.requirements.all_quantities import QUANTITIES
from grashof.problems.values.requirements.quantities import Quantity, Scope
from grashof.problems.values.text import counted
from grashof.problems.values.units import Unit
from grashof.synth import Candidate, Progress, Result
from grashof.synth.designs.ranking import pareto_optimal
from grashof.wording.numbers import class_text
from grashof.wording.problem import error_meaning, goals
from grashof.wording.proof import enclosure_line, enclosures, proof_line

_ROWS = 12
_ROUNDING = 1e-6  # sizes: solvers keep limits no closer
CAUTION = "caution"
_PIPED_WIDTH = 140
_WIDE = 100  # columns; narrower terminals get fewer digits
_UNBOUNDED = 1000
# Columns that a narrow terminal does without, first to last.
_DROPPED = (("class",), ("O2", "O4"), ("family size",), ("best at",), ("size",), ("mu turn",))
_JUSTIFY: dict[str, JustifyMethod] = {
    **dict.fromkeys(("O2", "O4"), "center"),
    **dict.fromkeys(("mechanism", "class", "best at"), "left"),
}
_TWO_LINES = ("error rms", "family size")


def console(*, stderr: bool = False) -> Console:
    """A console that does not fold its lines when it is piped, and marks nothing up by itself."""
    made = Console(stderr=stderr, highlight=False, markup=False, emoji=False)
    if not made.is_terminal:
        made.width = _PIPED_WIDTH
    return made


@contextmanager
def search_progress(
    name: str, begin: str = "searching", *, wanted: bool = True
) -> Iterator[Callable[[Progress], None]]:
    """An argument for `progress=`: a bar on a terminal, plain lines elsewhere; on stderr.

    The bar shows `begin` until the first step is done; `wanted` where enough designs end the search.
    """
    out = console(stderr=True)
    if not (out.is_terminal and sys.stderr.isatty()):  # the first alone can be forced by FORCE_COLOR
        yield lambda step: say(f"{name}: {_step(step, wanted)}", err=True)
        return
    from rich.progress import BarColumn, TextColumn, TimeElapsedColumn
    from rich.progress import Progress as Bar

    name_column = TextColumn("{task.description}", markup=False)  # a name such as [x] is not markup
    columns = (name_column, BarColumn(), TextColumn("{task.fields[step]}"))
    with Bar(*columns, TimeElapsedColumn(), console=out, transient=True) as bar:
        task = bar.add_task(name, total=None, step=begin)

        def show(step: Progress) -> None:
            total = step.enough if wanted else step.starts
            done = min(step.verified, step.enough) if wanted else step.solved
            bar.update(task, completed=done, total=total, step=_step(step, wanted))

        yield show


def _step(step: Progress, wanted: bool) -> str:
    verified = f"{counted(step.verified, 'design')} verified{f' ({step.enough} wanted)' if wanted else ''}"
    if step.starts is None:
        return verified
    return f"{verified}, {min(step.solved, step.starts)} of {step.starts} starts solved"


def print_table(result: Result, verified: int | None = None) -> None:
    """Print the best designs with their main quantities; `verified` is the number found in all."""
    for line in folded(heading(result, verified or len(result)).splitlines()):
        say(line)
    digits = 4 if console().width >= _WIDE else 3
    left_out = [list(chain(*_DROPPED[:count])) for count in range(len(_DROPPED) + 1)]
    for line in fitting(_table(result, digits, names) for names in left_out):
        say(line)
    doubted = [f"{row['#'].rstrip(' *')}: {row[CAUTION]}" for row in best_rows(result) if row.get(CAUTION)]
    undecided = not all(each.holds for each in enclosures(result))
    lines = [f"caution: {'; '.join(doubted)}" if doubted else "", enclosure_line(result) if undecided else ""]
    for line in folded([line for line in (*lines, proof_line(result)) if line]):
        say(line)


def folded(lines: Sequence[str]) -> list[str]:
    """Lines folded between words to the width of the terminal; unchanged where they are piped."""
    out = console()
    if not (out.is_terminal and sys.stdout.isatty()):
        return list(lines)
    folding = TextWrapper(out.width, subsequent_indent="    ", break_on_hyphens=False)
    return [part for line in lines for part in folding.wrap(line)]


def fitting(tables: Iterable[Table]) -> list[str]:
    """Lines of the first table that fits the terminal, or else of the last; no number is ever cut."""
    width, lines = console().width, list[str]()
    for table in tables:
        page = Console(
            file=StringIO(), width=_UNBOUNDED, highlight=False, markup=False, emoji=False, color_system=None
        )
        with page.capture() as captured:
            page.print(table)
        lines = [line.rstrip() for line in captured.get().splitlines()]
        if max(map(len, lines)) <= width:
            break
    return lines


def plain_table() -> Table:
    """A table without columns, ruled below its heading alone."""
    return Table(box=box.SIMPLE_HEAD, pad_edge=False, padding=(0, 1, 0, 0))


def best_rows(result: Result, digits: int = 4) -> list[dict[str, str]]:
    """The best design of each family in cells, the best of each region first; angles in deg.

    Columns equal in all rows are left out.
    """
    front, families = pareto_optimal(result.problem, result.candidates), result.families
    place = {id(each): number for number, each in enumerate(result.candidates)}
    at = [place[id(family[0])] for family in families]
    firsts = first_of_regions([family[0].region for family in families])
    shown = [*firsts, *(k for k in result.first_of_each(_ROWS) if k not in firsts)][:_ROWS]
    left_out = [
        *(["class"] if len(_classes(result)) == 1 else []),
        *([] if len(result.problem.mechanism) > 1 else ["mechanism"]),
        *([] if set(having("o4")) & set(result.problem.mechanism) else ["O4"]),
        *([] if any(len(families[k]) > 1 for k in shown) else ["family size"]),
        *([] if len(firsts) > 1 else ["region"]),
        *([] if any(families[k][0].best_at for k in shown) else ["best at"]),
        *([] if any(families[k][0].caution for k in shown) else [CAUTION]),
    ]
    rows = [
        {
            "#": f"{at[k] + 1}{'*' if front[at[k]] else ' '}",
            **_cells(result.problem, families[k][0], digits),
            "family size": str(len(families[k])),
            "region": str(families[k][0].region or ""),
            "best at": families[k][0].best_at,
            CAUTION: families[k][0].caution,
        }
        for k in shown
    ]
    left_out += [name for name in rows[0] if all(row[name] in ("nan", "-") for row in rows)]
    return [{name: cell for name, cell in row.items() if name not in left_out} for row in rows]


def first_of_regions(regions: Sequence[int]) -> list[int]:
    """Places of the first of each region, in a list of regions, 0 for none; empty for a single region.

    >>> first_of_regions([1, 1, 0, 3, 2, 3]), first_of_regions([1, 1, 0])
    ([0, 3, 4], [])
    """
    firsts = {region: k for k, region in reversed(list(enumerate(regions))) if region}
    return sorted(firsts.values()) if len(firsts) > 1 else []


def units(problem: Problem) -> dict[str, str]:
    """Units of the columns of `best_rows`; lengths are in the problem's."""
    counted_in = {each.short: each.unit for each in _decided_by(problem)}
    bare = Unit.LENGTH, Unit.RATIO
    return {name: unit.of(problem.length_unit) for name, unit in counted_in.items() if unit not in bare}


def _decided_by(problem: Problem) -> list[Quantity]:
    """Main quantities: the error if any, the transmission angle, other goals, size and lengths."""
    error = [] if problem.requirements.is_exact(problem.task) else ["error"]
    if problem.task.has_output.any():
        names = ("structural_error_max", "structural_error_rms")
        error = [problem.as_required(QUANTITIES[name]).key for name in names]
    goals = [goal.key for goal, _ in problem.goals if goal.key != "size"]
    made = [name for name in (*LENGTHS, "offset", "offset_2") if set(having(name)) & set(problem.mechanism)]
    keys = *error, "transmission_min_task", "transmission_min_cycle", *goals, "size", *made
    return [QUANTITIES[key] for key in dict.fromkeys(keys)]


def _table(result: Result, digits: int, left_out: Sequence[str]) -> Table:
    rows, counted_in = best_rows(result, digits), units(result.problem)
    table = plain_table()
    names = [name for name in rows[0] if name not in (*left_out, CAUTION)]  # which follows the table
    for name in names:
        title = name.replace(" ", "\n") if name in _TWO_LINES or digits < 4 or "size" in left_out else name
        unit = f"\n{counted_in[name]}" if name in counted_in else ""
        table.add_column(f"{title}{unit}", justify=_JUSTIFY.get(name, "right"), no_wrap=True)
    for row, after in zip(rows, [*rows[1:], {}], strict=True):
        last = not row.get(CAUTION) and bool(after.get(CAUTION))
        table.add_row(*(row[name] for name in names), end_section=last)
    return table


def heading(result: Result, verified: int) -> str:
    """The number of designs, their exactness, and the meaning of the columns of `best_rows`."""
    exact = result.problem.requirements.is_exact(result.problem.task)
    verdicts = [candidate.verdict for candidate in result.candidates]
    worst = max(each.error_max for each in verdicts)
    error = "" if np.isnan(worst) else f", largest position error {worst:.1e}"
    if not exact:  # as the column shows it
        least = min(each.error(result.problem) for each in result.candidates)
        error = f", smallest error rms {least * result.problem.task.size:.2g}"
    task = result.problem.task
    if task.has_output.any():
        least = min(each.structural_error_max for each in verdicts)
        error = f", structural error from {task.shown(least, result.problem.length_unit)}"
    classes = {class_text(candidate) for candidate in result.candidates}
    kind = classes.pop() if len(classes) == 1 else ""
    families = len(result.families)
    grouped = f" in {counted(families, 'family')}" if families < len(result) else ""
    found = counted(verified, f"distinct verified {f'{kind} ' if kind else ''}design") + grouped
    if verified > len(result):  # the class of the others is unknown
        found = f"{verified} distinct designs verified, listed are the best {len(result)}{grouped}"
        found += f" ({kind})" if kind else ""
    unit = result.problem.length_unit
    lengths = f" Lengths in {unit}." if unit else ""
    mixed = ", some of each kind" if len(result.problem.mechanism) > 1 else ""
    shown = f" The best {_ROWS}{mixed}:" if families > _ROWS else ""
    if families < len(result):
        many = f"{'' if mixed else 'the first '}{_ROWS} families{mixed}"
        shown = f" The best of {many if families > _ROWS else 'each family'}:"
    counted_so = error_meaning(result.problem)
    return (
        f"{found}{error}.{lengths}\n"
        f"{f'error rms: {counted_so}.' + chr(10) if counted_so else ''}"
        f"mu: worst transmission angle; *: Pareto-optimal in {goals(result.problem)}.{shown}"
    )


def _classes(result: Result) -> set[str]:
    return {str(candidate.verdict.grashof_class) for candidate in result.candidates}


def _cells(problem: Problem, candidate: Candidate, digits: int) -> dict[str, str]:
    linkage = candidate.linkage
    return {
        **{each.short: _cell(each, candidate, digits) for each in _decided_by(problem)},
        **{name: _place(getattr(linkage, name.lower(), None), problem.task.size) for name in ("O2", "O4")},
        "mechanism": linkage.mechanism.word,
        "class": str(candidate.verdict.grashof_class),
    }


def _place(place: FloatArray | None, size: float) -> str:
    """A place to three digits; a coordinate that is negligible beside the size of the task is zero."""
    return "-" if place is None else ", ".join(f"{x if abs(x) > _ROUNDING * size else 0:.3g}" for x in place)


def _cell(quantity: Quantity, candidate: Candidate, digits: int) -> str:
    if quantity.over is Scope.CYCLE and not candidate.verdict.full_rotation:
        return "-"
    if candidate.linkage.mechanism.word not in quantity.kinds:
        return "-"
    value = candidate.values[quantity.key] * quantity.unit.shown
    if quantity.unit is Unit.ANGLE and not quantity.deviates:
        return f"{value:.1f}"
    if quantity.unit is Unit.LENGTH and quantity.key != "error":
        value = without_noise(value, candidate.linkage)
    return f"{value:.{2 if quantity.key == 'error' else digits}g}"
