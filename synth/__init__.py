"""How designs are found: starts, the CasADi programme, Ipopt, verification, ranking."""

from grashof.synth.result import Candidate, Result
from grashof.synth.synthesize import Progress, synthesize

__all__ = ["Candidate", "Progress", "Result", "synthesize"]
