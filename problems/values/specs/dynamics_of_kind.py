"""What of some dynamics does not go with a kind of linkage: slides that it has not, pins at its slides."""

from __future__ import annotations

from collections.abc import Iterator

from grashof.problems.values.dynamics.acting import JOINTS, SLIDE_KEYS
from grashof.problems.values.dynamics.dynamics_spec import DynamicsSpec
from grashof.problems.values.linkages.mechanism import Mechanism

_AT = ("O2", "A", "B", "O4")
# What a slide has instead of each key of `FrictionSpec`.
_INSTEAD = {
    "coulomb": "slide_mu",
    "pin_radius": "slide_mu",
    "viscous": "slide_viscous",
    "moment": "slide_force",
}


def misplaced(spec: DynamicsSpec, kind: Mechanism) -> list[str]:
    """What of some dynamics does not go with a kind of linkage, a line each.

    Parameters
    ----------
    spec : DynamicsSpec
    kind : Mechanism

    Examples
    --------
    >>> from grashof.problems import SliderCrank
    >>> from grashof.problems.values.dynamics.acting import TorsionSpringSpec
    >>> given = DynamicsSpec(mass_per_length=1.0, torsion_springs=(TorsionSpringSpec((1, 4), 2.0),))
    >>> misplaced(given, SliderCrank.mechanism)[0]
    'torsion_springs[0].between is [1, 4]; a slider-crank has a slide there, so it must be at a pin'
    """
    return [*_loads(spec, kind), *_torsion_springs(spec, kind), *_friction(spec, kind)]


def _loads(spec: DynamicsSpec, kind: Mechanism) -> Iterator[str]:
    for index, load in enumerate(spec.loads):
        where = f"loads[{index}].over is '{load.over}'"
        if load.over == "travel" and not kind.slides:
            yield f"{where}; {_named(kind)} has no slide, so it must be theta2, theta4 or time"
        if load.over == "theta4" and (1, 4) in kind.slides:
            turning = f"the slider of {_named(kind)} does not turn"
            yield f"{where}; {turning}, so it must be theta2, travel or time"


def _torsion_springs(spec: DynamicsSpec, kind: Mechanism) -> Iterator[str]:
    for index, spring in enumerate(spec.torsion_springs):
        if spring.between in kind.slides:
            given = f"torsion_springs[{index}].between is {list(spring.between)}"
            yield f"{given}; {_named(kind)} has a slide there, so it must be at a pin"


def _friction(spec: DynamicsSpec, kind: Mechanism) -> Iterator[str]:
    friction = spec.friction
    if friction is None:
        return
    if not kind.slides:
        for key in SLIDE_KEYS:
            if getattr(friction, key):
                yield f"friction.{key} is {getattr(friction, key):g}; {_named(kind)} has no slide"
        return
    slide = JOINTS.index(kind.slides[0])
    for key, instead in _INSTEAD.items():
        each = getattr(friction, key)
        if len(each) == len(JOINTS) and each[slide]:
            where = f"friction.{key}[{slide}] is {each[slide]:g}, in {_AT[slide]}"
            yield f"{where}; {_named(kind)} has a slide there, so it must be 0 ({instead} is for slides)"


def _named(kind: Mechanism) -> str:
    return f"{'an' if kind.word[0] in 'aeiou' else 'a'} {kind.word}"
