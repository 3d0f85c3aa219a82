from .designs.candidate import Candidate
from .designs.efforts import place_parts
from .pipeline import synthesize
from .proof.claims.proof import Claim, Proof
from .proving import prove
from .results.result import Result
from .search.run import Progress
from .tracking import track

__all__ = ["Candidate", "Claim", "Progress", "Proof", "Result", "place_parts", "prove", "synthesize", "track"]
