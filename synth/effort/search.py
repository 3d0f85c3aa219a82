"""The best sizes and places of struts and springs: a batched search, then linear programmes from the best."""

from __future__ import annotations

import numpy as np

from grashof.problems.values.arrays import FloatArray, IntArray
from grashof.synth.effort.aim import INSET, Aim, Found
from grashof.synth.theory import minimax
from grashof.synth.theory.stopping import overdue

_DRAWN, _PARENTS, _CHILDREN, _ROUNDS = 3000, 48, 24, 32  # of one part; twice and more of two
_SIZES = 4  # sizes tried at first for each place
_LIKE = 0.05  # share of a stroke: sizes whose excess differs by less count as equal
_FIRST, _NARROWER = 0.3, 0.82  # share of the areas that a step spans, and its factor after each round
_PENALTY = 10.0  # of an excess by a full stroke, in scales of the effort
_COARSE = 3  # steps between samples that suffice to compare
_FINISHED, _BESIDE = 3, 2  # candidates continued by linear programmes, with sizes tried again after each
_MOST, _TRIED = 40, 5  # linear programmes in a row, and their number for comparing sizes
_BLOCK = 2000
_PIECES, _STILL = 3, 1e-6  # convex pieces of polygons one after the other, and shares that justify no other
_GAIN = 1e-6  # share of the scale: least gain that justifies another programme

Pieces = list[tuple[int, FloatArray]]


def best_by_search(aim: Aim, seed: int) -> tuple[FloatArray, IntArray] | None:
    """Unknowns (n,) and sizes (P,) of the least greatest excess; None without enough stroke."""
    rng = np.random.default_rng(seed)
    coarse = aim.thinned(_COARSE)
    x, rows = _drawn(coarse, rng)
    score = _scores(coarse, x, rows)
    best = np.argsort(score, kind="stable")
    many = len(aim.parts) ** 2  # two parts have many more optima
    best = best[_apart(x[best], rows[best], _PARENTS * len(aim.parts))]
    x, rows, _ = _closed_in(coarse, x[best], rows[best], score[best], rng)
    kept = _apart(x, rows, _FINISHED * many)
    found = [_finished(aim, x[k], rows[k], _BESIDE * many) for k in kept if not overdue()] or [
        (x[0], rows[0])
    ]
    judged = aim.at(np.array([each for each, _ in found]), np.array([each for _, each in found]))
    kept_strokes = judged.margins.reshape(len(found), -1).min(axis=1, initial=0.0) >= -INSET / 2
    excess = np.where(kept_strokes, judged.excess.max(axis=1), np.inf)
    first = int(excess.argmin())
    return found[first] if kept_strokes[first] else None


def _drawn(aim: Aim, rng: np.random.Generator) -> tuple[FloatArray, IntArray]:
    """Random places, and for each part sizes whose strokes suit them best, with any force."""
    x = np.repeat(aim.inside(rng.random((_DRAWN * len(aim.parts), aim.unknowns))), _SIZES, axis=0)
    rows = np.empty((len(x), len(aim.parts)), dtype=np.intp)
    for number, part in enumerate(aim.parts):
        length, _ = aim.lengths(number, x[::_SIZES])
        low, high = length.min(axis=1, keepdims=True), length.max(axis=1, keepdims=True)
        stroke = part.longest - part.shortest
        past = np.maximum(part.shortest - low, 0) / stroke + np.maximum(high - part.longest, 0) / stroke
        for k in range(_SIZES):
            rows[k::_SIZES, number] = (past + _LIKE * rng.random(past.shape)).argmin(axis=1)
    return x, rows


def _score(aim: Aim, found: Found) -> FloatArray:
    past = np.maximum(-found.margins, 0.0).reshape(len(found.margins), -1).max(axis=1, initial=0.0)
    return np.asarray(found.excess.max(axis=1) / aim.scale + _PENALTY * past)


def _scores(aim: Aim, x: FloatArray, rows: IntArray) -> FloatArray:
    """The greatest excess of candidates in scales of the effort, with a penalty beyond their strokes."""
    blocks = range(0, len(x), _BLOCK)
    return np.concatenate([_score(aim, aim.at(x[k : k + _BLOCK], rows[k : k + _BLOCK])) for k in blocks])


