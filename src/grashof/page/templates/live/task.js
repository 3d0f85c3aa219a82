// The task of a live page as its problem file: changes by hand, undo and redo.
const HISTORY = 200; // steps back, at most
const REGIONS = ["o2", "o4", "d", "a", "b"];
const FEWEST = { motion: 2, path: 3 };

class Task {
  name; onChange;

  constructor({ onChange }) {
    Object.assign(this, { onChange, document: {}, name: "task", past: [], future: [], before: null });
    this.locked = new Set(); // names of handles that stay where they are
  }

  open(document, name) {
    Object.assign(this, { document, name, past: [], future: [], before: null });
    this.locked.clear();
    this.onChange({ opened: true });
  }

  get kind() {
    return this.document.kind;
  }

  // The list of targets in the file; null where they have no place, as of functions.
  get list() {
    const table = this.document[this.kind] || {};
    return table.poses || table.points || null;
  }

  get closes() {
    const { list } = this;
    return this.kind === "path" && list.length > 3 && String(list[0]) === String(list.at(-1));
  }

  // { x, y, angle } of each target, angle in deg; null where the file leaves it free.
  get targets() {
    return (this.list || []).map((row) => {
      if (!Array.isArray(row)) return { x: row.x ?? null, y: row.y ?? null, angle: row.angle ?? null };
      return { x: row[0], y: row[1], angle: row.length > 2 ? row[2] : null };
    });
  }

  // One step that can be undone: all changes until `end`.
  begin() {
    if (this.before === null) this.before = JSON.stringify(this.document);
  }

  change(edit) {
    edit(this.document);
    this.onChange({});
  }

  end() {
    if (this.before !== null && this.before !== JSON.stringify(this.document)) {
      this.past = [...this.past, this.before].slice(-HISTORY);
      this.future = [];
    }
    this.before = null;
    this.onChange({ rest: true });
  }

  edit(edit) {
    this.begin();
    this.change(edit);
    this.end();
  }

  undo() {
    this.travel(this.past, this.future);
  }

  redo() {
    this.travel(this.future, this.past);
  }

  travel(from, to) {
    if (!from.length) return;
    to.push(JSON.stringify(this.document));
    this.document = JSON.parse(from.pop());
    this.onChange({ rest: true, opened: true });
  }

  setTarget(k, given) {
    const { list, closes } = this;
    const row = list[k];
    if (Array.isArray(row)) {
      for (const [n, name] of ["x", "y", "angle"].entries()) if (name in given && n < row.length) row[n] = given[name];
    } else Object.assign(row, given);
    const last = list.length - 1;
    if (closes && (k === 0 || k === last)) list[last - k] = structuredClone(row);
  }

  // Beside the nearest leg of the path, or behind the last target; all that is stated for each target grows.
  addTarget([x, y], k = this.placeFor([x, y])) {
    const angle = this.targets[Math.min(k, this.list.length - 1)].angle;
    const row = this.kind === "motion" ? [x, y, angle ?? 0] : [x, y];
    this.eachList((list) => list.splice(k, 0, list === this.list ? row : list[Math.min(k, list.length - 1)]));
  }

  removeTarget(k) {
    if (this.list.length <= FEWEST[this.kind]) return;
    const { closes } = this;
    this.eachList((list) => list.splice(k, 1));
    if (closes && k === 0) this.list[this.list.length - 1] = [...this.list[0]];
    else if (closes && k === this.list.length) this.list.push([...this.list[0]]);
    this.locked.clear();
  }

  // Lists with one entry for each target.
  eachList(change) {
    const count = this.list.length;
    const lists = Object.entries(this.document[this.kind])
      .filter(([name, list]) => Array.isArray(list) && list.length === count && name !== "body")
      .map(([, list]) => list);
    for (const list of lists) change(list);
  }

  placeFor([x, y]) {
    const points = this.targets;
    const count = points.length;
    if (this.kind === "motion" || count < 2) return count;
    const away = (k) => distanceToLeg([x, y], points[k], points[k + 1]);
    let [place, least] = [count, Math.hypot(points[count - 1].x - x, points[count - 1].y - y)];
    const first = Math.hypot(points[0].x - x, points[0].y - y);
    if (first < least && !this.closes) [place, least] = [0, first];
    for (let k = 0; k + 1 < count; k += 1) if (away(k) < 0.8 * least) [place, least] = [k + 1, away(k)];
    return place;
  }

  // A path in place of the one there is; closed where it ends near its beginning.
  setPath(points) {
    const [first, last] = [points[0], points.at(-1)];
    const length = points.slice(1).reduce((sum, p, k) => sum + Math.hypot(p[0] - points[k][0], p[1] - points[k][1]), 0);
    const closed = Math.hypot(first[0] - last[0], first[1] - last[1]) < length / 10;
    const path = closed ? [...points.slice(0, -1), [...first]] : points;
    this.document.path = { points: path, closed };
    this.locked.clear();
  }

  get requirements() {
    return (this.document.requirements ||= {});
  }

  // Lists of corners that can be dragged, as [name, corners, closed].
  get polygons() {
    const { scene = {}, requirements = {} } = this.document;
    return [
      ...(requirements.keep_out || []).map((corners, k) => [`area ${k + 1}`, corners, true]),
      ...(scene.outlines || []).map((corners, k) => [`outline ${k + 1}`, corners, false]),
    ];
  }

  removePolygon(corners) {
    for (const list of [this.requirements.keep_out || [], (this.document.scene || {}).outlines || []]) {
      if (list.includes(corners)) list.splice(list.indexOf(corners), 1);
    }
  }

  // Boxes of pivots, those that are the same as one: [names, box].
  get regions() {
    const found = new Map();
    for (const name of REGIONS) {
      const box = (this.document.requirements || {})[name];
      if (!box) continue;
      const key = JSON.stringify(box);
      found.set(key, [...(found.get(key) || []), name]);
    }
    return [...found].map(([key, names]) => [names, JSON.parse(key)]);
  }

  setRegion(names, box) {
    for (const name of names) this.requirements[name] = structuredClone(box);
  }
}

function distanceToLeg([x, y], from, to) {
  const [dx, dy] = [to.x - from.x, to.y - from.y];
  const share = ((x - from.x) * dx + (y - from.y) * dy) / (dx * dx + dy * dy || 1);
  const at = Math.min(Math.max(share, 0), 1);
  return Math.hypot(from.x + at * dx - x, from.y + at * dy - y);
}

// So many points at equal distances along a line that a hand drew.
function resampled(points, count) {
  const lengths = [0];
  for (let k = 1; k < points.length; k += 1) {
    lengths.push(lengths[k - 1] + Math.hypot(points[k][0] - points[k - 1][0], points[k][1] - points[k - 1][1]));
  }
  return Array.from({ length: count }, (_, n) => {
    const wanted = (lengths.at(-1) * n) / (count - 1);
    const beyond = lengths.findIndex((length) => length >= wanted);
    const k = beyond < 0 ? lengths.length - 1 : Math.max(beyond, 1);
    const share = (wanted - lengths[k - 1]) / (lengths[k] - lengths[k - 1] || 1);
    return points[k].map((value, axis) => points[k - 1][axis] + share * (value - points[k - 1][axis]));
  });
}
