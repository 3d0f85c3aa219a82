// Names beside points, where they cover neither each other nor another point.
const LABEL = { high: 13, letter: 7.5, gap: 7 }; // px
const WAYS = Array.from({ length: 8 }, (_, k) => [Math.cos((k * Math.PI) / 4), Math.sin((k * Math.PI) / 4)]);
const FAR = 60; // px²: cost of the side opposite to the wanted one, beside the covered area
const STAYS = 12; // px²: saving of the previous side, so that names do not flicker

class Labels {
  taken;

  constructor(taken = []) {
    this.taken = [...taken];
  }

  // A point that stays free.
  keep(/** @type {number[]} */ [x, y], half = 5) {
    this.taken.push({ x, y, wide: 2 * half, high: 2 * half });
  }

  // The way in which a text covers least, and then is nearest to the one that is wanted.
  beside(/** @type {number[]} */ [x, y], text, /** @type {number[]} */ [right, down], last = null) {
    const wide = LABEL.letter * String(text).length;
    const length = Math.hypot(right, down) || 1;
    const ways = WAYS.map(([wx, wy], way) => {
      const at = { x: x + wx * (LABEL.gap + wide / 2), y: y + wy * (LABEL.gap + LABEL.high / 2), wide, high: LABEL.high };
      const covered = this.taken.reduce((sum, other) => sum + overlap(at, other), 0);
      const cost = covered + (FAR * (1 - (wx * right + wy * down) / length)) / 2 - (way === last ? STAYS : 0);
      return { ...at, way, covered, cost };
    });
    const best = ways.reduce((a, b) => (b.cost < a.cost ? b : a));
    this.taken.push(best);
    return { way: best.way, covered: best.covered, place: { x: px(best.x), y: px(best.y + 4), "text-anchor": "middle" } };
  }
}

// The area that two boxes share.
function overlap(a, b) {
  const wide = (a.wide + b.wide) / 2 - Math.abs(a.x - b.x);
  const high = (a.high + b.high) / 2 - Math.abs(a.y - b.y);
  return wide > 0 && high > 0 ? wide * high : 0;
}
