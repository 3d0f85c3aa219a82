"""Relaxed requirements: the loosest reasonable ones, and those under which a design would be accepted."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, cast

import numpy as np

from grashof.analysis import Defect, verify
from grashof.analysis.judge.design import Constraint, Design, name_of
from grashof.problems import Box, FourBar, Problem, Region, Requirements, Rotatability
from grashof.problems.values.arrays import Limits, turned_beyond, turned_from
from grashof.problems.values.errors import shown_key
from grashof.problems.values.requirements.limit_kinds import Kind
from grashof.problems.values.requirements.requirements import LIMITS
from grashof.synth.designs.candidate import Candidate
from grashof.synth.programme.start import UNSMOOTH

LEAST_MARGIN = 1e-9  # of full rotation: below it lies a change point
COARSEST = 0.02  # share of a change that its value may be rounded by


@dataclass(frozen=True, slots=True)
class Relaxation:
    """A requirement that alone prevents a design, and one that the judge accepts once it is relaxed."""

    key: str  # the requirement
    words: str  # the change, such as "transmission_min_deg 31.4 instead of 35"
    requirements: Requirements  # those of the problem, this one relaxed
    constraints: tuple[Constraint, ...]  # the user's own, relaxed where the key is "constraints"
    candidate: Candidate  # judged by the requirements as stated
    miss: float  # of these requirements: sizes, rad or ratio
    figures: int = 1  # number of limits that change


@dataclass(frozen=True, slots=True)
class RelaxedConstraint:
    """A user's constraint that counts as met up to a value above zero."""

    constraint: Constraint
    by: float

    def __call__(self, design: Design) -> Any:
        """The value, less the allowance."""
        value = self.constraint(design)
        return [one - self.by for one in value] if isinstance(value, (list, tuple)) else value - self.by


def limiting(problem: Problem, constraints: Sequence[Constraint]) -> list[str]:
    """Keys of the requirements that differ from the defaults, exactness aside."""
    wanted, usual = problem.requirements, Requirements()
    keys = [key for key in (*LIMITS, "keep_out", "at") if getattr(wanted, key) != getattr(usual, key)]
    keys += ["constraints"] * bool(constraints)  # the user's own
    if wanted.rotatability is not Rotatability.ANY and not (
        problem.task.closed and problem.task.has_position.any()
    ):
        keys.append("rotatability")
    return keys + [key for key in UNSMOOTH if getattr(wanted, key)]


def fixes_angle(wanted: Requirements, key: str) -> bool:
    """Whether a requirement is a single angle to be kept."""
    return key in LIMITS and LIMITS[key].kind.is_angle and wanted.angle_of(key) is not None


def loosest(problem: Problem, key: str) -> Requirements:
    """The requirements of a problem without one of them, or with it as loose as is reasonable."""
    wanted = problem.requirements
    limit = LIMITS.get("link_length" if key in FourBar.mechanism.lengths else key)
    loose: dict[str, Any] = {
        "rotatability": Rotatability.ANY,
        "link_ratio_max": max(100.0, wanted.link_ratio_max),
        "transmission_min_deg": 0.0,
        **dict.fromkeys(("keep_out", "at"), ()),
        **dict.fromkeys(UNSMOOTH, False),
    }
    if key == "constraints":
        return wanted
    if key not in loose and limit is not None and limit.usual is not None:
        given, (low, high) = getattr(wanted, key), (problem.task.size * share for share in limit.usual)
        loose[key] = (min(low, given[0]), max(high, given[1]))
    elif limit is not None and limit.kind is Kind.WORD:
        loose[key] = limit.widest
    changed: dict[str, Any] = {key: loose.get(key)}
    return replace(wanted, **changed)


def relaxation(
    problem: Problem, constraints: Sequence[Constraint], key: str, candidate: Candidate
) -> Relaxation | None:
    """The relaxation that a judged design needs of a requirement; None where it misses another one, too."""
    return first_accepted(problem, proposals(problem, constraints, key, candidate))


