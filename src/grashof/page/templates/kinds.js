// Kinds of linkages: their points, and how each closes from A; what their links look like. Angles in rad.
// Past a dead position, where only rounding leads, the root counts as 0, so a loop is always closed.
const root = (value) => Math.sqrt(Math.max(value, 0));
const unitVector = (x, y) => {
  const s = Math.hypot(x, y);
  return s > 0 ? [x / s, y / s] : [1, 0];
};

// B is the crossing of the circles about A and O4 on the side that the assembly names. Heron's
// product keeps its digits near dead positions.
// closure: RRR
function closeFourBar({ o4, r3, r4 }, a, assembly) {
  const [x, y] = [o4[0] - a[0], o4[1] - a[1]];
  const s = Math.hypot(x, y);
  const [nx, ny] = unitVector(x, y);
  const heron = (r3 + r4 - s) * (r3 + r4 + s) * (s - r3 + r4) * (s + r3 - r4);
  const along = s > 0 ? (s + ((r3 - r4) * (r3 + r4)) / s) / 2 : 0;
  const beside = assembly * (s > 0 ? root(heron) / (2 * s) : r3);
  const b = [a[0] + along * nx - beside * ny, a[1] + along * ny + beside * nx];
  return {
    b,
    e3: [(b[0] - a[0]) / r3, (b[1] - a[1]) / r3],
    theta4: Math.atan2(b[1] - o4[1], b[0] - o4[0]),
    mu: smallAngle((r3 * r3 + r4 * r4 - s * s) / (2 * r3 * r4)),
    across: [b[0] - o4[0], b[1] - o4[1]],
  };
}

// B is on the slide, ahead of A along it or behind; `h` is the height of the slide above A.
// closure: RRP
function closeSliderCrank({ o2, r3, offset, slide_angle }, a, assembly) {
  const [cos, sin] = [Math.cos(slide_angle), Math.sin(slide_angle)];
  const [x, y] = [a[0] - o2[0], a[1] - o2[1]];
  const h = offset - (y * cos - x * sin);
  const along = assembly * root((r3 - h) * (r3 + h));
  return {
    b: [a[0] + along * cos - h * sin, a[1] + along * sin + h * cos],
    e3: unitVector(along * cos - h * sin, along * sin + h * cos),
    theta4: wrapped(slide_angle + Math.PI / 2),
    mu: smallAngle(h / r3),
    across: [-sin, cos],
    slide: x * cos + y * sin + along,
  };
}

// The rod passes O4 at the offset; B is the foot of O4 on it, `slide` from A along the rod.
// closure: RPR
function closeInverted({ o4, offset }, a, assembly) {
  const [x, y] = [o4[0] - a[0], o4[1] - a[1]];
  const s = Math.hypot(x, y);
  const slide = assembly * root((s - offset) * (s + offset));
  const e3 = unitVector(x * slide - y * offset, y * slide + x * offset);
  return {
    b: [a[0] + slide * e3[0], a[1] + slide * e3[1]],
    e3,
    theta4: wrapped(Math.atan2(e3[1], e3[0]) + Math.PI / 2),
    mu: s > 0 ? smallAngle(offset / s) : 0,
    slide,
  };
}

// min(mu, 180 - mu) from its cosine.
const smallAngle = (cosine) => Math.acos(Math.min(1, Math.abs(cosine)));

// Corners of a block about B, so long to either side of it along a direction, and about half as wide.
function blockAt([x, y], angle, half) {
  const [u, v] = [half * Math.cos(angle), half * Math.sin(angle)];
  const corners = [[-1, -0.6], [1, -0.6], [1, 0.6], [-1, 0.6]];
  return corners.map(([along, beside]) => [x + along * u - beside * v, y + along * v + beside * u]);
}

// From one end of the rod to the other: over A, all of its way through the block, and the foot of P.
function rodOf({ linkage, from, to }, { a, theta3, slide }, half) {
  const [low, high] = [Math.min(from, slide, 0) - half, Math.max(to, slide, 0) + half];
  const [u, v] = linkage.coupler_point;
  const [cos, sin] = [Math.cos(theta3), Math.sin(theta3)];
  const on = (at) => [a[0] + at * cos, a[1] + at * sin];
  const ends = [low < -half ? low : 0, high > half ? high : 0];
  return { rod: [on(Math.min(ends[0], u)), on(Math.max(ends[1], u))], foot: on(u), beside: v !== 0 };
}

// Of each kind: points on the ground, the others, and its links as parts of a drawing, from below: name,
// class, and whether the outline is closed. `shapes` gives the corners of each. `frames` has the origin of each
// link, its direction and another point on it.
const BARS = [["output", "output"], ["driver", "driver"]];
const FRAMES = { driver: ["o2", "theta2", "a"], coupler: ["a", "theta3", "b"], output: ["o4", "theta4", "b"] };
const KINDS = {
  "four-bar": {
    ground: ["o2", "o4"],
    moving: ["a", "b", "p"],
    close: closeFourBar,
    frames: FRAMES,
    parts: [["coupler", "coupler", true], ...BARS],
    shapes: (_, { o2, o4, a, b, p }) => ({ coupler: [a, b, p], output: [o4, b], driver: [o2, a] }),
  },
  "slider-crank": {
    ground: ["o2"],
    moving: ["a", "b", "p"],
    close: closeSliderCrank,
    frames: { ...FRAMES, output: ["b", "slide_angle", "b"] },
    parts: [["block", "output block", true], ["coupler", "coupler", true], BARS[1]],
    shapes: ({ linkage }, { o2, a, b, p }, half) => ({
      block: blockAt(b, linkage.slide_angle, half),
      coupler: [a, b, p],
      driver: [o2, a],
    }),
  },
  "inverted-slider-crank": {
    ground: ["o2", "o4"],
    moving: ["a", "b", "p"],
    close: closeInverted,
    frames: { ...FRAMES, coupler: ["a", "theta3", "p"] },
    parts: [["block", "output block", true], ["rod", "coupler rod"], ["arm", "coupler"], ...BARS],
    shapes: (slid, state, half) => {
      const { o2, o4, a, b, p, theta3 } = state;
      const { rod, foot, beside } = rodOf(slid, state, half);
      const arm = beside ? [foot, p] : [p, p];
      return { block: blockAt(b, theta3, half), rod, arm, output: [o4, b], driver: [o2, a] };
    },
  },
};
const kindOf = (linkage) => KINDS[linkage.mechanism || "four-bar"];
const pointsOf = (linkage) => [...kindOf(linkage).ground, ...kindOf(linkage).moving];
