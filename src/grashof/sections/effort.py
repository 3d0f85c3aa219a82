"""The effort that moves a linkage by hand over its travel, with and without its struts and springs."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from grashof.analysis.effort.case import EffortCase, EffortState
from grashof.analysis.effort.deviation import Deviation, EffortFigures, effort_curves, effort_figures
from grashof.analysis.effort.parts import place_on
from grashof.analysis.judge.effort_of_file import effort_of_file
from grashof.problems.values.arrays import FloatArray
from grashof.problems.values.dynamics.effort import SQUARE
from grashof.study.samples import Columns, table
from grashof.study.section import Fact, Plot, Section
from grashof.study.study import LinkageStudy
from grashof.wording.loads import OVER_TRAVEL, WITHOUT_PARTS, demand_texts, temperature_text

KEY, _TITLE = "effort", "Effort"
_OF = {"link": "the link of the effort", "driver": "the driver"}


def effort(study: LinkageStudy) -> Section | None:
    """The effort at each temperature, its deviation, and each part; None where the file states none."""
    case = effort_of_file(study.spec)
    if case is None:
        return None
    notes = []
    if not case.spec.is_placed:
        bare = replace(case.spec, parts=())
        case = replace(case, dynamics=replace(case.dynamics, effort=bare))
        notes.append("the struts and springs are not placed yet; they are left out")
    places, state = effort_curves(case)
    figures, columns = effort_figures(case), _columns(case, places, state)
    facts = [*_facts(case, figures)]
    for index in range(len(case.spec.parts)):
        facts += _part_facts(study, case, index, figures)
    notes.append(_meaning(case))
    notes += [
        f"{key}: {what} is {found:.6g}, allowed: {allowed}" for key, what, found, allowed, _ in figures.misses
    ]
    plots = _plots(study, case, state, columns)
    return Section(KEY, _TITLE, tuple(facts), {KEY: table(columns)}, plots, tuple(notes))


def _meaning(case: EffortCase) -> str:
    link, (u, v) = place_on(case.linkage, case.spec.on)
    square = case.spec.direction == SQUARE
    along = "along its path in the sense of the travel" if square else "in the stated direction"
    return (
        f"the effort acts on link {link} at ({u:.6g}, {v:.6g}), {along}; to move on, add the friction, "
        f"to move back, subtract it; angles are those of {_OF[case.spec.over]} from the start"
    )


def _columns(case: EffortCase, places: FloatArray, state: EffortState) -> dict[str, FloatArray]:
    columns = {
        "theta2_deg": np.degrees(case.travel.at(places).theta2),
        "angle_deg": state.angle_deg + 0.0,  # without -0
        "without_n": state.without,
    }
    for name, row in zip(_at(case), state.effort, strict=True):
        columns[f"effort_{name}_n"] = row
    columns["friction_n"] = state.friction
    for number, (part, known) in enumerate(zip(case.spec.parts, state.parts, strict=True), start=1):
        columns[f"part_{number}_{'turn_deg' if part.turns else 'length'}"] = known.length
        unit = case.metre if part.turns else 1.0
        columns[f"part_{number}_{'moment_nm' if part.turns else 'force_n'}"] = known.force * unit
    return columns


def _at(case: EffortCase) -> list[str]:
    """Temperatures as parts of column names."""
    return [f"{each:g}c".replace("-", "minus_") for each in case.spec.temperatures_c]


def _plots(study: LinkageStudy, case: EffortCase, state: EffortState, columns: Columns) -> tuple[Plot, ...]:
    over, angles = OVER_TRAVEL, columns["theta2_deg"]
    series = {
        temperature_text(each): row for each, row in zip(case.spec.temperatures_c, state.effort, strict=True)
    }
    if not case.spec.parts:
        series = {}
    lines = {
        **series,
        WITHOUT_PARTS if series else "effort": state.without,
        **_wanted(case, state),
    }
    plots = [Plot(KEY, "effort", "N", lines, state.angle_deg, over, angles=angles)]
    straight = {
        f"part {number}": known.length
        for number, (part, known) in enumerate(zip(case.spec.parts, state.parts, strict=True), start=1)
        if not part.turns
    }
    if straight:
        unit = study.spec.unit
        plots.append(
            Plot(
                f"{KEY}-lengths",
                "lengths of struts and springs",
                unit,
                straight,
                state.angle_deg,
                over,
                angles=angles,
            )
        )
    return tuple(plots)


def _wanted(case: EffortCase, state: EffortState) -> dict[str, FloatArray]:
    """Curves of the wanted effort, NaN elsewhere."""
    found: dict[str, FloatArray] = {}
    for demand in case.spec.demands:
        inside = (state.angle_deg >= demand.start) & (state.angle_deg <= demand.end)
        end = demand.end if np.isfinite(demand.end) else demand.start + 1
        sense = state.sense if demand.opening else 1.0
        sides = zip(demand_texts(demand), (demand.least, demand.most), (1, -1), strict=True)
        for name, values, sign in sides:
            shift = sign * demand.friction * state.friction
            line = sense * (np.interp(state.angle_deg, (demand.start, end), values) + shift)
            if np.isfinite(values).all():
                before = found.get(name, np.full(len(inside), np.nan))
                found[name] = np.where(inside, line, before)
    return found


def _facts(case: EffortCase, figures: EffortFigures) -> Iterator[Fact]:
    yield Fact("effort_travel_deg", "effort: rotation over the travel", case.total_deg, "deg")
    yield from _deviation(figures.deviation)
    if case.spec.parts:
        yield Fact(
            "effort_without_deviation",
            "effort: greatest deviation without struts and springs",
            figures.without.greatest,
            "N",
        )


def _deviation(found: Deviation) -> Iterator[Fact]:
    greatest = "effort: greatest deviation"
    yield Fact("effort_deviation", f"{greatest} from the wanted one", found.greatest, "N")
    if found.excess > 0:
        yield Fact("effort_deviation_of", f"{greatest}: key of the demand", found.words)
        yield Fact("effort_deviation_angle_deg", f"{greatest}: angle", found.angle_deg, "deg")
        yield Fact("effort_deviation_temperature_c", f"{greatest}: temperature", found.temperature_c, "°C")
    else:
        yield Fact("effort_margin", "effort: least margin to the limits", -found.excess, "N")


def _part_facts(study: LinkageStudy, case: EffortCase, index: int, figures: EffortFigures) -> Iterator[Fact]:
    number, part, unit = index + 1, case.spec.parts[index], study.spec.unit
    size = part.sizes[0]
    key, label = f"part_{number}", f"part {number}"
    yield Fact(f"{key}_size", f"{label}: size", part.chosen)
    for end, place in enumerate(part.places, start=1):
        link, (u, v) = place_on(case.linkage, place)
        axes = ("x", "y") if link == 1 else ("u", "v")
        for axis, value in zip(axes, (u, v), strict=True):
            yield Fact(f"{key}_end_{end}_{axis}", f"{label}: end {end} on link {link}, {axis}", value, unit)
    least, most = figures.lengths[index]
    if part.turns:
        free = 0.0 if part.free_angle_deg is None else part.free_angle_deg[0]
        yield Fact(f"{key}_free_angle_deg", f"{label}: free angle", free, "deg")
        yield Fact(f"{key}_turn_min_deg", f"{label}: least turn from it", least, "deg")
        yield Fact(f"{key}_turn_max_deg", f"{label}: greatest turn from it", most, "deg")
        return
    for word, length, bound, limit in (
        ("least", least, "compressed", size.compressed),
        ("greatest", most, "extended", size.extended),
    ):
        yield Fact(f"{key}_length_{word}", f"{label}: {word} length", length, unit)
        yield Fact(f"{key}_{bound}", f"{label}: {bound} length of the size", limit, unit)
