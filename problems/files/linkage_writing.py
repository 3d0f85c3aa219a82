"""A linkage written as a file, which `load_linkage_spec` reads back to the last digit."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import MISSING, fields, replace
from typing import Any

import numpy as np

from grashof.problems.files.problem_writing import Tables, degrees_of, dynamics_tables, toml_text
from grashof.problems.values.dynamics.dynamics_spec import DynamicsSpec
from grashof.problems.values.specs.linkage_spec import LinkageSpec

_HEAD = ("title", "source", "length_unit")


def linkage_toml(spec: LinkageSpec) -> str:
    """The linkage as TOML: its parameters, cylinder, masses and loads, without the problem of its list.

    An angle is in degrees where these give it back to the last bit, otherwise in radians.

    Examples
    --------
    >>> from grashof.problems import load_linkage_spec
    >>> print(linkage_toml(load_linkage_spec("pumpjack")).splitlines()[6])
    r2 = 1.1938
    """
    from grashof.problems.files.linkage_schema import OF_DYAD, as_document, in_radians

    head = {"mechanism": spec.linkage.mechanism.word, **_given(spec, _HEAD)}
    stated = spec.linkage.stated
    angles = {row.name: row for row in spec.linkage.mechanism.parameters if row.kind == "angle"}
    document = as_document({name: x for name, x in stated.items() if name not in angles})
    dyad = document.pop("dyad", {})
    for name, row in angles.items():
        key = next((key for key, each in OF_DYAD.items() if each == row), row.key)
        place = dyad if row in OF_DYAD.values() else document
        place |= _angle(key, in_radians(key), stated[name])
    own = {} if spec.cylinder is None else {"cylinder": spec.cylinder.stated}
    return toml_text({**head, **document, **_given(spec, ("output_arm",)), **own}, _tables(spec, dyad))


def mail_toml(spec: LinkageSpec) -> str:
    """The same as `grashof show` prints it; for a design without the path of its list."""
    return linkage_toml(spec if spec.problem is None else replace(spec, source=""))


def _given(spec: LinkageSpec, names: tuple[str, ...]) -> dict[str, Any]:
    return {name: value for name in names if (value := getattr(spec, name)) not in ("", None)}


def _angle(key: str, radians: str, value: float) -> dict[str, float]:
    """An angle under its key in degrees or, where these would change its last bit, in radians."""
    degrees = float(degrees_of(np.array(value)))
    return {key: degrees} if np.radians(degrees) == value else {radians: value}


def _tables(spec: LinkageSpec, dyad: Mapping[str, Any]) -> Tables:
    if dyad:
        yield "dyad", dyad
    if spec.pumping_unit is not None:
        yield "pumping_unit", spec.pumping_unit.stated
    if spec.dynamics is not None:
        usual = {each.name: each.default for each in fields(DynamicsSpec) if each.default is not MISSING}
        own, *others = dynamics_tables(spec.dynamics, spec.length_unit)
        yield own[0], {key: x for key, x in own[1].items() if key == "speed_rpm" or x != usual[key]}
        yield from others
