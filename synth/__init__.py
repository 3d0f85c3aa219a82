"""How designs are found: starts, the CasADi programme, Ipopt, verification, ranking."""

from grashof.synth.designs.candidate import Candidate
from grashof.synth.designs.efforts import place_parts
from grashof.synth.proof.claims.proof import Claim, Proof
from grashof.synth.prove import prove
from grashof.synth.results.result import Result
from grashof.synth.search.run import Progress
from grashof.synth.synthesize import synthesize
from grashof.synth.track import track

__all__ = [
    "Candidate",
    "Claim",
    "Progress",
    "Proof",
    "Result",
    "place_parts",
    "prove",
    "synthesize",
    "track",
]
