"""The drawing, whatever the file: parts side by side for cutting, the assembly, and the parts list."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np
import shapely

from grashof.problems.values.arrays import FloatArray
from grashof.workshop.plan import Part, Plan
from grashof.workshop.plates import Plate, outline
from grashof.workshop.stacking import placed

CUT, ENGRAVE, PINS, NOTES = "CUT", "ENGRAVE", "ASSEMBLY_PINS", "NOTES"
_TITLE_LENGTH = 80


@dataclass(frozen=True, slots=True, eq=False)
class Outline:
    """A closed line of straight parts and arcs: x, y (mm) and bulge of each vertex, shape (k, 3)."""

    layer: str
    vertices: FloatArray


@dataclass(frozen=True, slots=True)
class Circle:
    """A circle; lengths in mm."""

    layer: str
    x: float
    y: float
    radius: float


@dataclass(frozen=True, slots=True)
class Text:
    """A line of text, at its left end or about its centre; lengths in mm, angle in rad."""

    layer: str
    x: float
    y: float
    height: float
    words: str
    angle: float = 0.0
    centred: bool = False


Shape = Outline | Circle | Text


@dataclass(frozen=True, slots=True)
class Sheet:
    """A drawing in mm, x to the right, y up, from the origin to (width, height), mm.

    Layers: `CUT`, `ENGRAVE`, `ASSEMBLY_0` and so on from the base up, `ASSEMBLY_PINS`, `NOTES`.
    """

    title: str
    shapes: tuple[Shape, ...]
    layers: tuple[str, ...]
    width: float
    height: float


def sheet(plan: Plan, title: str = "") -> Sheet:
    """A plan as parts in a column, the assembly to their right, the list below under the printable title."""
    title = printable(title)[:_TITLE_LENGTH]
    gap = plan.sizes.width / 2
    cut, size = _column(plan, gap)
    assembly, assembly_size = _assembly(plan)
    beside = size[0] + 4 * gap
    width, height = beside + assembly_size[0], max(size[1], assembly_size[1])
    text = max(gap / 2, np.hypot(width, height) / 150)
    notes, notes_size = _notes(plan, title, float(text))
    up = notes_size[1] + 2 * gap
    shapes = [*_moved(cut, 0, up), *_moved(assembly, beside, up), *_moved(notes, 0, 0)]
    levels = tuple(f"ASSEMBLY_{layer}" for layer in range(plan.layers))
    return Sheet(
        title,
        tuple(_moved(shapes, gap, gap)),
        (CUT, ENGRAVE, *levels, PINS, NOTES),
        float(max(width, notes_size[0]) + 2 * gap),
        float(up + height + 2 * gap),
    )


def printable(text: str) -> str:
    r"""A text in one line, without unprintable characters.

    >>> printable("Two\n lines\x07")
    'Two lines'
    """
    return "".join(sign for sign in " ".join(text.split()) if sign.isprintable())


def _column(plan: Plan, gap: float) -> tuple[list[Shape], tuple[float, float]]:
    """Every copy of every part, from the bottom up, to cut and engrave; and the size of the column."""
    shapes: list[Shape] = []
    widest, top = 0.0, 0.0
    for part in reversed(plan.parts):
        low, high = part.plate.corners.min(axis=0), part.plate.corners.max(axis=0)
        wide, tall = high - low + part.plate.width
        to_corner = part.plate.width / 2 - low
        rings = len(part.plate.corners) == 1
        for copy in range(len(part.layers)):
            x, y = (copy * (wide + gap), 0.0) if rings else (0.0, copy * (tall + gap))
            shapes += _moved(_part(part, plan.sizes.thickness), x + to_corner[0], top + y + to_corner[1])
        across, upward = (len(part.layers), 1) if rings else (1, len(part.layers))
        widest = max(widest, across * (wide + gap) - gap)
        top += upward * (tall + gap)
    return shapes, (float(widest), float(top - gap))


def _part(part: Part, thickness: float) -> list[Shape]:
    plate = part.plate
    shapes = list(_drawn(plate, CUT, np.zeros(3)))
    words = f"{plate.name} {'-'.join(plate.joints)} t{thickness:g}"
    if len(plate.corners) > 1:
        middle, angle, room = _room(plate)
        height = min(plate.width / 5, room / len(words))
        if height >= plate.width / 20:  # smaller text is illegible
            x, y = middle.tolist()
            shapes.append(Text(ENGRAVE, x, y, height, words, angle, centred=True))
    return shapes


def _drawn(plate: Plate, layer: str, place: FloatArray) -> Iterator[Shape]:
    """Outline, holes and slots of a plate that is in a place, shape (3,), mm, mm and rad."""

    def line(vertices: FloatArray) -> Outline:
        return Outline(layer, np.column_stack([placed(vertices[:, :2], place), vertices[:, 2]]))

    yield line(plate.outline)
    for x, y in placed(plate.holes, place):
        yield Circle(layer, float(x), float(y), plate.hole / 2)
    for _, ends in plate.slots:
        yield line(outline(ends, plate.hole / 2))


def _room(plate: Plate) -> tuple[FloatArray, float, float]:
    """Where a plate's name fits: the middle of the longest gap between its holes, its angle and length."""
    spots = np.concatenate([plate.holes, *(ends for _, ends in plate.slots)])
    slots = [shapely.linestrings(ends) for _, ends in plate.slots]

    def length(pair: tuple[int, int]) -> float:
        (start, end), others = spots[list(pair)], np.delete(spots, pair, axis=0)
        long = float(np.hypot(*(end - start)))
        along = (end - start) / long
        offset = others - start
        beside = np.abs(offset[:, 1] * along[0] - offset[:, 0] * along[1])
        between = (offset @ along > 0) & ((offset - (end - start)) @ along < 0)
        blocked = bool((between & (beside < plate.hole)).any())
        if slots and long > 2 * plate.hole:
            line = shapely.linestrings([start + plate.hole * along, end - plate.hole * along])
            blocked |= any(shapely.distance(line, slot) < 0.99 * plate.hole for slot in slots)
        return 0.0 if blocked else long

    pair = max(combinations(range(len(spots)), 2), key=length)
    start, end = sorted(spots[list(pair)].tolist())
    angle = float(np.arctan2(end[1] - start[1], end[0] - start[0]))
    return (np.array(start) + end) / 2, angle, length(pair) - 2 * plate.hole


