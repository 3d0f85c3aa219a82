// The task of a live page as its problem file: changes by hand, undo and redo.
const HISTORY = 200; // steps back, at most
const OF_ALL = ["o2", "o4", "a", "b", "keep_out", "link_length", "link_ratio_max", "transmission_min_deg", "size"]; // requirements
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

  // A path in place of the present targets. Another kind of task becomes one, with the requirements of all kinds.
  setPath(points, closed) {
    const { document } = this;
    if (this.kind !== "path") {
      const { requirements = {}, scene, length_unit, search } = document;
      const kept = Object.entries(requirements).filter(([key]) => OF_ALL.includes(key));
      if (requirements.keep_out_for) kept.push(["keep_out_for", requirements.keep_out_for.filter((part) => part !== "body")]);
      const path = { kind: "path", length_unit, scene, requirements: Object.fromEntries(kept), search };
      this.document = JSON.parse(JSON.stringify(path)); // without those that are not stated
    }
    this.document.path = { points, closed };
    this.locked.clear();
  }

  get requirements() {
    return (this.document.requirements ||= {});
  }

  // Lists of corners that can be dragged: words, the list they are in, their number in it, and whether they are closed.
  get polygons() {
    const { scene = {}, requirements = {} } = this.document;
    const entries = (list, words, closed) => (list || []).map((_, k) => ({ words: `${words} ${k + 1}`, list, k, closed }));
    return [...entries(requirements.keep_out, "area", true), ...entries(scene.outlines, "outline", false)];
  }

  // Joints with a place of their own: "o2", or "a_on_body".
  setPlace(keys, place) {
    for (const key of keys) this.requirements[key] = structuredClone(place);
  }
}

function distanceToLeg([x, y], from, to) {
  const [dx, dy] = [to.x - from.x, to.y - from.y];
  const share = ((x - from.x) * dx + (y - from.y) * dy) / (dx * dx + dy * dy || 1);
  const at = Math.min(Math.max(share, 0), 1);
  return Math.hypot(from.x + at * dx - x, from.y + at * dy - y);
}

// A line drawn by hand as a number of points at equal distances along it; closed where it ends near its beginning,
// and then with the first point again as the last.
function sampled(drawn, count) {
  const ends = [drawn[0], drawn.at(-1)];
  const closed = distance(...ends) < lengthsOf(drawn).at(-1) / 10;
  const line = closed ? [...drawn, drawn[0]] : drawn;
  const points = resampled(line, closed ? count + 1 : count);
  return { points: closed ? [...points.slice(0, -1), points[0]] : points, closed };
}

const distance = ([x, y], [u, v]) => Math.hypot(u - x, v - y);

// Lengths of a line up to each of its points.
function lengthsOf(line) {
  const lengths = [0];
  for (let k = 1; k < line.length; k += 1) lengths.push(lengths[k - 1] + distance(line[k - 1], line[k]));
  return lengths;
}

function resampled(line, count) {
  const lengths = lengthsOf(line);
  return Array.from({ length: count }, (_, n) => {
    const wanted = (lengths.at(-1) * n) / (count - 1);
    const beyond = lengths.findIndex((length) => length >= wanted);
    const k = beyond < 0 ? lengths.length - 1 : Math.max(beyond, 1);
    const share = (wanted - lengths[k - 1]) / (lengths[k] - lengths[k - 1] || 1);
    return line[k].map((value, axis) => line[k - 1][axis] + share * (value - line[k - 1][axis]));
  });
}

// Points that differ from the one before: on a coarse grid neighbours may be equal.
const withoutRepeats = (points) => points.filter((point, k) => k === 0 || String(point) !== String(points[k - 1]));