def first_accepted(problem: Problem, proposed: Sequence[Relaxation]) -> Relaxation | None:
    """The first of some relaxations under which the judge accepts its design."""
    return next(
        (one for one in proposed if accepted(one.candidate, problem, one.requirements, one.constraints)), None
    )


def proposals(
    problem: Problem, constraints: Sequence[Constraint], key: str, candidate: Candidate
) -> list[Relaxation]:
    """Relaxations of a requirement under which a judged design may do, the least first; not yet accepted."""
    missed = [defect for defect in candidate.verdict.defects if defect.requirement == key]
    if key not in ("rotatability", *UNSMOOTH) and len(missed) < len(candidate.verdict.defects):
        return []
    miss, own = max((defect.miss for defect in missed), default=1.0), tuple(constraints)
    made = list[Relaxation]()
    for change, words in _changes(problem, own, key, missed):
        # rounded to the loose side; the judge has to accept the design with it
        relaxed = change.pop("constraints", own)
        wanted, figures = replace(problem.requirements, **change), words.count(" instead of ")
        made.append(Relaxation(key, words, wanted, relaxed, candidate, miss, figures))
    return made


def accepted(
    candidate: Candidate, problem: Problem, wanted: Requirements, constraints: Sequence[Constraint] = ()
) -> bool:
    """Whether the judge accepts a design, with its cylinder, under some requirements."""
    cylinder = candidate.verdict.cylinder
    return verify(candidate.linkage, problem.task, wanted, constraints, problem=problem, cylinder=cylinder).ok


def with_rounded_angle(problem: Problem, relaxation: Relaxation) -> Relaxation:
    """The relaxation with its angle rounded like other values, not yet confirmed by a design."""
    key = relaxation.key
    asked: float = getattr(problem.requirements, key)
    angle = _rounded(getattr(relaxation.requirements, key), asked)
    changed: dict[str, Any] = {key: angle}
    wanted = replace(problem.requirements, **changed)
    return replace(relaxation, requirements=wanted, words=f"{key} {angle:.10g} instead of {asked:g}")


def _changes(
    problem: Problem, own: tuple[Constraint, ...], key: str, missed: list[Defect]
) -> Iterator[tuple[dict[str, Any], str]]:
    """Changes to requirements, by key, with words, in the order to be tried, the least one first."""
    wanted = problem.requirements.resolved(problem.task.size, scale_free=problem.task.scale_free)
    found, asked = [defect.found for defect in missed], cast(Any, getattr(wanted, key, None))
    kind = LIMITS[key].kind if key in LIMITS else None
    if key == "rotatability":
        yield from _turning_less(wanted, missed)
    elif key in UNSMOOTH:
        yield {key: False}, f"{key} = false"
    elif not missed:
        return
    elif key == "constraints":
        allowed = {defect.what: _rounded(defect.found, 0.0) for defect in missed}
        eased = tuple(
            RelaxedConstraint(one, allowed[name_of(one)]) if name_of(one) in allowed else one for one in own
        )
        words = [f"constraint {name} up to {by:g} instead of 0" for name, by in allowed.items()]
        yield {"constraints": eased}, " with ".join(words)
    elif key == "at":
        yield {"at": ()}, "no limits at single targets"
    elif key == "keep_out":
        yield _areas_drawn_in(wanted, missed)
    elif isinstance(asked, Region):
        yield {key: None}, f"{key} anywhere instead of in its region, such as {max(found):.3g} outside"
    elif kind in (Kind.INSIDE, Kind.ON_BODY):
        yield _box_enlarged(key, asked or Box(), missed)
    elif kind is Kind.NAMED:
        yield _named_widened(key, asked, missed)
    elif kind is Kind.WORD:
        yield {key: LIMITS[key].widest}, f'{key} "{LIMITS[key].widest}" instead of "{asked}"'
    elif isinstance(asked, tuple):
        if kind is Kind.DIRECTION:  # the nearer end, deg
            low, high = map(np.radians, asked)
            period = problem.period(LIMITS[key].quantity.key)
            off = float(np.degrees(turned_beyond(np.radians(found[0]), (low, high), period)))
            found = [asked[off > 0] + off]
        reached = _reaching(asked, found)
        yield {key: reached}, _range_words(key, asked, reached)
    elif kind is not None and kind.is_angle:
        turn = turned_from(np.radians(found[0] - asked), 0.0, problem.period(LIMITS[key].quantity.key))
        angle = float(f"{asked + np.degrees(turn):.12g}")
        yield {key: angle}, f"{key} {angle:.12g} instead of {asked:g}"
    else:
        value = max(_rounded(found[0], asked), 0.0)
        yield {key: value}, f"{key} {value:.10g} instead of {asked:g}"