def _closed_in(
    aim: Aim, x: FloatArray, rows: IntArray, score: FloatArray, rng: np.random.Generator
) -> tuple[FloatArray, IntArray, FloatArray]:
    """Ever smaller random steps from each candidate, some with another size; best first."""
    step, parents, counts = _FIRST, np.arange(len(x)), [len(part.force) for part in aim.parts]
    for _ in range(_ROUNDS):
        shape = (len(x), _CHILDREN, x.shape[1])
        moved = rng.random(shape) < rng.random((*shape[:2], 1))
        tried = aim.inside(np.clip(x[:, None] + step * moved * rng.standard_normal(shape), 0, 1))
        sizes = np.repeat(rows[:, None], _CHILDREN, axis=1)
        beside = np.rint(3 * rng.standard_normal(sizes.shape)).astype(np.intp)
        anew = np.stack([rng.integers(count, size=shape[:2]) for count in counts], axis=-1)
        how = rng.random(sizes.shape)
        sizes = np.where(how < 0.15, anew, np.where(how < 0.5, sizes + beside, sizes))
        sizes = np.clip(sizes, 0, np.array(counts) - 1)
        found = _scores(aim, tried.reshape(-1, shape[2]), sizes.reshape(-1, len(counts))).reshape(shape[:2])
        child = found.argmin(axis=1)
        better = found[parents, child] < score
        x = np.where(better[:, None], tried[parents, child], x)
        rows = np.where(better[:, None], sizes[parents, child], rows)
        score = np.where(better, found[parents, child], score)
        step *= _NARROWER
    order = np.argsort(score, kind="stable")
    return x[order], rows[order], score[order]


def _apart(x: FloatArray, rows: IntArray, most: int, least: float = 0.05) -> list[int]:
    """At most `most` candidates, each with other sizes than every better one, or far enough from it."""
    kept: list[int] = []
    for k in range(len(x)):
        near = (np.abs(x[kept] - x[k]).max(axis=1, initial=0.0) < least) & (rows[kept] == rows[k]).all(axis=1)
        if not near.any():
            kept.append(k)
        if len(kept) == most:
            break
    return kept


def _finished(aim: Aim, x: FloatArray, rows: IntArray, most: int) -> tuple[FloatArray, IntArray]:
    """A candidate at its least greatest excess, also with the other sizes that suit its places best."""
    best = _polished(aim, x, rows)
    score = float(_scores(aim, best[None], rows[None])[0])
    for _ in range(most):
        others = [each for each in _best_sizes(aim, best, rows, 3) if (each != rows).any()]
        tried = [(_polished(aim, best, each, _TRIED), each) for each in others if not overdue()]
        if not tried:
            break
        scores = _scores(aim, np.array([each for each, _ in tried]), np.array([each for _, each in tried]))
        first = int(scores.argmin())
        if scores[first] > score - _GAIN:
            break
        rows = tried[first][1]
        best = _polished(aim, *tried[first])
        score = float(_scores(aim, best[None], rows[None])[0])
    return best, rows


def _best_sizes(aim: Aim, x: FloatArray, rows: IntArray, count: int) -> list[IntArray]:
    """The best combinations at given places with one size changed; strokes may be exceeded a little."""
    found = []
    for number, part in enumerate(aim.parts):
        every = np.tile(rows, (len(part.force), 1))
        every[:, number] = np.arange(len(part.force))
        known = [
            tuple(np.broadcast_to(y, (len(every), y.shape[1])) for y in aim.lengths(k, x[None]))
            for k in range(len(aim.parts))
        ]
        scores = _score(aim, aim.of_lengths([(a, b) for a, b in known], every))
        found += [every[k] for k in np.argsort(scores, kind="stable")[: count + 1]]
    return found


def _polished(aim: Aim, x: FloatArray, rows: IntArray, rounds: int = _MOST) -> FloatArray:
    """Places of least greatest excess for given sizes; in polygons through convex pieces in turn."""
    for _ in range(_PIECES):
        pieces, whole = _pieces(aim, x)

        def values(z: FloatArray, pieces: Pieces = pieces) -> tuple[FloatArray, FloatArray]:
            found = aim.at(z, np.broadcast_to(rows, (len(z), len(rows))))
            excess = found.excess / aim.scale
            inside = [z[:, k : k + 2] @ planes[:, :2].T - planes[:, 2] for k, planes in pieces]
            margins = np.concatenate([found.margins.reshape(len(z), -1), *inside], axis=1)
            return np.where(np.isfinite(excess), excess, -1e3), margins

        before, x = x, aim.inside(minimax.by_linear(values, x, np.zeros(len(x)), np.ones(len(x)), rounds))
        if whole or np.abs(x - before).max() < _STILL:
            break
    return x


def _pieces(aim: Aim, x: FloatArray) -> tuple[Pieces, bool]:
    """Half-planes of the convex pieces about ends in polygons; and whether these are the entire polygons."""
    if not aim.polygons:
        return [], True
    # Here, not above: shapely takes a while to import, and few struts have polygons.
    from grashof.synth.quantities.convex import is_convex, piece_about

    found = [
        (first, piece_about(region, complex(x[first], x[first + 1]), len(region.corners)))
        for first, region in aim.polygons
    ]
    return found, all(is_convex(region) for _, region in aim.polygons)
