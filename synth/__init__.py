"""How designs are found: starts, the CasADi programme, Ipopt, verification, ranking."""

from grashof.synth.designs.candidate import Candidate
from grashof.synth.results.result import Result
from grashof.synth.search.run import Progress
from grashof.synth.synthesize import synthesize

__all__ = ["Candidate", "Progress", "Result", "synthesize"]
