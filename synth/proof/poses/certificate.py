"""Certificates of proofs of four poses: the parts examined, and why each was dropped, for others to check."""

from __future__ import annotations

import json
import os
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np

from grashof.problems import ProblemError
from grashof.problems.values.arrays import IntArray
from grashof.synth.proof.curve.centres import centres_of
from grashof.synth.proof.curve.dyads import possible_arms, roles_of
from grashof.synth.proof.curve.pieces import Tubes, contracted
from grashof.synth.proof.curve.required import Required, with_forms
from grashof.synth.proof.curve.table import Pieces, Side, Trail
from grashof.synth.proof.poses.pairs import sifted
from grashof.synth.quantities.scaled_problem import ScaledProblem

FORM = 1  # of the file
_BOXES = ("o2", "o4", "a", "b", "a_on_body", "b_on_body")
_UNCHECKED = ("driver_sense", "driver_rotation_deg", "theta2_start_deg", "ground_angle_deg")
_EITHER = "either"  # sense of the driver
_AT_ONCE = 8192


def without_check(scaled: ScaledProblem) -> tuple[str, ...]:
    """Requirements that proofs use and certificates do not state, by their fields."""
    wanted = with_forms(scaled).problem.requirements
    stated = [name for name in _UNCHECKED if getattr(wanted, name) not in (None, _EITHER)]
    return (*stated, *["keep_out"] * bool(wanted.keep_out))


def certificate_of(
    scaled: ScaledProblem, trail: Trail, upper: float, at_least: float | None
) -> dict[str, Any]:
    """The certificate that no linkage transmits more than `upper`, deg, ready for a file.

    The proof notes the parts examined; the reason why each was dropped is found again here, always against
    the resulting bound.
    """
    about = with_forms(scaled)
    required = Required.of(about, at_least)
    return {"grashof_certificate": FORM, **_stated(about, required, upper), **_tree(required, trail, upper)}


def writable(path: Path) -> None:
    """Refuse a path that no file can be written to, before the proof."""
    if path.is_dir() or not path.parent.is_dir():
        reason = "a folder" if path.is_dir() else "in a folder that does not exist"
        raise ProblemError(f"certificate {path}: {reason}; it must be a file that can be written")


def write(certificate: dict[str, Any], path: Path) -> None:
    """Write a certificate, completely or not at all."""
    fresh = path.with_name(f".{path.name}.{os.getpid()}")
    try:
        fresh.write_text(json.dumps(certificate, allow_nan=False), encoding="utf-8")
        fresh.replace(path)
    except OSError as error:
        with suppress(OSError):
            fresh.unlink(missing_ok=True)
        reason = error.strerror or "it cannot be written"
        raise ProblemError(f"certificate {path}: {reason}; it must be a file that can be written") from None


def _stated(scaled: ScaledProblem, required: Required, upper: float) -> dict[str, Any]:
    """The proven statement, in the units of the problem."""
    task, size = scaled.problem.task, float(scaled.frame.scale)
    wanted = scaled.problem.requirements.resolved(size, scale_free=scaled.frame.scale_free)
    required_of = {name: getattr(wanted, name) for name in _BOXES}
    boxes = {name: box for name, box in required_of.items() if box and np.isfinite([box.x, box.y]).any()}
    limits = dict(zip(("r1", "r2", "r3", "r4"), map(list, wanted.link_lengths), strict=True))
    return {
        "problem": scaled.problem.name,
        "length_unit": scaled.problem.length_unit,
        "poses": np.column_stack([task.positions, np.degrees(task.angles)]).tolist(),
        "limits": _finite(
            {
                **limits,
                "coupler_arms": list(wanted.coupler_arms or (0.0, np.inf)),
                "link_ratio_max": wanted.link_ratio_max,
                **{name: {"x": list(box.x), "y": list(box.y)} for name, box in boxes.items()},
                "rotatability": str(wanted.rotatability),
                "rotatability_margin": wanted.rotatability_margin,
                "order": required.ordered,
                "same_branch": required.loop.one_branch,
                "transmission_over": "cycle" if required.over_turn else "task",
            }
        ),
        "upper_deg": upper,
        "size": size,
    }


def _finite(limit: Any) -> Any:
    """Limits as JSON has them: null where one is infinite."""
    if isinstance(limit, dict):
        return {name: _finite(each) for name, each in limit.items()}
    if isinstance(limit, list):
        return [_finite(each) for each in limit]
    return None if limit in (np.inf, -np.inf) else limit


