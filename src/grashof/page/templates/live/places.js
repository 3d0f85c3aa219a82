// Regions of joints, as the problem file states them: points, boxes, polygons, segments; their drawings and handles.
const PIVOTS = ["o2", "o4", "d", "a", "b"]; // as in `regions.py`; equal ones are one place
const AT_TARGETS = { a: "A", b: "B", instant_centre: "instant centre" };
const SHORTEST = 34; // px: the side of a polygon that offers a new corner

// The frame of most places, that of the task.
const STILL = { out: (place) => place, back: (place) => place };

// A place on the drawing as the file has it, rounded like other places there.
const inFrame = (frame, place, rounded) => (frame === STILL ? place : rounded(frame.back(place)));

// The frame of places on the body, at the first pose; null where that is incomplete.
function frameOfBody(task) {
  const { x, y, angle } = task.targets[0] || {};
  if (task.kind !== "motion" || [x, y, angle].includes(null)) return null;
  const [cos, sin] = [Math.cos(angle / DEG), Math.sin(angle / DEG)];
  return {
    out: ([u, v]) => [x + u * cos - v * sin, y + u * sin + v * cos],
    back: ([px0, py0]) => [(px0 - x) * cos + (py0 - y) * sin, (py0 - y) * cos - (px0 - x) * sin],
  };
}

// Every place of a task: its words, its value, the tables of the file that have it, and its frame.
function placesOf(task) {
  const { requirements = {}, driver = {} } = task.document;
  const places = [];
  const found = new Map();
  for (const key of PIVOTS) {
    const value = requirements[key];
    if (!value) continue;
    const same = JSON.stringify(value);
    found.set(same, [...(found.get(same) || []), key]);
  }
  for (const keys of found.values()) {
    const words = `${keys.map((key) => key.toUpperCase()).join(", ")} region`;
    places.push({ words, value: requirements[keys[0]], entries: keys.map((key) => [requirements, key]), frame: STILL });
  }
  for (const each of requirements.at || []) {
    const targets = `target${each.targets.length > 1 ? "s" : ""} ${each.targets.join(", ")}`;
    for (const [key, joint] of Object.entries(AT_TARGETS)) {
      if (each[key]) places.push({ words: `${joint} region at ${targets}`, value: each[key], entries: [[each, key]], frame: STILL });
    }
  }
  const frame = frameOfBody(task);
  for (const key of ["a_on_body", "b_on_body"]) {
    if (!requirements[key] || !frame) continue;
    const words = `${key[0].toUpperCase()} region on the body`;
    places.push({ words, value: requirements[key], entries: [[requirements, key]], frame });
  }
  const { cylinder = {} } = driver;
  if (cylinder.base) {
    const words = "region of the cylinder's base";
    places.push({ words, value: cylinder.base, entries: [[cylinder, "base"]], frame: STILL });
  }
  return places;
}

// Corners of a polygon, or ends of a segment; of a box null.
const cornersIn = (value) => [value.inside, value.on].find(Array.isArray) || null;

// Both sides of a box along each axis, null where it is open; a point is a box of no width.
function sidesOf(value) {
  return ["x", "y"].map((axis, n) => {
    const side = Array.isArray(value) ? value[n] : value[axis];
    return typeof side === "number" ? [side, side] : side || [null, null];
  });
}

// A place as the drawing has it, as `regions_of` in Python; null where it cannot be drawn.
function drawnPlace({ words: name, value, frame }) {
  const sides = sidesOf(value);
  let corners = cornersIn(value);
  if (!corners && frame !== STILL) {
    if (sides.flat().includes(null)) return null;
    const [[left, right], [low, high]] = sides;
    corners = [[left, low], [right, low], [right, high], [left, high]];
  }
  if (!corners) return { name, x: sides[0], y: sides[1] };
  corners = corners.map(frame.out);
  const [x, y] = [0, 1].map((axis) => corners.map((corner) => corner[axis])).map((all) => [Math.min(...all), Math.max(...all)]);
  return { name, x, y, corners };
}

