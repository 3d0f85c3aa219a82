"""Dynamics that do not fit a kind of linkage: links, joints or slides that it does not have."""

from __future__ import annotations

from collections.abc import Iterator

from grashof.problems.values.dynamics.dynamics_spec import DynamicsSpec
from grashof.problems.values.dynamics.load_specs import OVER, SLIDE_KEYS, TURNING
from grashof.problems.values.errors import listing, wrong_value
from grashof.problems.values.linkages.mechanism import Mechanism
from grashof.problems.values.text import counted, with_article

# Keys of a slide in place of those of a pin.
_INSTEAD = {
    "coulomb": "slide_mu",
    "pin_radius": "slide_mu",
    "viscous": "slide_viscous",
    "moment": "slide_force",
}
_WORDS = {3: "three", 4: "four", 5: "five", 7: "seven"}


def misplaced(spec: DynamicsSpec, kind: Mechanism) -> list[str]:
    """Errors of dynamics that do not fit a kind of linkage, a line each."""
    slides = (*_loads(spec, kind), *_torsion_springs(spec, kind), *_friction(spec, kind))
    return [*without_place(spec, kind), *slides]


def without_place(spec: DynamicsSpec, kind: Mechanism) -> list[str]:
    """The same of links, joints and angles alone, by their numbers and names."""
    return [*_sizes(spec, kind), *_links(spec, kind), *_angles(spec, kind), *_joints(spec, kind)]


def _sizes(spec: DynamicsSpec, kind: Mechanism) -> Iterator[str]:
    moving = [link.number for link in kind.links if link.number > 1]
    for name in ("masses", "inertias"):
        given = getattr(spec, name)
        if given is not None and len(given) != len(moving):
            yield f"dynamics.{name} has {counted(len(given), 'entry')}; it must have {len(moving)} numbers"
    if spec.centres is not None and len(spec.centres) != len(moving):
        places = f"{_WORDS[len(moving)]} places [u, v], of links {listing(moving, 'and')}"
        yield str(wrong_value("dynamics.centres", spec.centres, places))
    for table, given in (("section", spec.section), ("strength", spec.strength)):
        for name, value in () if given is None else given.stated.items():
            count = len(kind.every_joint) if name == "pin_diameter" else len(moving)
            if isinstance(value, list) and len(value) != count:  # such lists are of linkages of one loop
                entries = f"{table}.{name} has {len(value)} entries"
                yield f"{entries}; it must be a number with mechanism {kind.word}"


def _links(spec: DynamicsSpec, kind: Mechanism) -> Iterator[str]:
    """Loads and counterweights on moving links; springs and dampers between any two."""
    held = [(f"loads[{i}]", each.link, 2) for i, each in enumerate(spec.loads)]
    held += [(f"counterweights[{i}]", each.link, 2) for i, each in enumerate(spec.counterweights)]
    springs, dampers = ([each.between for each in acting] for acting in (spec.springs, spec.dampers))
    for name, pairs in (("springs", springs), ("dampers", dampers)):
        ends = ((i, end, place) for i, pair in enumerate(pairs) for end, place in enumerate(pair))
        held += [(f"{name}[{i}].between[{end}]", place.link, 1) for i, end, place in ends]
    for key, number in () if spec.effort is None else spec.effort.links.items():
        if isinstance(number, int):  # not the body
            held.append((key.removesuffix(".link"), number, 2 if key.startswith("effort.on") else 1))
    for where, number, least in held:
        allowed = [link.number for link in kind.links if link.number >= least]
        if number not in allowed:
            yield str(wrong_value(f"{where}.link", number, listing(allowed)))


def _angles(spec: DynamicsSpec, kind: Mechanism) -> Iterator[str]:
    words = _over(kind)
    for index, load in enumerate(spec.loads):
        if load.over not in words:
            yield str(wrong_value(f"loads[{index}].over", load.over, listing(words)))


def _over(kind: Mechanism, but: str = "") -> list[str]:
    """The variables of loads: angles of existing links, travel and time."""
    angles = [f"theta{link.number}" for link in kind.links]
    return [word for word in OVER if (word in angles or word not in TURNING) and word != but]


def _joints(spec: DynamicsSpec, kind: Mechanism) -> Iterator[str]:
    joints = kind.every_joint
    for where, between in _about_joints(spec):
        pairs = [list(joint.links) for joint in joints]
        if list(between) not in pairs:
            wanted = f"two links of a joint: {listing(pairs, 'or')}"
            yield str(wrong_value(f"{where}.between", list(between), wanted))
    for key in _INSTEAD if spec.friction is not None else ():
        each = getattr(spec.friction, key)
        if len(each) not in (1, len(joints)):
            in_all = f"{_WORDS[len(joints)]}: in {', '.join(joint.name for joint in joints)}"
            yield str(wrong_value(f"friction.{key}", list(each), f"a number, or {in_all}"))


def _loads(spec: DynamicsSpec, kind: Mechanism) -> Iterator[str]:
    fixed = [f"theta{second}" for first, second in kind.slides if first == 1]
    for index, load in enumerate(spec.loads):
        where, instead = f"loads[{index}].over is '{load.over}'", listing(_over(kind, but=load.over))
        if load.over == "travel" and not kind.slides:
            yield f"{where}; {with_article(kind.word)} has no slide, so it must be {instead}"
        if load.over in fixed:
            yield f"{where}; the slider of {with_article(kind.word)} does not turn, so it must be {instead}"


def _torsion_springs(spec: DynamicsSpec, kind: Mechanism) -> Iterator[str]:
    for where, between in _about_joints(spec):
        if between in kind.slides:
            given = f"{where}.between is {list(between)}"
            yield f"{given}; {with_article(kind.word)} has a slide there, so it must be at a pin"


def _about_joints(spec: DynamicsSpec) -> Iterator[tuple[str, tuple[int, int]]]:
    """Torsion springs by their places in a file, and their links."""
    for index, spring in enumerate(spec.torsion_springs):
        yield f"torsion_springs[{index}]", spring.between
    for index, part in enumerate(() if spec.effort is None else spec.effort.parts):
        if part.turns:
            yield f"effort.parts[{index}]", part.joint


def _friction(spec: DynamicsSpec, kind: Mechanism) -> Iterator[str]:
    friction = spec.friction
    if friction is None:
        return
    if not kind.slides:
        for key in SLIDE_KEYS:
            if getattr(friction, key):
                yield f"friction.{key} is {getattr(friction, key):g}; {with_article(kind.word)} has no slide"
        return
    slide, joint = next((i, joint) for i, joint in enumerate(kind.every_joint) if joint.slides)
    for key, instead in _INSTEAD.items():
        each = getattr(friction, key)
        if len(each) == len(kind.every_joint) and each[slide]:
            where = f"friction.{key}[{slide}] is {each[slide]:g}, in {joint.name}"
            why = f"{with_article(kind.word)} has a slide there"
            yield f"{where}; {why}, so it must be 0 ({instead} is for slides)"
