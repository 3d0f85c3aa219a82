"""Positions by Newton-Raphson beside the closed form: how many steps it takes, and how far it is off."""

from __future__ import annotations

import numpy as np

from grashof.analysis import newton_position
from grashof.study.samples import Samples
from grashof.study.section import Fact, Section
from grashof.study.study import LinkageStudy

KEY = "newton-raphson"
_OTHER = 1.0  # deg: so far from the closed form the steps have ended on the other assembly


def newton_raphson(study: LinkageStudy) -> Section | None:
    """Both ways at every sample, if that is asked for; each sample starts from a guess of its own."""
    if not study.asked.wants(KEY):
        return None
    samples = Samples.asked(study)
    theta2 = study.joined([state.theta2 for state in samples.states])
    exact = np.degrees([study.joined([getattr(s, f"theta{n}") for s in samples.states]) for n in (3, 4)])
    known = np.isfinite(theta2)
    found = newton_position(study.four_bar, theta2[known])
    solved, steps = np.full(exact.shape, np.nan), np.full(theta2.shape, np.nan)
    solved[:, known], steps[known] = np.degrees([found.theta3, found.theta4]), found.steps
    off = (solved - exact + 180) % 360 - 180
    columns = {
        "theta3_deg": solved[0], "theta4_deg": solved[1], "steps": steps,
        "theta3_closed_deg": exact[0], "theta4_closed_deg": exact[1],
        "theta3_difference_deg": off[0], "theta4_difference_deg": off[1],
    }  # fmt: skip
    apart = np.abs(off).max(axis=0)
    same = apart < _OTHER
    facts = (
        Fact("newton_steps_max", "Newton-Raphson: most steps", int(np.nanmax(steps)) if known.any() else 0),
        Fact(
            "newton_difference_max_deg",
            "Newton-Raphson: largest difference from the closed form",
            float(apart[same].max(initial=0.0)),
            "deg",
        ),
    )
    lines = {"theta3": _unwrapped(solved[0]), "theta4": _unwrapped(solved[1])}
    plots = (
        samples.plot("newton-raphson", "angles by Newton-Raphson", "deg", lines),
        samples.plot("newton-raphson-steps", "Newton-Raphson steps", "", {"steps": steps}),
    )
    missed = int((known & ~same).sum())
    table = samples.table(columns).astype({"steps": int})
    note = "do not converge, or end on the other assembly: near a dead position the two lie close together"
    notes = (f"at {missed} of {int(known.sum())} driver angles the steps {note}",) if missed else ()
    return Section(KEY, "Newton-Raphson", facts, {KEY: table}, plots, notes)


def _unwrapped(angles_deg: np.ndarray) -> np.ndarray:
    """Angles counted on where they are known."""
    unwrapped, known = angles_deg.copy(), np.isfinite(angles_deg)
    unwrapped[known] = np.unwrap(angles_deg[known], period=360)
    return unwrapped
