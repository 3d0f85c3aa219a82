"""What programmes of many targets need besides: a Jacobian in blocks, and an end when asked to stop."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import casadi as ca
import numpy as np

from grashof.synth.theory.stopping import overdue

FULL = 64  # unknowns: a row that depends on more of them is a full one
STOPPED = "User_Requested_Stop"  # Ipopt's return status


def jacobian_by_rows(stated: Mapping[str, ca.SX]) -> ca.Function:
    """The rows ``g`` of a programme and their derivative by the unknowns ``x``, as Ipopt takes them."""
    x, p, g = (stated[name] for name in "xpg")
    row, _ = ca.jacobian_sparsity(g, x).get_triplet()
    # Unknowns that every target depends on and rows that depend on every target leave no two columns, and no
    # two rows, that can be differentiated together: all at once take time with the square of the targets. So
    # the few full rows are differentiated by themselves.
    full = np.bincount(np.array(row, dtype=np.int64), minlength=g.numel()) > FULL
    blocks = [np.flatnonzero(~full).tolist(), np.flatnonzero(full).tolist()]
    slope = ca.vertcat(*(ca.jacobian(g[rows], x) for rows in blocks))
    back = np.argsort(np.concatenate(blocks), kind="stable").astype(int).tolist()
    return ca.Function("nlp_jac_g", [x, p], [g, slope[back, :]], ["x", "p"], ["g", "jac_g_x"])


class StopCondition(ca.Callback):
    """Called after every iteration of Ipopt: whether to end it, since that is overdue."""

    def __init__(self, stated: Mapping[str, ca.SX]) -> None:
        ca.Callback.__init__(self)
        counts = {name: stated[name].numel() for name in "xpg"}
        self._sizes = {"f": 1} | {of + name: count for name, count in counts.items() for of in ("", "lam_")}
        self.ended = False
        self.construct("asking", {})

    def get_n_in(self) -> int:
        """As many as a solve has results."""
        return int(ca.nlpsol_n_out())

    def get_n_out(self) -> int:
        """One: whether to end."""
        return 1

    def get_sparsity_in(self, place: int) -> ca.Sparsity:
        """Each result is a column."""
        return ca.Sparsity.dense(self._sizes[ca.nlpsol_out(place)], 1)

    def has_eval_buffer(self) -> bool:
        """Results are not copied for each call."""
        return True

    def eval_buffer(self, _given: Sequence[Any], answer: Sequence[Any]) -> int:
        """Answer 1 to end."""
        self.ended = overdue()
        memoryview(answer[0]).cast("b").cast("d")[0] = float(self.ended)
        return 0

    def ended_by_another(self, status: str) -> bool:
        """Whether a solve was ended by what interrupted this call, which CasADi keeps to itself."""
        return status == STOPPED and not self.ended
