"""Draw the symbols of a linkage: u and v, the angles, mu, and the frame of the body."""

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Arc

from grashof.analysis import solve_position
from grashof.problems import FourBar, SliderCrank

FOUR_BAR = FourBar((0, 0), (4.2, -0.4), 1.6, 4.0, 2.9, (2.2, 1.5), body_angle=np.radians(35))
SLIDER_CRANK = SliderCrank((0, 0), 1.5, 3.6, 0.7, np.radians(-8), (1.7, 0.9))
LINK, THIN, FRAME, ANGLE = "0.25", "0.6", "tab:blue", "tab:red"


def unit(angle: float) -> complex:
    """A direction."""
    return complex(np.exp(1j * angle))


def line(axes: Axes, *points: complex, **style: Any) -> None:
    """A line through points."""
    axes.plot([p.real for p in points], [p.imag for p in points], **{"color": LINK, "lw": 3, **style})


def arrow(axes: Axes, start: complex, end: complex, name: str, color: str = FRAME) -> None:
    """An arrow with a name at its tip."""
    axes.annotate(
        "", (end.real, end.imag), (start.real, start.imag),
        arrowprops={"arrowstyle": "->", "color": color, "lw": 1.4, "shrinkA": 0, "shrinkB": 0},
    )  # fmt: skip
    tip = end + 0.2 * (end - start) / abs(end - start)
    axes.text(tip.real, tip.imag, name, color=color, ha="center", va="center")


def angle(axes: Axes, at: complex, low: float, high: float, name: str, radius: float = 0.6) -> None:
    """An arc from one direction on to another, with its name."""
    turned = (high - low) % (2 * np.pi)
    ends = np.degrees([low, low + turned])
    wide = 2 * radius
    axes.add_patch(Arc((at.real, at.imag), wide, wide, theta1=ends[0], theta2=ends[1], color=ANGLE))
    middle = at + (radius + 0.22) * unit(low + turned / 2)
    beside = "center" if len(name) < 3 else "left"
    axes.text(middle.real, middle.imag, name, color=ANGLE, ha=beside, va="center")


def joint(axes: Axes, at: complex, name: str, aside: complex) -> None:
    """A pivot with its name."""
    axes.plot(at.real, at.imag, "o", color="white", mec=LINK, mew=1.6, ms=8, zorder=3)
    axes.text((at + aside).real, (at + aside).imag, name, ha="center", va="center", weight="bold")


def across(axes: Axes, start: complex, end: complex, name: str, aside: float = 0.17) -> None:
    """A dimension between two points, with its name beside the middle."""
    axes.annotate(
        "", (end.real, end.imag), (start.real, start.imag),
        arrowprops={"arrowstyle": "<->", "color": FRAME, "shrinkA": 0, "shrinkB": 0},
    )  # fmt: skip
    beside = (start + end) / 2 + aside * 1j * (end - start) / abs(end - start)
    axes.text(beside.real, beside.imag, name, color=FRAME, ha="center", va="center")


def moving(axes: Axes, linkage: FourBar | SliderCrank, theta2: float) -> tuple[complex, ...]:
    """Draw links 2 and 3 with theta2, u and v; O2, A, B, P and the direction of the coupler."""
    o2, along = complex(*linkage.o2), unit(float(solve_position(linkage, theta2).theta3))
    a = o2 + float(linkage.r2) * unit(theta2)
    b, (u, v) = a + float(linkage.r3) * along, map(float, linkage.coupler_point)
    foot, p = a + u * along, a + complex(u, v) * along
    for start in (o2, a):
        line(axes, start, start + 0.95, color=THIN, lw=0.8, ls=":")
    line(axes, o2, a)
    line(axes, a, b, p, a, lw=2)
    across(axes, foot - 0.22j * along, a - 0.22j * along, "u")
    across(axes, foot, p, "v")
    angle(axes, o2, 0, theta2, "θ2")
    for place, name, aside in ((o2, "O2", -0.3j), (a, "A", -0.35)):
        joint(axes, place, name, aside)
    return o2, a, b, p, along


def four_bar(axes: Axes) -> None:
    """The four-bar: angles from +x, P in the frame of the coupler, the body about P."""
    linkage, theta2 = FOUR_BAR, np.radians(70.0)
    o2, a, b, p, along = moving(axes, linkage, theta2)
    o4, theta3, body = complex(*linkage.o4), float(np.angle(along)), float(linkage.body_angle)
    theta4 = float(np.angle(b - o4))
    for start in (o4, p):
        line(axes, start, start + 0.95, color=THIN, lw=0.8, ls=":")
    line(axes, o4, b)
    line(axes, o2, o4, color=THIN, lw=1)
    arrow(axes, p, p + 1.2 * along * unit(body), "body")
    arrow(axes, p, p + 1.2j * along * unit(body), "")
    line(axes, p, p + along, color=THIN, lw=0.8, ls="--")
    angle(axes, p, theta3, theta3 + body, "body_angle", 0.7)
    angle(axes, a, 0, theta3, "θ3", 0.75)
    angle(axes, o4, 0, theta4, "θ4")
    angle(axes, b, theta3 + np.pi, theta4 + np.pi, "μ", 0.5)
    for place, name, aside in ((b, "B", 0.35), (o4, "O4", -0.3j), (p, "P", -0.1 + 0.32j)):
        joint(axes, place, name, aside)


def slider_crank(axes: Axes) -> None:
    """The slider-crank: the slide's direction e, its offset from O2, and mu at B."""
    linkage, theta2 = SLIDER_CRANK, np.radians(65.0)
    o2, a, b, p, along = moving(axes, linkage, theta2)
    theta3, e = float(np.angle(along)), float(linkage.slide_angle)
    over = o2 + float(linkage.offset) * unit(e + np.pi / 2)
    line(axes, over - 0.6 * unit(e), b + 1.2 * unit(e), color=THIN, lw=1, ls="-.", zorder=1)
    line(axes, b - 0.35 * unit(e), b + 0.35 * unit(e), lw=12, color="0.85", solid_capstyle="butt", zorder=1)
    line(axes, b, b + 0.9 * unit(e + np.pi / 2), color=THIN, lw=0.8, ls="--")
    across(axes, o2, over, "offset", 0.32)
    arrow(axes, b + 0.5 * unit(e), b + 1.2 * unit(e), "e")
    angle(axes, a, theta3, 0, "θ3", 0.75)
    angle(axes, b, e + np.pi / 2, theta3 + np.pi, "μ", 0.5)
    for place, name, aside in ((b, "B", -0.35j), (p, "P", 0.3j)):
        joint(axes, place, name, aside)


def symbols() -> Figure:
    """Both, side by side."""
    figure = Figure(figsize=(10.5, 4.4), layout="constrained")
    for axes, draw in zip(figure.subplots(1, 2), (four_bar, slider_crank), strict=True):
        draw(axes)
        axes.set_aspect("equal")
        axes.axis("off")
        axes.margins(0.12)
        axes.set_title(draw.__name__.replace("_", "-"), y=-0.12)
    return figure
