"""The first round of four poses: starts in all regions of linkages, and spread over them."""

from __future__ import annotations

import numpy as np

from grashof.synth.programme.start import Round
from grashof.synth.programme.whole_screening import fully_screened
from grashof.synth.proof.poses.atlas import Atlas
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.starts.selection import feasible_starts, scores, starts_of
from grashof.synth.theory.distinct import best_first

MOST_REGIONS = 20  # whose best linkages are begun from
CLOSER = 0.65  # share of the distance at which enough linkages are found: so the list has the better ones
SPREAD = 0.6  # of the best transmission angle: linkages above it are spread over


def round_of_regions(scaled: ScaledProblem, atlas: Atlas, enough: int) -> Round:
    """Starts from the best linkage of each region, then as from any feasible linkages."""
    linkages = fully_screened(scaled, atlas.linkages)
    rows = np.flatnonzero(linkages.feasible)
    order = rows[best_first(scores(scaled, linkages[rows]))]
    _, first = np.unique(atlas.region[order], return_index=True)
    firsts = order[np.sort(first)][:MOST_REGIONS]
    good = rows[linkages.transmission[rows] >= SPREAD * linkages.transmission[rows].max(initial=0.0)]
    starts = starts_of(scaled, linkages, firsts)
    starts += feasible_starts(scaled, linkages[good], enough, peaks=0, closer=CLOSER)
    return Round(starts, {"feasible finds": len(rows)})
