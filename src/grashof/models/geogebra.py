"""A linkage as a GeoGebra worksheet: a slider for the driver angle, the links, the locus of P."""

from __future__ import annotations

import xml.etree.ElementTree as ET
import zipfile
from io import BytesIO

import numpy as np

from grashof.analysis import solve_position
from grashof.analysis.mechanism.position import places
from grashof.drawing.scene import Scene
from grashof.models.model import Model, add
from grashof.problems import Linkage
from grashof.problems.values.linkages.mechanism import DyadKind

_DATE = (1980, 1, 1, 0, 0, 0)  # the same linkage gives the same bytes
_WINDOW = (600, 450)  # pixels
_COLOURS = {
    "driver": (78, 120, 168),
    "coupler": (242, 142, 43),
    "output": (89, 161, 79),
    "coupler-2": (176, 122, 161),
    "output-2": (118, 183, 178),
}
_GREY = 120, 120, 120
# Points and numbers of a dyad from C over E to D, each after those that it depends on, in formulas of
# GeoGebra; m and n are its bars, e and g the direction of its first link. Left of (x, y) is (-y, x). In
# closed form, so that the assembly never changes.
_END = {"{e}": "(x({E}) - x({C})) / {m}", "{g}": "(y({E}) - y({C})) / {m}"}
_STEPS = {
    # Norton, Design of Machinery, sec. 4.5: E on circles about C and D.
    DyadKind.RRR: {  # closure: RRR
        "d{_}": "sqrt((x({D}) - x({C}))^2 + (y({D}) - y({C}))^2)",
        "f{_}": "({m}^2 - {n}^2 + d{_}^2) / (2 * d{_})",
        "h{_}": "s{_} * sqrt({m}^2 - f{_}^2)",
        "{E}": (
            "{C} + f{_} / d{_} * (x({D}) - x({C}), y({D}) - y({C}))"
            " + h{_} / d{_} * (y({C}) - y({D}), x({D}) - x({C}))"
        ),
        **_END,
    },
    # Sec. 4.6: h from C to the slide, to its left.
    DyadKind.RRP: {  # closure: RRP
        "h{_}": "c{_} - ((y({C}) - y(O2)) * cos(k{_}) - (x({C}) - x(O2)) * sin(k{_}))",
        "f{_}": "s{_} * sqrt({m}^2 - h{_}^2)",
        "{E}": "{C} + f{_} * (cos(k{_}), sin(k{_})) + h{_} * (-sin(k{_}), cos(k{_}))",
        **_END,
    },
    # Sec. 4.7: (f - i c) turned by the rod's angle is D - C.
    DyadKind.RPR: {  # closure: RPR
        "d{_}": "(x({D}) - x({C}))^2 + (y({D}) - y({C}))^2",
        "f{_}": "s{_} * sqrt(d{_} - c{_}^2)",
        "{e}": "((x({D}) - x({C})) * f{_} - (y({D}) - y({C})) * c{_}) / d{_}",
        "{g}": "((y({D}) - y({C})) * f{_} + (x({D}) - x({C})) * c{_}) / d{_}",
        "{E}": "{C} + f{_} * ({e}, {g})",
    },
}
# Directions of their second links.
_SECOND = {
    DyadKind.RRR: ("(x({E}) - x({D})) / {n}", "(y({E}) - y({D})) / {n}"),
    DyadKind.RRP: ("cos(k{_})", "sin(k{_})"),
    DyadKind.RPR: ("-{g}", "{e}"),
}
_SHORT = {"offset": "c", "slide_angle": "k", "assembly": "s"}


def geogebra(model: Model) -> bytes:
    """A worksheet (.ggb) in which the driver is turned by a slider, or by itself once it is animated.

    Parameters
    ----------
    model : Model

    Returns
    -------
    bytes
        The same for the same linkage.

    Examples
    --------
    >>> from grashof.problems import load_linkage_spec
    >>> geogebra(Model.of(load_linkage_spec("engine")))[:2]
    b'PK'
    """
    file = BytesIO()
    with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr(zipfile.ZipInfo("geogebra.xml", _DATE), worksheet(model))
    return file.getvalue()


def worksheet(model: Model) -> str:
    """The text of `geogebra.xml` in it."""
    linkage = model.linkage
    root = ET.Element("geogebra", format="5.0", version="5.0.600.0", app="classic", platform="d")
    root.append(_view(model))
    made = add(root, "construction", title=model.spec.title or model.spec.name, author="", date="")
    _angle(made, model)
    for name, value in _numbers(linkage).items():
        _number(made, name, repr(value))
    for name, pivot in Scene(linkage).ground.items():
        x, y = pivot.tolist()
        _point(made, name.upper(), f"({x!r}, {y!r})", fixed=True)
    for name, formula in _formulas(linkage).items():
        (_point if name.isupper() else _number)(made, name, formula)
    for link in linkage.mechanism.links[1:]:
        for one, other in link.lines:
            _segment(made, link.name, one.upper(), other.upper())
    locus = add(made, "command", name="Locus")
    add(locus, "input", a0="P", a1="t")
    add(locus, "output", a0="path")
    add(add(made, "element", type="locus", label="path"), "show", object="true", label="false")
    ET.indent(root)
    return '<?xml version="1.0" encoding="utf-8"?>\n' + ET.tostring(root, encoding="unicode") + "\n"


