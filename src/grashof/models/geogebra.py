"""A linkage as a GeoGebra worksheet: a slider for the driver angle, the links, the locus of P."""

from __future__ import annotations

import xml.etree.ElementTree as ET
import zipfile
from io import BytesIO

import numpy as np

from grashof.analysis import solve_position
from grashof.models.model import Model
from grashof.models.xml import add
from grashof.problems import FourBar, InvertedSliderCrank, Linkage, SliderCrank

_DATE = (1980, 1, 1, 0, 0, 0)  # the same linkage gives the same bytes
_WINDOW = (600, 450)  # pixels
_COLOURS = {"driver": (78, 120, 168), "coupler": (242, 142, 43), "output": (89, 161, 79)}
_GREY = 120, 120, 120

# Points and numbers, each after those that it depends on, as GeoGebra writes formulas. Left of (x, y)
# is (-y, x). In closed form, so that the assembly never changes.
_CRANK = {"A": "O2 + r2 * (cos(t), sin(t))"}
_STEPS: dict[type[Linkage], dict[str, str]] = {
    # Norton, Design of Machinery, sec. 4.5: B on circles about A and O4.
    FourBar: {  # closure: RRR
        **_CRANK,
        "d": "sqrt((x(O4) - x(A))^2 + (y(O4) - y(A))^2)",
        "f": "(r3^2 - r4^2 + d^2) / (2 * d)",
        "h": "s * sqrt(r3^2 - f^2)",
        "B": "A + f / d * (x(O4) - x(A), y(O4) - y(A)) + h / d * (y(A) - y(O4), x(O4) - x(A))",
        "e": "(x(B) - x(A)) / r3",
        "g": "(y(B) - y(A)) / r3",
    },
    # Sec. 4.6: h from A to the slide, to its left.
    SliderCrank: {  # closure: RRP
        **_CRANK,
        "h": "c - ((y(A) - y(O2)) * cos(k) - (x(A) - x(O2)) * sin(k))",
        "f": "s * sqrt(r3^2 - h^2)",
        "B": "A + f * (cos(k), sin(k)) + h * (-sin(k), cos(k))",
        "e": "(x(B) - x(A)) / r3",
        "g": "(y(B) - y(A)) / r3",
    },
    # Sec. 4.7: (f - i c) turned by the rod's angle is O4 - A.
    InvertedSliderCrank: {  # closure: RPR
        **_CRANK,
        "d": "(x(O4) - x(A))^2 + (y(O4) - y(A))^2",
        "f": "s * sqrt(d - c^2)",
        "e": "((x(O4) - x(A)) * f - (y(O4) - y(A)) * c) / d",
        "g": "((y(O4) - y(A)) * f + (x(O4) - x(A)) * c) / d",
        "B": "A + f * (e, g)",
    },
}
_P = "A + u * (e, g) + v * (-g, e)"


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
    for name in linkage.mechanism.ground:
        x, y = getattr(linkage, name).tolist()
        _point(made, name.upper(), f"({x!r}, {y!r})", fixed=True)
    for name, formula in _STEPS[type(linkage)].items():
        (_point if name.isupper() else _number)(made, name, formula)
    _point(made, "P", _P)
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
    """What the formulas need by their short names."""
    names = {"r2": "r2", "r3": "r3", "r4": "r4", "c": "offset", "k": "slide_angle", "s": "assembly"}
    found = {short: float(getattr(linkage, name)) for short, name in names.items() if hasattr(linkage, name)}
    u, v = linkage.coupler_point.tolist()
    return found | {"u": u, "v": v}


def _angle(made: ET.Element, model: Model) -> None:
    """The slider of the driver angle."""
    element = _number(made, "t", repr(model.start), shown=True)
    low, high = repr(model.low), repr(model.high)
    slider = {"width": "300", "x": "30", "y": "40", "fixed": "true", "horizontal": "true"}
    add(element, "slider", min=low, max=high, absoluteScreenLocation="true", **slider)
    to_and_fro, onward = "0", "1"
    step = repr((model.high - model.low) / 360)
    add(
        element,
        "animation",
        step=step,
        speed="1",
        type=onward if model.turns else to_and_fro,
        playing="false",
    )
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
    name = f"{link}_{{{one}{other}}}"
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
    moving = [getattr(state, name) for name in model.linkage.mechanism.moving]
    fixed = [getattr(model.linkage, name)[None] for name in model.linkage.mechanism.ground]
    every = np.concatenate([*moving, *fixed])
    low, high = np.nanmin(every, axis=0), np.nanmax(every, axis=0)
    width, height = _WINDOW
    scale = 0.8 * min(width / (high[0] - low[0]), height / (high[1] - low[1]))
    x, y = width / 2 - scale * (low[0] + high[0]) / 2, height / 2 + scale * (low[1] + high[1]) / 2
    view = ET.Element("euclidianView")
    add(view, "size", width=str(width), height=str(height))
    place = {"xZero": repr(float(x)), "yZero": repr(float(y))}
    add(view, "coordSystem", **place, scale=repr(float(scale)), yscale=repr(float(scale)))
    return view
