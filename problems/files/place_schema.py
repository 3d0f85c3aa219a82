"""Places of problem files: an upright rectangle, a polygon, a line segment, or a point."""

from __future__ import annotations

from typing import Annotated, Any, ClassVar

from pydantic import AfterValidator, Tag, field_validator
from pydantic_core import PydanticCustomError

from grashof.problems.files import tables
from grashof.problems.files.task_schema import Corners, Drawn, Pair
from grashof.problems.values.box import Box
from grashof.problems.values.region import Region, place

_SIDES = {"x": (Pair | None, None), "y": (Pair | None, None)}
_CORNERS = {"inside": (Drawn | None, None), "on": (Corners | None, None)}


@tables.keys_of(Box, _SIDES | _CORNERS, [*_SIDES, *_CORNERS])
class BoxTable(tables.SpecTable):
    """Where a joint may be: an upright rectangle whose sides may be open, a polygon, or a line segment."""

    suggested: ClassVar[bool] = False  # x and y do not show where they belong
    described_by: ClassVar[tuple[type, ...]] = (Region,)

    @field_validator("x", "y", mode="before", check_fields=False)
    @classmethod
    def _line(cls, given: Any) -> Any:
        """A single number is a side of no width."""
        return [given, given] if tables.tag(given) == tables.NUMBER else given

    @classmethod
    def make(cls, **given: Any) -> Box:
        return place(**given)


def _at(point: list[float]) -> Box:
    """The box of a single point."""
    if len(point) != 2:
        raise PydanticCustomError(tables.WRONG, _PLACE_SHAPES)
    x, y = point
    return Box((x, x), (y, y))


_PLACE_SHAPES = "[x, y], { x = [lo, hi], y = [lo, hi] }, { inside = corners } or { on = ends }"
Place = Annotated[
    Annotated[BoxTable, AfterValidator(BoxTable.value), Tag(tables.TABLE)]
    | Annotated[list[float], AfterValidator(_at), Tag(tables.LIST), tables.TWO],
    tables.either(_PLACE_SHAPES),
]