def _numbers(linkage: Linkage) -> dict[str, float]:
    """Parameters of the formulas by their short names."""
    found = dict[str, float]()
    for row, value in zip(linkage.mechanism.parameters, linkage.parameters, strict=True):
        name = row.name.removesuffix("_2")
        if row.kind == "arm" and row.name != "coupler_point":
            found |= zip((f"u_{name.upper()}", f"v_{name.upper()}"), value.tolist(), strict=True)
        elif name in _SHORT or row.kind == "length":
            found[_SHORT.get(name, name) + row.name[len(name) :]] = float(value)
    u, v = linkage.coupler_point.tolist()
    return found | {"u": u, "v": v}


def _formulas(linkage: Linkage) -> dict[str, str]:
    """Points, and numbers for them, in an order in which each follows from those before it."""
    kind = linkage.mechanism
    found, turned = {"A": "O2 + r2 * (cos(t), sin(t))"}, {2: ("cos(t)", "sin(t)")}

    def carried(link: int, u: str, v: str) -> str:
        origin, (e, g) = kind.links[link - 1].labels[0], turned[link]
        return f"{origin} + {u} * ({e}, {g}) + {v} * (-{g}, {e})"

    for loop in kind.loops:
        (first, second), ending = loop.links, loop.assembly.removeprefix("assembly")
        c, d, e = loop.c.upper(), loop.d.upper(), loop.e.upper()
        for host, point in zip(loop.dyad.hosts, (c, d), strict=True):
            if host != 1 and point not in found:
                found[point] = carried(host, f"u_{point}", f"v_{point}")
        turned[first] = (f"e_{first}", f"g_{first}") if ending else ("e", "g")
        names = {"C": c, "D": d, "E": e, "m": f"r{first}", "n": f"r{second}", "_": ending}
        names |= zip("eg", turned[first], strict=True)
        for name, formula in _STEPS[loop.dyad.kind].items():
            found[name.format_map(names)] = formula.format_map(names)
        if second == kind.carries or any(second in other.hosts for other in kind.dyads):
            turned[second] = (f"e_{second}", f"g_{second}")
            formulas = (formula.format_map(names) for formula in _SECOND[loop.dyad.kind])
            found |= zip(turned[second], formulas, strict=True)
    return found | {"P": carried(kind.carries, "u", "v")}


def _angle(made: ET.Element, model: Model) -> None:
    """The slider of the driver angle."""
    element = _number(made, "t", repr(model.start), shown=True)
    low, high = repr(model.low), repr(model.high)
    slider = {"width": "300", "x": "30", "y": "40", "fixed": "true", "horizontal": "true"}
    add(element, "slider", min=low, max=high, absoluteScreenLocation="true", **slider)
    to_and_fro, onward = "0", "1"
    way = {"speed": "1", "type": onward if model.turns else to_and_fro, "playing": "false"}
    add(element, "animation", step=repr((model.high - model.low) / 360), **way)
    add(element, "caption", val="driver angle, rad")


def _number(made: ET.Element, name: str, formula: str, *, shown: bool = False) -> ET.Element:
    add(made, "expression", label=name, exp=formula)
    element = add(made, "element", type="numeric", label=name)
    add(element, "show", object=str(shown).lower(), label=str(shown).lower())
    return element


def _point(made: ET.Element, name: str, formula: str, *, fixed: bool = False) -> None:
    add(made, "expression", label=name, exp=formula, type="point")
    element = add(made, "element", type="point", label=name)
    add(element, "show", object="true", label="true")
    add(element, "pointSize", val="4")
    if fixed:
        add(element, "fixed", val="true")


def _segment(made: ET.Element, link: str, one: str, other: str) -> None:
    name = f"{link.replace('-', '')}_{{{one}{other}}}"  # no hyphen in a label
    command = add(made, "command", name="Segment")
    add(command, "input", a0=one, a1=other)
    add(command, "output", a0=name)
    element = add(made, "element", type="segment", label=name)
    add(element, "show", object="true", label="false")
    r, g, b = map(str, _COLOURS.get(link, _GREY))
    add(element, "objColor", r=r, g=g, b=b, alpha="0.0")
    add(element, "lineStyle", thickness="7", type="0")


def _view(model: Model) -> ET.Element:
    """The window: all that moves, at equal scales."""
    state = solve_position(model.linkage, np.linspace(model.low, model.high, 361)[1:-1])
    every = np.concatenate(list(places(model.linkage, state).values()))
    low, high = np.nanmin(every, axis=0), np.nanmax(every, axis=0)
    width, height = _WINDOW
    scale = 0.8 * min(width / (high[0] - low[0]), height / (high[1] - low[1]))
    x, y = width / 2 - scale * (low[0] + high[0]) / 2, height / 2 + scale * (low[1] + high[1]) / 2
    view = ET.Element("euclidianView")
    add(view, "size", width=str(width), height=str(height))
    place = {"xZero": repr(float(x)), "yZero": repr(float(y))}
    add(view, "coordSystem", **place, scale=repr(float(scale)), yscale=repr(float(scale)))
    return view