def _named_widened(key: str, asked: Mapping[str, Limits], missed: list[Defect]) -> tuple[dict[str, Any], str]:
    """Limits by name, widened so that a design keeps them."""
    reached = {
        name: _reaching(asked[name], [defect.found for defect in missed if defect.what == name])
        for name in dict.fromkeys(defect.what for defect in missed)
    }
    words = [
        _range_words(f"{key}.{shown_key(name)}", asked[name], limits) for name, limits in reached.items()
    ]
    return {key: {**asked, **reached}}, " with ".join(words)


def _turning_less(wanted: Requirements, missed: list[Defect]) -> Iterator[tuple[dict[str, Any], str]]:
    asked, margins = wanted.rotatability, [d.found for d in missed if "margin" in d.what]
    if margins and margins[0] > LEAST_MARGIN:
        margin = max(_rounded(margins[0], wanted.rotatability_margin), 0.0)
        words = f"rotatability_margin {margin:g} instead of {wanted.rotatability_margin:g}"
        yield {"rotatability_margin": margin}, words
    others = (Rotatability.FULL_CRANK, Rotatability.ANY)
    for kind in others[asked is Rotatability.FULL_CRANK :]:
        yield {"rotatability": kind}, f'rotatability "{kind}" instead of "{asked}"'


def _box_enlarged(key: str, box: Box, missed: list[Defect]) -> tuple[dict[str, Any], str]:
    sides, words = {}, []
    for axis in ("x", "y"):
        given: Limits = getattr(box, axis)
        found = [defect.found for defect in missed if defect.what == f"{key}.{axis}"]
        sides[axis] = _reaching(given, found)
        if found:
            words.append(_range_words(f"{key}.{axis}", given, sides[axis]))
    return {key: Box(**sides)}, " with ".join(words)


def _areas_drawn_in(wanted: Requirements, missed: list[Defect]) -> tuple[dict[str, Any], str]:
    # Here, not above: shapely takes a while to import, and few problems have areas.
    import shapely

    from grashof.problems.values.areas import solid

    by = _rounded(max(defect.found for defect in missed), 0.0)
    # Holes are closed: areas without them are stricter, on which the judge then decides.
    left = shapely.get_parts(shapely.buffer(solid(wanted.keep_out), -by, join_style="mitre"))
    areas = tuple(shapely.get_coordinates(part.exterior)[:-1] for part in left if not part.is_empty)
    depths = (defect.what.removesuffix(" inside").removeprefix("the depth of ") for defect in missed)
    return {"keep_out": areas}, f"keep_out drawn in by {by:g}, the depth of {' and '.join(depths)}"


def _reaching(given: Limits, found: list[float]) -> Limits:
    """Limits widened to contain values, rounded outwards."""
    low, high = given
    least, most = min([low, *found]), max([high, *found])
    return _rounded(least, low) if least < low else low, _rounded(most, high) if most > high else high


def _rounded(value: float, asked: float) -> float:
    """A value rounded away from the stated one, to a power of ten that is a small share of the change."""
    way = abs(value - asked)
    if not 0 < way < np.inf:
        return value
    step = 10.0 ** np.floor(np.log10(COARSEST * way))
    away = np.ceil(value / step) if value > asked else np.floor(value / step)
    return round(float(away * step), max(0, -int(np.floor(np.log10(step)))))


def _range_words(name: str, given: Limits, reached: Limits) -> str:
    ends = zip(("from", "up to"), reached, given, strict=True)
    words = [f"{way} {new:.10g} instead of {old:g}" for way, new, old in ends if new != old]
    return f"{name} {' and '.join(words)}"
