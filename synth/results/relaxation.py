"""Requirements asked less strictly: how loose each may get, and what a design would have to be allowed."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from grashof.analysis import Defect, verify
from grashof.analysis.judge.design import Constraint, Design, name_of
from grashof.problems import Box, Problem, Requirements, Rotatability
from grashof.problems.values.arrays import Limits
from grashof.synth.results.candidate import Candidate

LENGTHS = ("r1", "r2", "r3", "r4")
BOXES = ("o2", "o4", "a", "b")
ANGLES = ("ground_angle_deg", "theta2_start_deg")
LEAST_MARGIN = 1e-9  # of full rotation: below it lies a change point
COARSEST = 0.02  # share of a change that its figure may be rounded by


@dataclass(frozen=True, slots=True)
class Relaxation:
    """A requirement that alone stands in the way, and a design that the judge accepts once it is relaxed.

    Parameters
    ----------
    key : str
        The requirement.
    words : str
        What would do, such as "transmission_min_deg 31.4 instead of 35".
    requirements : Requirements
        Those of the problem, this one relaxed.
    constraints : tuple of callable
        The user's own, relaxed where the key is "constraints".
    candidate : Candidate
        Judged against the requirements as they were asked.
    miss : float
        By how much it misses them: sizes, rad or ratio.
    figures : int
        How many limits change.
    """

    key: str
    words: str
    requirements: Requirements
    constraints: tuple[Constraint, ...]
    candidate: Candidate
    miss: float
    figures: int = 1


@dataclass(frozen=True, slots=True)
class Eased:
    """A user's constraint that counts as met up to a value above zero."""

    constraint: Constraint
    by: float

    def __call__(self, design: Design) -> Any:
        """The value, less what is allowed."""
        value = self.constraint(design)
        return [one - self.by for one in value] if isinstance(value, (list, tuple)) else value - self.by


def limiting(problem: Problem, constraints: Sequence[Constraint]) -> list[str]:
    """Keys of the requirements that ask for more than to exclude the absurd, exactness aside.

    Parameters
    ----------
    problem : Problem
    constraints : sequence of callable
        The user's own.
    """
    wanted, usual = problem.requirements, Requirements()
    keys = ["transmission_min_deg", "link_length", *LENGTHS, "link_ratio_max", "coupler_arms", *BOXES]
    keys += [*ANGLES, "keep_out"]
    changed = [key for key in keys if getattr(wanted, key) != getattr(usual, key)]
    changed += ["constraints"] * bool(constraints)
    if wanted.rotatability is not Rotatability.ANY and not problem.task.closed:
        changed.append("rotatability")
    return changed + [key for key in ("order", "same_branch") if getattr(wanted, key)]


def loosest(problem: Problem, key: str) -> Requirements:
    """The requirements of a problem with one of them taken out, or as loose as is not absurd."""
    wanted, size = problem.requirements, problem.task.size
    if key == "constraints":
        return wanted
    usual = Requirements().resolved(size)
    if key in (*LENGTHS, "link_length", "coupler_arms"):
        low, high = usual.link_length if key != "coupler_arms" else usual.coupler_arms  # type: ignore[misc]
        given = getattr(wanted, key)
        return _with(wanted, {key: (min(low, given[0]), max(high, given[1]))})
    loose: dict[str, Any] = {
        "rotatability": Rotatability.ANY,
        "order": False,
        "same_branch": False,
        "link_ratio_max": max(100.0, wanted.link_ratio_max),
        "transmission_min_deg": 0.0,
        "keep_out": (),
    }
    return _with(wanted, {key: loose.get(key)})


def relaxation(
    problem: Problem, constraints: Sequence[Constraint], key: str, candidate: Candidate
) -> Relaxation | None:
    """What a requirement would have to be for a design; None where another one stands in its way, too.

    Parameters
    ----------
    problem : Problem
    constraints : sequence of callable
        The user's own.
    key : str
        Of the requirement.
    candidate : Candidate
        Judged against all of them.

    Notes
    -----
    The figure is rounded to the loose side, and the judge has to accept the design with it.
    """
    own = tuple(constraints)
    smooth = key not in ("rotatability", "order", "same_branch")
    if smooth and any(defect.requirement != key for defect in candidate.verdict.defects):
        return None
    missed = [defect for defect in candidate.verdict.defects if defect.requirement == key]
    miss = max((defect.miss for defect in missed), default=1.0)
    for wanted, eased, words in _eased(problem, own, key, missed):
        if verify(candidate.linkage, problem.task, wanted, eased, problem=problem).ok:
            return Relaxation(key, words, wanted, eased, candidate, miss, words.count(" instead of "))
    return None


def with_rounded_angle(problem: Problem, relaxation: Relaxation) -> Relaxation:
    """The same with its angle rounded like other figures; whether a design does it has to be seen."""
    key = relaxation.key
    asked, needed = (
        float(getattr(wanted, key)) for wanted in (problem.requirements, relaxation.requirements)
    )
    angle = _rounded(needed, asked)
    wanted = _with(problem.requirements, {key: angle})
    return replace(relaxation, requirements=wanted, words=f"{key} {angle:.10g} instead of {asked:g}")


def _eased(
    problem: Problem, own: tuple[Constraint, ...], key: str, missed: list[Defect]
) -> list[tuple[Requirements, tuple[Constraint, ...], str]]:
    """Requirements that ask for less, the least change first, in the order to be tried, with words."""
    wanted = problem.requirements
    if key == "rotatability":
        return [(less, own, words) for less, words in _turning_less(wanted, missed)]
    if key in ("order", "same_branch"):
        return [(_with(wanted, {key: False}), own, f"{key} = false")]
    if not missed:
        return []
    if key == "constraints":
        return [_own_eased(wanted, own, missed)]
    change = _CHANGES.get(key, _limits_changed)
    found = change(problem, key, missed)
    return [] if found is None else [(found[0], own, found[1])]


