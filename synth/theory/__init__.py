"""Theory: dyads, cognates, all linkages through nine or eight points."""

from grashof.synth.theory.burmester import Displacements, Dyads, radius_error, trace_four_pose_curves
from grashof.synth.theory.cognates import cognate_points

__all__ = ["Displacements", "Dyads", "cognate_points", "radius_error", "trace_four_pose_curves"]
