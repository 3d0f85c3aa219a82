"""The judge: does a linkage do a task under its requirements? From the linkage alone."""

from grashof.analysis.judge.verdict import Defect, Verdict
from grashof.analysis.judge.verify import verify

__all__ = ["Defect", "Verdict", "verify"]
