"""A linkage as a model for other programs: dynamic geometry, simulation, parameters of a sketch."""

from grashof.models.geogebra import geogebra
from grashof.models.linkage_program import linkage2
from grashof.models.model import Model
from grashof.models.mujoco_model import mjcf
from grashof.models.parameters import freecad, solidworks

__all__ = ["Model", "freecad", "geogebra", "linkage2", "mjcf", "solidworks"]