def _tree(required: Required, trail: Trail, upper: float) -> dict[str, Any]:
    """The rectangles, and the pairs of pieces, each with its fate."""
    rectangles = Tubes.joined(*trail.rectangles)
    tubes, filled = contracted(required.curve, rectangles)
    near = possible_arms(required, tubes.span)
    centres = centres_of(required.curve, tubes, required.longest)
    roles = roles_of(required, tubes.span, centres.span)
    fates = np.select(
        [~filled, ~near, roles.driver & roles.driven, roles.driver, roles.driven],
        ["missed", "far", "either", "driver", "driven"], "barred",
    )  # fmt: skip
    pieces = Pieces(tubes, centres, roles.driver, roles.driven, roles.sense)
    return {
        "parents": np.concatenate(trail.parents).tolist(),
        "rectangles": _numbers(rectangles, "half", "side"),
        "tubes": [
            tube if held else None
            for tube, held in zip(_numbers(tubes, "half", "tilt", "bow"), fates != "missed", strict=True)
        ],
        "fates": fates.tolist(),
        "first": trail.pieces[: trail.first].tolist(),
        "pairs": _levels(required, pieces, trail, np.radians(upper)),
    }


def _numbers(tubes: Tubes, *names: str) -> list[list[float]]:
    """Middle, direction and other parts of tubes."""
    parts = [tubes.middle.real, tubes.middle.imag, tubes.direction.real, tubes.direction.imag]
    made: list[list[float]] = np.stack([*parts, *(getattr(tubes, name) for name in names)], axis=1).tolist()
    return made


def _levels(required: Required, pieces: Pieces, trail: Trail, upper: float) -> list[dict[str, Any]]:
    """All pairs by level: those that were halved, and the others by the condition that drops them."""
    parents = np.concatenate(trail.parents)
    count, first = len(parents), trail.pieces[: trail.first]
    order = np.argsort(parents, kind="stable")
    begin = np.searchsorted(parents[order], np.arange(count))
    halves = np.full((count, 2), -1)
    has = np.searchsorted(parents[order], np.arange(count), side="right") - begin == 2
    halves[has] = np.stack([order[begin[has]], order[begin[has] + 1]], axis=1)
    held = np.isin(np.arange(count), trail.pieces)
    driver, driven = pieces.driver & held, pieces.driven & held
    drivers, others = first[driver[first]], first[driven[first]]
    one, other = np.repeat(drivers, len(others)), np.tile(others, len(drivers))
    levels = []
    for halved in [*trail.halved, None]:
        now = np.zeros(0, dtype=np.int64) if halved is None else _keys(trail, halved, count)
        leaf = ~np.isin(one * count + other, now)
        levels.append(
            {
                "halved": np.stack([now // count, now % count], axis=1).tolist(),
                **_reasons(required, pieces, one[leaf], other[leaf], upper),
            }
        )
        one, other = (
            np.repeat(halves[now // count], 2, axis=1).ravel(),
            np.tile(halves[now % count], (1, 2)).ravel(),
        )
        some = driver[one] & driven[other]
        one, other = one[some], other[some]
    return levels


def _keys(trail: Trail, pairs: tuple[IntArray, IntArray], count: int) -> IntArray:
    keys: IntArray = trail.pieces[pairs[0]] * count + trail.pieces[pairs[1]]
    return keys


def _reasons(
    required: Required, pieces: Pieces, one: IntArray, other: IntArray, upper: float
) -> dict[str, Any]:
    """Pairs by the condition that drops them."""
    found: dict[str, list[list[int]]] = {"lengths": [], "transmission": [], "together": [], "left": []}
    for begin in range(0, len(one), _AT_ONCE):
        pairs = np.stack([one[begin : begin + _AT_ONCE], other[begin : begin + _AT_ONCE]], axis=1)
        least = np.full(len(pairs), upper)
        sides = Side.of(pieces, pairs[:, 0], is_driver=True), Side.of(pieces, pairs[:, 1], is_driver=False)
        first, second, third, _ = sifted(required, *sides, pieces.sense[pairs[:, 0]], least)
        step = np.zeros(len(pairs), dtype=np.int64)
        for rows in (first, second, third):
            step[rows] += 1
        for number, name in enumerate(found):
            found[name] += pairs[step == number].tolist()
    return found