// A task as the drawing has it: as Python's `scene_of`.
function sceneOf(task, published) {
  const { scene = {}, requirements = {}, length_unit: unit = "" } = task.document;
  const rows = task.targets;
  const table = task.document[task.kind] || {};
  const shown =
    task.kind === "motion"
      ? { poses: rows.map(({ x, y, angle }) => [x, y, angle === null ? null : angle / DEG]), body: table.body || null }
      : { points: rows.map(({ x, y }) => [x, y]) };
  return {
    ...(task.list ? shown : { points: [] }),
    closed: Boolean(table.closed),
    unit,
    outlines: scene.outlines || [],
    keepOut: requirements.keep_out || [],
    keptOut: requirements.keep_out_for || ["o2", "o4"],
    regions: placesOf(task).map(drawnPlace).filter(Boolean),
    published: published || null,
  };
}

// Handles of corners, and of the middles of sides, where a new corner begins. `put` writes the changed corners into
// the file, in the frame of the place; `remove` deletes the place where too few corners would be left.
function cornerHandles({ words, corners: given, closed, fewest, frame = STILL, put, remove, grows = true }, stage, rounded) {
  const repeats = closed && given.length > fewest && String(given[0]) === String(given.at(-1));
  const corners = repeats ? given.slice(0, -1) : given;
  const changed = (change) => {
    const copy = structuredClone(corners);
    change(copy);
    put(copy);
  };
  const handles = corners.map((corner, k) => ({
    name: `${words} ${k}`,
    words: `corner ${k + 1} of ${words}`,
    at: frame.out(corner),
    style: "corner",
    move: (place) => changed((copy) => (copy[k] = inFrame(frame, place, rounded))),
    remove: () => (corners.length > fewest ? changed((copy) => copy.splice(k, 1)) : remove()),
  }));
  if (!grows) return handles;
  corners.forEach((corner, k) => {
    if (k + 1 === corners.length && !closed) return;
    const [from, to] = [corner, corners[(k + 1) % corners.length]].map(frame.out);
    if (stage.unit * Math.hypot(to[0] - from[0], to[1] - from[1]) < SHORTEST) return;
    handles.push({
      name: `${words} + ${k}`,
      words: `new corner of ${words}`,
      at: [(from[0] + to[0]) / 2, (from[1] + to[1]) / 2],
      style: "insert",
      becomes: `${words} ${k + 1}`,
      move: (place) => changed((copy) => copy.splice(k + 1, 0, inFrame(frame, place, rounded))),
    });
  });
  return handles;
}

// Handles of a place: its corners, or the sides of a box that is open.
function placeHandles({ words, value, entries, frame }, stage, rounded) {
  const put = (changed) => {
    for (const [table, key] of entries) table[key] = structuredClone(changed);
  };
  const remove = () => entries.forEach(([table, key]) => delete table[key]);
  const corners = cornersIn(value);
  if (corners) {
    const inside = corners === value.inside;
    const shape = inside ? { closed: true, fewest: 3 } : { closed: false, fewest: 2, grows: false };
    return cornerHandles({ words, corners, ...shape, frame, put: (each) => put({ [inside ? "inside" : "on"]: each }), remove }, stage, rounded);
  }
  const inPlace = (place) => inFrame(frame, place, rounded);
  if (Array.isArray(value)) {
    return [{ name: `${words} 0`, words, at: frame.out(value), style: "corner", move: (place) => put(inPlace(place)), remove }];
  }
  const sides = sidesOf(value);
  const open = sides.map(([low]) => low === null);
  if ((open[0] && open[1]) || (frame !== STILL && (open[0] || open[1]))) return [];
  // A side stops at the opposite one.
  const moved = (place, ...ends) => {
    const box = structuredClone(value);
    ends.forEach((end, axis) => {
      if (end === null) return;
      const [low, high] = sides[axis];
      box["xy"[axis]] = end ? [low, Math.max(place[axis], low)] : [Math.min(place[axis], high), high];
    });
    put(box);
  };
  const middle = stage.back([stage.svg.clientWidth / 2, stage.svg.clientHeight / 2]);
  const handle = (i, j) => ({
    name: `${words} ${i ?? "-"}${j ?? "-"}`,
    words: `${open.includes(true) ? "side" : "corner"} of ${words}`,
    at: frame.out([i, j].map((end, axis) => (end === null ? middle[axis] : sides[axis][end]))),
    style: "corner",
    remove,
    move: (place) => moved(inPlace(place), i, j),
  });
  if (open[0]) return [handle(null, 0), handle(null, 1)];
  if (open[1]) return [handle(0, null), handle(1, null)];
  return [handle(0, 0), handle(1, 0), handle(1, 1), handle(0, 1)];
}
