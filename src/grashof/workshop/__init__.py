"""From a linkage to its parts: plates to cut, the layers they lie on, drawings and spreadsheets."""

from grashof.workshop.export import write_dxf, write_svg, write_xlsx
from grashof.workshop.plan import Part, Plan, plan_parts
from grashof.workshop.plates import Plate, PlateSizes
from grashof.workshop.stacking import Pin

__all__ = ["Part", "Pin", "Plan", "Plate", "PlateSizes", "plan_parts", "write_dxf", "write_svg", "write_xlsx"]