def _turning_less(wanted: Requirements, missed: list[Defect]) -> list[tuple[Requirements, str]]:
    tried = list[tuple[Requirements, str]]()
    asked, margins = wanted.rotatability, [d.found for d in missed if "margin" in d.what]
    if margins and margins[0] > LEAST_MARGIN:
        margin = max(_rounded(margins[0], wanted.rotatability_margin), 0.0)
        words = f"rotatability_margin {margin:g} instead of {wanted.rotatability_margin:g}"
        tried.append((replace(wanted, rotatability_margin=margin), words))
    others = (Rotatability.FULL_CRANK, Rotatability.ANY)
    for kind in others[asked is Rotatability.FULL_CRANK :]:
        words = f'rotatability "{kind}" instead of "{asked}"'
        tried.append((replace(wanted, rotatability=kind), words))
    return tried


def _own_eased(
    wanted: Requirements, own: tuple[Constraint, ...], missed: list[Defect]
) -> tuple[Requirements, tuple[Constraint, ...], str]:
    allowed = {defect.what: _rounded(defect.found, 0.0) for defect in missed}
    eased = tuple(Eased(one, allowed[name_of(one)]) if name_of(one) in allowed else one for one in own)
    return (
        wanted,
        eased,
        " with ".join(f"constraint {name} up to {by:g} instead of 0" for name, by in allowed.items()),
    )


def _limits_changed(problem: Problem, key: str, missed: list[Defect]) -> tuple[Requirements, str] | None:
    given: Limits = getattr(problem.requirements.resolved(problem.task.size), key)
    reached = _reaching(given, [defect.found for defect in missed])
    return _with(problem.requirements, {key: reached}), _range_words(key, given, reached)


def _box_changed(problem: Problem, key: str, missed: list[Defect]) -> tuple[Requirements, str] | None:
    box: Box = getattr(problem.requirements, key) or Box()
    sides, words = {}, []
    for axis in ("x", "y"):
        given: Limits = getattr(box, axis)
        found = [defect.found for defect in missed if defect.what == f"{key}.{axis}"]
        sides[axis] = _reaching(given, found)
        if found:
            words.append(_range_words(f"{key}.{axis}", given, sides[axis]))
    return _with(problem.requirements, {key: Box(**sides)}), " with ".join(words)


def _number_changed(problem: Problem, key: str, missed: list[Defect]) -> tuple[Requirements, str] | None:
    asked = float(getattr(problem.requirements, key))
    value = _rounded(missed[0].found, asked)
    changed = _with(problem.requirements, {key: max(value, 0.0)})
    return changed, f"{key} {max(value, 0.0):.10g} instead of {asked:g}"


def _angle_changed(problem: Problem, key: str, missed: list[Defect]) -> tuple[Requirements, str] | None:
    asked, found = float(getattr(problem.requirements, key)), missed[0].found
    found = float(f"{found + 360 * round((asked - found) / 360):.12g}")
    return _with(problem.requirements, {key: found}), f"{key} {found:.12g} instead of {asked:g}"


def _areas_drawn_in(problem: Problem, _: str, missed: list[Defect]) -> tuple[Requirements, str] | None:
    # Here, not above: shapely takes a while to import, and few problems have areas.
    import shapely

    from grashof.problems.values.areas import solid

    by = _rounded(max(defect.found for defect in missed), 0.0)
    # Holes are closed: areas without them ask for more, which the judge then decides.
    left = shapely.get_parts(shapely.buffer(solid(problem.requirements.keep_out), -by, join_style="mitre"))
    areas = tuple(shapely.get_coordinates(part.exterior)[:-1] for part in left if not part.is_empty)
    parts = " and ".join(
        defect.what.removesuffix(" inside").removeprefix("the depth of ") for defect in missed
    )
    return replace(problem.requirements, keep_out=areas), f"keep_out drawn in by {by:g}, the depth of {parts}"


_Change = Callable[[Problem, str, list[Defect]], tuple[Requirements, str] | None]
_CHANGES: dict[str, _Change] = {
    **dict.fromkeys(BOXES, _box_changed),
    **dict.fromkeys(ANGLES, _angle_changed),
    **dict.fromkeys(("transmission_min_deg", "link_ratio_max"), _number_changed),
    "keep_out": _areas_drawn_in,
}


def _with(wanted: Requirements, changed: dict[str, Any]) -> Requirements:
    return replace(wanted, **changed)


def _reaching(given: Limits, found: list[float]) -> Limits:
    """Limits widened to hold values, rounded outwards."""
    low, high = given
    below, above = [value for value in found if value < low], [value for value in found if value > high]
    return (
        _rounded(min(below), low) if below else low,
        _rounded(max(above), high) if above else high,
    )


def _rounded(value: float, asked: float) -> float:
    """A value rounded away from what is asked, to a power of ten that is a small share of the way."""
    way = abs(value - asked)
    if not 0 < way < np.inf:
        return value
    step = 10.0 ** np.floor(np.log10(COARSEST * way))
    away = np.ceil(value / step) if value > asked else np.floor(value / step)
    return round(float(away * step), max(0, -int(np.floor(np.log10(step)))))


def _range_words(name: str, given: Limits, reached: Limits) -> str:
    words = []
    if reached[0] < given[0]:
        words.append(f"from {reached[0]:.10g} instead of {given[0]:g}")
    if reached[1] > given[1]:
        words.append(f"up to {reached[1]:.10g} instead of {given[1]:g}")
    return f"{name} {' and '.join(words)}"
