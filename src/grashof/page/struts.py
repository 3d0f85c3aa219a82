"""Struts and springs of a linkage for the scripts of a page, by which a hand moves their ends."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from grashof.analysis.effort.case import EffortCase
from grashof.analysis.effort.deviation import even_places
from grashof.analysis.effort.parts import place_on
from grashof.analysis.mechanism.kinematics import Kinematics
from grashof.page.render import compact, plain
from grashof.problems import Linkage
from grashof.problems.values.arrays import FloatArray
from grashof.problems.values.dynamics.effort import Demand, EffortSpec
from grashof.problems.values.dynamics.struts import PartSpec
from grashof.wording.loads import OVER_TRAVEL, WITHOUT_PARTS, demand_texts, temperature_text

_BODY = 0.9  # length of the body of a strut as a share of its compressed length
_DIGITS = 13  # of samples, so that the scripts have the effort to 1e-9
_SAMPLES = 61


def strut_data(linkage: Linkage, effort: EffortSpec | None) -> dict[str, Any]:
    """Placed struts and straight springs for the scripts; empty without one."""
    found = [
        {
            "label": f"part {number}",
            "chosen": part.chosen,
            "ends": [
                dict(zip(("link", "at"), place_on(linkage, place), strict=True)) for place in part.places
            ],
            "body": _BODY * part.sizes[0].compressed if part.sense > 0 else 0.0,
        }
        for number, part in _straight(effort)
    ]
    return {"struts": found} if found else {}


def effort_data(case: EffortCase | None) -> dict[str, Any]:
    """What the scripts need to find an effort anew; empty without placed struts or straight springs.

    At places of the travel, with the ends of demands: the effort without these parts, the effort for a unit
    of their power, and the motion of each link that carries an end. Lengths are in the unit of the linkage,
    angles in rad but for those of the axis, deg.
    """
    straight = _straight(None if case is None else case.spec)
    if case is None or not straight:
        return {}
    turning = tuple(part for part in case.spec.parts if part.turns)
    bare = replace(case, dynamics=replace(case.dynamics, effort=replace(case.spec, parts=turning)))
    places = _places(case)
    state = bare.at(places)
    virtual, rest, sense = case.motion(places)
    links = {place_on(case.linkage, place)[0] for _, part in straight for place in part.places}
    found = {
        "over": OVER_TRAVEL,
        "angle": state.angle_deg,
        "theta2": np.degrees(case.travel.at(places).theta2),
        "sense": state.sense,
        "without": state.without,
        "others": state.effort[0],  # torsion springs do not change with the temperature
        "friction": state.friction,
        "per": state.per,
    }
    return {
        "effort": {
            **{key: _samples(each) if isinstance(each, np.ndarray) else each for key, each in found.items()},
            "bare": WITHOUT_PARTS,
            "frames": {link: _frame(link, virtual, rest, sense) for link in sorted(links) if link > 1},
            "temperatures": [temperature_text(each) for each in case.spec.temperatures_c],
            "parts": [_part(part, case.spec) for _, part in straight],
            "demands": [_demand(each) for each in case.spec.demands],
        }
    }


def _straight(effort: EffortSpec | None) -> list[tuple[int, PartSpec]]:
    """Placed struts and straight springs with their numbers."""
    if effort is None or not effort.is_placed:
        return []
    return [(number, part) for number, part in enumerate(effort.parts, start=1) if part.places]


def _places(case: EffortCase) -> FloatArray:
    """Places from the start of the travel to its end, with the ends of demands, where limits have corners."""
    ends = {angle for demand in case.spec.demands for angle in (demand.start, demand.end)}
    places = np.unique([*even_places(case, _SAMPLES), *map(case.place_at, ends)])
    return places if case.travel.end > case.travel.start else places[::-1]


def _frame(link: int, virtual: Kinematics, rest: Kinematics, sense: FloatArray) -> dict[str, Any]:
    """Origin, direction and motion of the frame of a link."""
    origin = virtual.point(link, (0.0, 0.0))
    x, y = np.broadcast_to(origin.position, (*sense.shape, 2)).T
    vx, vy = np.broadcast_to(sense[:, None] * origin.velocity, (*sense.shape, 2)).T
    arrays = {"x": x, "y": y, "vx": vx, "vy": vy}
    arrays |= {"angle": rest.frame_angle(link), "turn": sense * virtual.angular(link).omega}
    return {key: _samples(each) for key, each in arrays.items()}


def _part(part: PartSpec, effort: EffortSpec) -> dict[str, Any]:
    size = part.sizes[0]
    return {
        "push": part.count * part.sense,
        "warmth": [part.warmth(each) for each in effort.temperatures_c],
        "extended": size.extended,
        "compressed": size.compressed,
        "forceExtended": size.force_extended,
        "forceCompressed": size.force_compressed,
        "friction": part.count * size.friction,
    }


def _demand(demand: Demand) -> dict[str, Any]:
    """A demand with the names of its lines; null for a side, or an end, that is open."""
    sides = ("least", "most")
    return {
        "labels": demand_texts(demand),
        "start": demand.start,
        "end": plain(demand.end),
        **{side: [plain(each) for each in getattr(demand, side)] for side in sides},
        "friction": demand.friction,
        "opening": demand.opening,
    }


def _samples(values: FloatArray) -> list[float | None]:
    return compact(np.asarray(values, dtype=float).tolist(), _DIGITS)
