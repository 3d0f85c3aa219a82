"""Loads and drives of a problem in words: masses, loads, motor, cylinder, torque and effort."""

from __future__ import annotations

from collections.abc import Iterator

from grashof.problems import CylinderSpec, DynamicsSpec, WantedTorque
from grashof.problems.values.dynamics.effort import Demand, EffortSpec
from grashof.problems.values.dynamics.struts import BODY
from grashof.problems.values.errors import listing
from grashof.problems.values.text import counted

# Names of curves of an effort.
OVER_TRAVEL, WITHOUT_PARTS = "angle from the start of the travel (deg)", "without struts and springs"
FEW_ROWS = 4  # most rows of a wanted torque that a summary states in full


def torque_text(torque: WantedTorque) -> str:
    """A wanted drive torque."""
    places = {"driver": "{:g} deg", "share": "share {:g}", "target": "target {:g}"}[torque.over]
    ends = [f"{value:g} N m at {places.format(place)}" for place, value in torque.wanted]
    few = ends if len(ends) <= FEW_ROWS else [ends[0], "...", ends[-1]]
    counted_as = f"; the greatest counts as {torque.weight:g} sizes" if torque.weight else ""
    return f"wanted torque: {', '.join(few)}{counted_as}"


def loads_text(spec: DynamicsSpec) -> str:
    """Masses, loads and the driver's motion."""
    x, y = spec.gravity
    every = [_links(spec), *_acting(spec)]
    every += [f"payload {spec.payload:g} kg"] if spec.payload else []
    return f"dynamics: {', '.join(every)}; driver {_motor(spec)}; gravity {x:g}, {y:g} m/s2"


def effort_text(spec: EffortSpec) -> str:
    """The wanted effort, and its parts."""
    words = [f"effort on {'link ' if spec.on.link != BODY else 'the '}{spec.on.link}"]
    if spec.wanted is not None:
        words.append(f"as wanted in {counted(len(spec.wanted), 'row')}")
    if spec.band is not None:
        words.append(f"{spec.band[0]:g} to {spec.band[1]:g} N")
    if spec.stays_deg is not None:
        words.append(f"stays from {spec.stays_deg[0]:g} to {spec.stays_deg[1]:g} deg")
    if spec.closes_below_deg is not None:
        words.append(f"closes below {spec.closes_below_deg:g} deg")
    words.append(f"at {listing([f'{each:g}' for each in spec.temperatures_c], 'and')} deg C")
    words += [f"{part.count} x {part.kind} of {counted(len(part.sizes), 'size')}" for part in spec.parts]
    return "; ".join(words)


def temperature_text(temperature_c: float) -> str:
    """The name of the curve at a temperature."""
    return f"at {temperature_c:g} °C"


def demand_texts(demand: Demand) -> tuple[str, str]:
    """The names of the lower and the upper limit of an effort, equal where both are one line."""
    if demand.least == demand.most and not demand.friction:
        return demand.words, demand.words
    return f"{demand.words}, least", f"{demand.words}, most"


def cylinder_text(spec: CylinderSpec, unit: str) -> str:
    """The limits of the driving cylinder."""
    words = [f"driven by a cylinder on {' or '.join(spec.on)}"]
    if spec.closed is not None:
        words.append(f"closed {spec.closed[0]:g} to {spec.closed[1]:g}{unit}")
    words.append(f"open up to {spec.ratio_max:g} times that")
    if spec.base is not None:
        (left, right), (low, high) = spec.base.x, spec.base.y
        words.append(f"base x {left:g} to {right:g}, y {low:g} to {high:g}{unit}")
    return "; ".join(words)


def _links(spec: DynamicsSpec) -> str:
    if spec.masses is not None:
        centres = "" if spec.centres is None else ", centres given"
        return f"links of {', '.join(f'{m:g}' for m in spec.masses)} kg{centres}"
    if spec.mass_per_length is not None:
        return f"uniform links of {spec.mass_per_length:g} kg a length unit"
    return "massless links" if spec.density is None else f"uniform links of {spec.density:g} kg/m3"


def _acting(spec: DynamicsSpec) -> Iterator[str]:
    """Numbers of loads besides weight."""
    names = {"loads": "load", "springs": "spring", "dampers": "damper", "counterweights": "counterweight"}
    names |= {"torsion_springs": "torsion spring"}
    for key, noun in names.items():
        if entries := getattr(spec, key):
            yield counted(len(entries), noun)
    if spec.friction is not None:
        yield "friction"


def _motor(spec: DynamicsSpec) -> str:
    if spec.motor is not None and spec.motor.values is not None:
        return f"by a table of {spec.turn_time:g} s"
    profile = "" if spec.motor is None or spec.motor.steady else f"from rest to rest ({spec.motor.profile}) "
    return f"{profile}at {spec.speed_rpm:g} rpm"
