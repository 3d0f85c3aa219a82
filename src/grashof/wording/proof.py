"""Statements on a list: its proof, and its verification over intervals of the driver angle."""

from __future__ import annotations

import math
from typing import Any

from grashof.analysis.judge.enclosed import find_enclosures
from grashof.analysis.judge.verdict import Enclosure
from grashof.problems.values.linkages.mechanisms import is_of
from grashof.problems.values.text import counted
from grashof.synth import Result
from grashof.synth.proof.claims.proof import Claim, Proof, quantity_of

_DECIMALS = 2
_SAME = 1e-9  # deg: rounding
_NOTHING = 90.0  # deg: a trivial bound
_NAMED = 2  # designs of each reason, by their ids


def proof_line(result: Result) -> str:
    """Statement of the proof of a list, rounded to the safe side; empty without a proof."""
    if result.proof is None:
        return ""
    rank = _rank(result, result.proof)
    return _line(result.proof, f"number {rank} has" if rank else "")


def bound_line(proof: Proof, at_least: float | None = None) -> str:
    """Statement of the proof of a problem without a list; or whether a design reaches `at_least`, deg."""
    if _reached(proof, at_least):
        return f"Proven: a design that the judge accepts has {_down(proof.lower)} deg."
    return _line(proof, "a design has" if proof.lower is not None else "")


def is_decided(proof: Proof, at_least: float | None = None) -> bool:
    """Whether the best is known, or that none exists; or whether a design reaches `at_least`, deg."""
    if at_least is not None:
        return proof.claim is Claim.NONE or _reached(proof, at_least)
    return proof.claim in (Claim.BEST, Claim.NONE)


def _reached(proof: Proof, at_least: float | None) -> bool:
    return at_least is not None and proof.lower is not None and proof.lower >= at_least


def _line(proof: Proof, known: str) -> str:
    if proof.claim is Claim.REFUSED:
        return f"Not proven: {proof.why}."
    if proof.claim is Claim.FOLLOWED:
        return f"All followed, which is no proof of all: {proof.why}."
    if proof.upper is None or (not proof.pairs and proof.upper == proof.lower):
        return _all_line(proof, known)
    angle, none = f"{_up(proof.upper)} deg", f"no {proof.mechanism} meets these requirements"
    if proof.claim is Claim.NONE:
        reason = f", as {proof.why}" if proof.why else f" with a transmission angle of {angle} or more"
        return f"Proven: {none}{reason}."
    has = f"; {known} {_down(proof.lower)} deg" if known else ""
    if proof.claim is Claim.BEST:
        return f"Proven: {none} with more than {angle}{has}.{_regions(proof)}"
    if proof.upper >= _NOTHING:
        return f"Not proven{_because(proof)}{has}."
    return f"Proven: no {proof.mechanism} has more than {angle}{_because(proof)}{has}."


def _all_line(proof: Proof, known: str) -> str:
    """Statement for five poses or pairs, whose linkages are all known."""
    meet = "meets" if proof.pieces[0] == 1 else "meet"
    known_dyads = f"{counted(proof.pieces[0], 'dyad')} {meet} the targets within the limits"
    if proof.claim is Claim.NONE:
        return f"Proven: {known_dyads}, and no {proof.mechanism} of these does it."
    has = f"; {known} the most, {_down(proof.lower)} deg" if known else ""
    return f"Proven: {known_dyads}, and no other {proof.mechanism} of these does it{has}."


def _regions(proof: Proof) -> str:
    """The number of regions of good designs, if there are several."""
    return f" Designs above half of that form {proof.regions} regions." if proof.regions > 1 else ""


def _because(proof: Proof) -> str:
    """The reasons why a bound is not tighter."""
    reasons = [f"without {' and '.join(proof.left_out)}"] * bool(proof.left_out)
    reasons += [proof.why] * bool(proof.why)
    return f" ({'; '.join(reasons)})" if reasons else ""