def _assembly(plan: Plan) -> tuple[list[Shape], tuple[float, float]]:
    """The parts in place, each on the drawing layer of its level, and the size of the assembly."""
    shapes: list[Shape] = []
    corners = []
    for part in plan.parts:
        for level, place in zip(part.layers, part.places, strict=True):
            shapes += _drawn(part.plate, f"ASSEMBLY_{level}", place)
            reach = part.plate.width / 2
            at = placed(part.plate.corners, place)
            corners += [at - reach, at + reach]
    height, pins = plan.sizes.width / 4, {pin.name for pin in plan.pins}
    for name, (x, y) in plan.joints.items():
        if name in pins:
            shapes.append(Circle(PINS, x, y, plan.sizes.hole / 2))
        shapes.append(Text(NOTES, x + plan.sizes.width / 2, y + plan.sizes.width / 2, height, name))
    low, high = (extreme(np.concatenate(corners), axis=0) for extreme in (np.min, np.max))
    room = plan.sizes.width  # for names of joints at the edge
    shapes = list(_moved(shapes, -low[0], -low[1]))
    return shapes, (float(high[0] - low[0] + room), float(high[1] - low[1] + room))


def _notes(plan: Plan, title: str, height: float) -> tuple[list[Shape], tuple[float, float]]:
    """Title, assembly, notes and parts list; the last line at y = 0."""
    rows = plan.rows()
    heading = [
        title,
        f"Assembly at theta2 = {np.degrees(plan.theta2):.4g} deg, layer 0 (the base) farthest from the eye",
        *plan.notes,
    ]
    lines = [line for line in heading if line]
    pitch, character = 1.8 * height, 0.9 * height
    columns = [max(len(row[i]) for row in rows) for i in range(len(rows[0]))]
    starts = np.cumsum([0, *(width + 2 for width in columns)]) * character
    top = (len(lines) + len(rows) - 1) * pitch
    shapes: list[Shape] = [Text(NOTES, 0, top - i * pitch, height, line) for i, line in enumerate(lines)]
    for i, row in enumerate(rows, start=len(lines)):
        shapes += [
            Text(NOTES, float(x), top - i * pitch, height, cell) for x, cell in zip(starts, row, strict=False)
        ]
    widest = max(float(starts[-1]), max(map(len, lines)) * character)
    return shapes, (widest, top + height)


def _moved(shapes: list[Shape], x: float, y: float) -> Iterator[Shape]:
    for shape in shapes:
        if isinstance(shape, Outline):
            yield Outline(shape.layer, shape.vertices + np.array([x, y, 0.0]))
        else:
            yield replace(shape, x=shape.x + float(x), y=shape.y + float(y))
