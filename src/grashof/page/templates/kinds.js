// A linkage is a driver and dyads: how each closes its gap, and the look of the links. Angles in rad.
// Past a dead position, where only rounding leads, the root counts as 0, so a loop is always closed.
const root = (value) => Math.sqrt(Math.max(value, 0));
const unitVector = (x, y) => {
  const s = Math.hypot(x, y);
  return s > 0 ? [x / s, y / s] : [1, 0];
};

// E is the crossing of the circles about C and D on the side that the assembly names. Heron's product keeps
// its digits near dead positions.
// closure: RRR
function closePins({ m, n }, c, d, assembly) {
  const [x, y] = [d[0] - c[0], d[1] - c[1]];
  const s = Math.hypot(x, y);
  const [nx, ny] = unitVector(x, y);
  const heron = (m + n - s) * (m + n + s) * (s - m + n) * (s + m - n);
  const along = s > 0 ? (s + ((m - n) * (m + n)) / s) / 2 : 0;
  const beside = assembly * (s > 0 ? root(heron) / (2 * s) : m);
  const e = [c[0] + along * nx - beside * ny, c[1] + along * ny + beside * nx];
  return {
    e,
    e3: [(e[0] - c[0]) / m, (e[1] - c[1]) / m],
    e4: [(e[0] - d[0]) / n, (e[1] - d[1]) / n],
    mu: smallAngle((m * m + n * n - s * s) / (2 * m * n)),
    across: [e[0] - d[0], e[1] - d[1]],
  };
}

// E is on the slide, ahead of C along it or behind; `h` is the height of the slide above C.
// closure: RRP
function closeSlider({ m, offset, angle }, c, d, assembly) {
  const [cos, sin] = [Math.cos(angle), Math.sin(angle)];
  const [x, y] = [c[0] - d[0], c[1] - d[1]];
  const h = offset - (y * cos - x * sin);
  const along = assembly * root((m - h) * (m + h));
  return {
    e: [c[0] + along * cos - h * sin, c[1] + along * sin + h * cos],
    e3: unitVector(along * cos - h * sin, along * sin + h * cos),
    e4: [-sin, cos],
    mu: smallAngle(h / m),
    across: [-sin, cos],
    slide: x * cos + y * sin + along,
  };
}

// The rod passes D at the offset; E is the foot of D on it, `slide` from C along the rod.
// closure: RPR
function closeBlock({ offset }, c, d, assembly) {
  const [x, y] = [d[0] - c[0], d[1] - c[1]];
  const s = Math.hypot(x, y);
  const slide = assembly * root((s - offset) * (s + offset));
  const e3 = unitVector(x * slide - y * offset, y * slide + x * offset);
  return {
    e: [c[0] + slide * e3[0], c[1] + slide * e3[1]],
    e3,
    e4: [-e3[1], e3[0]],
    mu: s > 0 ? smallAngle(offset / s) : 0,
    slide,
  };
}

// min(mu, 180 - mu) from its cosine.
const smallAngle = (cosine) => Math.acos(Math.min(1, Math.abs(cosine)));
const CLOSE = { RRR: closePins, RRP: closeSlider, RPR: closeBlock };

// The first dyad: its sizes, the links that carry C and D, and where these are in their frames; that of the
// ground is the global one. A slide is counted from O2.
function firstDyad({ o2, o4, r2, r3, r4, offset, slide_angle: angle }) {
  const kind = angle !== undefined ? "RRP" : r4 !== undefined ? "RRR" : "RPR";
  const at = [[r2, 0], kind === "RRP" ? o2 : o4];
  const [points, names] = [["a", "o4", "b"], ["coupler", "output"]];
  return { kind, first: 3, points, names, hosts: [2, 1], at, sizes: { m: r3, n: r4, offset, angle } };
}

function secondDyad({ o2, c, d, r5, r6, hosts, offset_2: offset, slide_angle_2: angle }) {
  const kind = angle !== undefined ? "RRP" : "RRR";
  const at = [c, kind === "RRP" ? o2 : d];
  const [points, names] = [["c", "d", "e"], ["coupler-2", "output-2"]];
  return { kind, first: 5, points, names, hosts, at, sizes: { m: r5, n: r6, offset, angle } };
}