def _rank(result: Result, proof: Proof) -> int:
    """Rank of the listed linkage with the proven value; 0 where a short list lacks it."""
    key = quantity_of(result.problem).key
    least = math.inf if proof.lower is None else proof.lower - _SAME
    for rank, one in enumerate(result.candidates, start=1):
        if is_of(one.linkage, [proof.mechanism]) and math.degrees(one.values[key]) >= least:
            return rank
    return 0


def _up(value: float) -> str:
    step = 10**_DECIMALS
    return f"{math.ceil(value * step - 1e-9) / step:.{_DECIMALS}f}"


def _down(value: float | None) -> str:
    step = 10**_DECIMALS
    return f"{math.floor((value or 0.0) * step + 1e-9) / step:.{_DECIMALS}f}"


def work_line(proof: Proof) -> str:
    """The effort of a proof.

    >>> work_line(Proof(claim=Claim.BEST, quantity="", pieces=(42, 40), pairs=3049, levels=5, seconds=0.1))
    '42 by 40 pieces of all dyads, 3049 pairs, halved 5 times, 0.10 s'
    """
    first, second = proof.pieces
    halved = f"halved {counted(proof.levels, 'time')}, {proof.seconds:.2f} s"
    if not first:
        return f"{proof.seconds:.2f} s"
    if not proof.pairs and not second:
        return f"Krawczyk's test of {counted(first, 'listed linkage')}, {proof.seconds:.2f} s"
    if not proof.pairs:
        return f"{counted(first, 'dyad')}, each in a box of its own, {proof.seconds:.2f} s"
    if not second:
        return f"{counted(first, 'piece')} of one-parameter families, {proof.pairs} in all, {halved}"
    return f"{first} by {second} pieces of all dyads, {counted(proof.pairs, 'pair')}, {halved}"


def enclosure_line(result: Result) -> str:
    """The number of designs verified by intervals, and the reasons for the others; empty without designs."""
    found = zip(result.candidates, enclosures(result), strict=True)
    named = [(one.id, each) for one, each in found if len(one.linkage.mechanism.loops) == 1]
    if any(each.contradicts for _, each in named):
        wrong = _by_reason({name: each.why for name, each in named if each.contradicts})
        return f"Intervals contradict the judge, an error of this program to report: {wrong}."
    if not named:
        return ""
    undecided = {name: each.why for name, each in named if not each.holds}
    shown = len(named) - len(undecided)
    many = counted(shown, "design") if not undecided else f"{shown} of {counted(len(named), 'design')}"
    rest = f"; undecided: {_by_reason(undecided)}" if undecided else ""
    shown_of = f"Closure and transmission angle of {many} verified by intervals of the driver angle"
    return f"{shown_of}, over their full motion{rest}."


def _by_reason(missing: dict[str, str]) -> str:
    """The reasons, each once, after the first designs that have it.

    >>> _by_reason({"1f": "order", "2e": "closure", "3d": "order", "4c": "order"})
    '1f, 3d and another (order), 2e (closure)'
    """
    said = []
    for why in dict.fromkeys(missing.values()):
        mine = [name for name, its in missing.items() if its == why]
        others = len(mine) - _NAMED
        more = f" and {'another' if others == 1 else f'{others} others'}" if others > 0 else ""
        said.append(f"{', '.join(mine[:_NAMED])}{more} ({why})")
    return ", ".join(said)


def enclosures(result: Result) -> tuple[Enclosure, ...]:
    """The enclosure of each design of a list."""
    return find_enclosures([each.values for each in result.candidates])


def enclosure_record(result: Result) -> dict[str, Any] | None:
    """The enclosures for `run.json`; None without designs."""
    found = enclosures(result)
    if not found:
        return None
    named = list(zip((each.id for each in result.candidates), found, strict=True))
    return {
        "designs": sum(each.holds for each in found),
        "intervals": sum(each.intervals for each in found),
        "undecided": {name: each.why for name, each in named if not (each.holds or each.contradicts)},
        "contradicted": {name: each.why for name, each in named if each.contradicts},
    }