// Links by number: style and points, as `Mechanism.links` has them.
function linksOf(dyads, carries) {
  const links = { 1: { style: "ground", points: ["o2"] }, 2: { style: "driver", points: ["o2", "a"] } };
  for (const { kind, first, points: [c, d, e], names, hosts } of dyads) {
    links[first] = { style: names[0], points: kind === "RPR" ? [c] : [c, e] };
    links[first + 1] = { style: names[1], points: kind === "RRP" ? [e] : [d, e] };
    for (const [host, point] of [[hosts[0], c], [hosts[1], d]]) {
      const { points } = links[host];
      if (!points.includes(point) && !(point === d && kind === "RRP")) points.push(point);
    }
  }
  links[carries].points.push("p");
  return links;
}

// The links as parts of a drawing, from below: name, class, and whether the outline is closed; `corners` gives
// the corners of each. Blocks lie below all else, the driver above.
function partsIn(dyads, links) {
  const bar = (number) => {
    const { style, points } = links[number];
    const plate = points.length > 2;
    const corners = (_, state) => around(points.map((name) => state[name]));
    const look = number === 3 ? !plate && " rod" : plate && " plate";
    return { name: style, style: `${style}${look || ""}`, closed: plate, corners };
  };
  const blocks = [];
  const bars = [];
  for (const { kind, first, points: [, , e], names } of [...dyads].reverse()) {
    if (kind === "RPR") {
      bars.push({ name: "rod", style: `${names[0]} rod`, corners: (slid, state, half) => rodOf(slid, state, half).rod });
      bars.push({ name: "arm", style: names[0], corners: (slid, state, half) => rodOf(slid, state, half).arm });
    } else bars.push(bar(first));
    if (kind !== "RRR") {
      const along = (state) => (kind === "RRP" ? state[`theta${first + 1}`] - Math.PI / 2 : state[`theta${first}`]);
      const corners = (_, state, half) => blockAt(state[e], along(state), half);
      blocks.push({ name: "block", style: `${names[1]} block`, closed: true, corners });
    }
    if (links[first + 1].points.length > 1) bars.push(bar(first + 1));
  }
  return [...blocks, ...bars, bar(2)];
}

// Corners of a plate in an order in which its outline does not cross itself.
function around(corners) {
  if (corners.length < 4) return corners;
  const [x, y] = [0, 1].map((axis) => corners.reduce((sum, corner) => sum + corner[axis], 0) / corners.length);
  const angle = ([cx, cy]) => Math.atan2(cy - y, cx - x);
  return [...corners].sort((one, other) => angle(one) - angle(other));
}

// Corners of a block about a point, so long to either side of it along a direction, and about half as wide.
function blockAt([x, y], angle, half) {
  const [u, v] = [half * Math.cos(angle), half * Math.sin(angle)];
  const corners = [[-1, -0.6], [1, -0.6], [1, 0.6], [-1, 0.6]];
  return corners.map(([along, beside]) => [x + along * u - beside * v, y + along * v + beside * u]);
}

// From one end of the rod to the other: over A, all of its way through the block, and the foot of P; and the
// arm from there to P.
function rodOf({ linkage, from, to }, { a, p, theta3, slide }, half) {
  const [low, high] = [Math.min(from, slide, 0) - half, Math.max(to, slide, 0) + half];
  const [u, v] = linkage.coupler_point;
  const [cos, sin] = [Math.cos(theta3), Math.sin(theta3)];
  const on = (at) => [a[0] + at * cos, a[1] + at * sin];
  const ends = [low < -half ? low : 0, high > half ? high : 0];
  return { rod: [on(Math.min(ends[0], u)), on(Math.max(ends[1], u))], arm: v !== 0 ? [on(u), p] : [p, p] };
}

// Dyads, links, points on the ground and others, and the parts of a drawing of a linkage; kept.
const kinds = new WeakMap();
function kindOf(linkage) {
  if (!kinds.has(linkage)) {
    const dyads = [firstDyad(linkage), ...(linkage.hosts ? [secondDyad(linkage)] : [])];
    const carries = linkage.point_link ?? 3;
    const links = linksOf(dyads, carries);
    const ground = links[1].points;
    const points = new Set(Object.values(links).flatMap((link) => link.points));
    const moving = [...points].filter((name) => !ground.includes(name));
    kinds.set(linkage, { dyads, links, carries, ground, moving, parts: partsIn(dyads, links) });
  }
  return kinds.get(linkage);
}
const pointsOf = (linkage) => [...kindOf(linkage).ground, ...kindOf(linkage).moving];
