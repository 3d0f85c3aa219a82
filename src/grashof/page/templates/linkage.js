// Position of a linkage in closed form, and how far its driver goes. Angles in rad.
const TURN = 2 * Math.PI;
const DEG = 180 / Math.PI;
const STEPS = 180;

const wrapped = (angle) => angle - TURN * Math.round(angle / TURN);

// A point of a link by its place in the frame of the link.
/** @type {(frame: { at: number[], along: number[] }, place: number[]) => number[]} */
const carried = ({ at: [x, y], along: [cos, sin] }, [u, v]) => [x + u * cos - v * sin, y + u * sin + v * cos];

// Where every point is; in the first loop on the assembly of the linkage unless another is given. `mu` is the
// worst of all loops, `guided` the direction of the guided body.
function positionOf(linkage, theta2, assembly = linkage.assembly) {
  const { o2, o4, coupler_point: point, body_angle: turned } = linkage;
  const { dyads, carries } = kindOf(linkage);
  const frames = { 1: { at: [0, 0], along: [1, 0] }, 2: { at: o2, along: [Math.cos(theta2), Math.sin(theta2)] } };
  const state = { theta2, o2, o4, mu: Math.PI };
  for (const { kind, first, points, hosts, at, sizes } of dyads) {
    const [c, d] = hosts.map((host, k) => carried(frames[host], at[k]));
    const { e, e3, e4, mu, across, slide } = CLOSE[kind](sizes, c, d, first === 3 ? assembly : linkage.assembly_2);
    const slider = kind === "RRP";
    frames[first] = { at: c, along: e3 };
    frames[first + 1] = slider ? { at: e, along: [e4[1], -e4[0]] } : { at: d, along: e4 };
    [state[points[0]], state[points[2]]] = [c, e];
    if (!slider) state[points[1]] = d;
    state[`theta${first}`] = Math.atan2(e3[1], e3[0]);
    state[`theta${first + 1}`] = Math.atan2(e4[1], e4[0]);
    state.mu = Math.min(state.mu, mu);
    state.across ??= across;
    if (slide !== undefined) state.slide = slide;
  }
  const { at, along } = frames[carries];
  state.p = carried({ at, along }, point);
  state.guided = Math.atan2(along[1], along[0]) + turned;
  return state;
}

// Travels of the slide, or angles of the last link in deg without jumps.
function outputsOf(states) {
  if (states[0].slide !== undefined) return states.map(({ slide }) => slide);
  const last = Math.max(...Object.keys(states[0]).map((key) => Number(key.match(/^theta(\d)$/)?.[1] || 0)));
  const angles = states.map((state) => state[`theta${last}`]);
  for (let k = 1; k < angles.length; k++) angles[k] = angles[k - 1] + wrapped(angles[k] - angles[k - 1]);
  return angles.map((angle) => angle * DEG);
}

// How far P goes for a radian of the driver; null in a dead position, where that has no limit. B of a bar or a slide has no
// velocity along `across`; a rod turns so that it keeps passing O4.
function pointSpeed(linkage, state) {
  const { o2, a, b, p, across, slide, theta3 } = state;
  const da = [o2[1] - a[1], a[0] - o2[0]];
  const rate = across
    ? -(da[0] * across[0] + da[1] * across[1]) / ((b[0] - a[0]) * across[1] - (b[1] - a[1]) * across[0])
    : (Math.sin(theta3) * da[0] - Math.cos(theta3) * da[1]) / slide;
  const speed = Math.hypot(da[0] - rate * (p[1] - a[1]), da[1] + rate * (p[0] - a[0]));
  return Number.isFinite(speed) ? speed : null;
}

// A point (u, v) of a link by its number, in a position; of the ground its global place.
function pointAt(linkage, number, point, state) {
  if (number === 1) return point;
  const { dyads, links } = kindOf(linkage);
  const slides = number > 3 && number % 2 === 0 && dyads[number / 2 - 2].kind === "RRP";
  const angle = state[`theta${number}`] - (slides ? Math.PI / 2 : 0);
  return carried({ at: state[links[number].points[0]], along: [Math.cos(angle), Math.sin(angle)] }, point);
}

// The end of the body of a cylinder or strut, of this length, on the line from one pivot to the other.
function bodyEnd(from, to, long) {
  const share = Math.min(long / (Math.hypot(to[0] - from[0], to[1] - from[1]) || 1), 1);
  return from.map((place, k) => place + share * (to[k] - place));
}

// The two pivots of a cylinder, the end of its body and its mounting on its link, in a position.
function cylinderAt(linkage, { on, base, point, closed }, state) {
  const number = ["driver", "coupler", "output"].indexOf(on) + 2;
  const [origin, joint = origin] = kindOf(linkage).links[number].points.map((name) => state[name]);
  const pivot = pointAt(linkage, number, point, state);
  return { base, end: bodyEnd(base, pivot, 0.9 * closed), pivot, bracket: [origin, pivot, joint] };
}

// Both pivots of a strut or spring in a position, and between them the end of its body.
function strutAt(linkage, { ends, body }, state) {
  const [from, to] = ends.map(({ link, at }) => pointAt(linkage, link, at, state));
  return [from, bodyEnd(from, to, body), to];
}

// The driver angle, moved by whole turns into the travel or held at its ends.
function within(design, theta2) {
  if (design.turns) return design.low + ((((theta2 - design.low) % TURN) + TURN) % TURN);
  return Math.min(Math.max(theta2, design.low), design.high);
}

// Angles from one to another, closer towards dead positions; as Python samples the torque.
function anglesBetween(low, high, even, steps = STEPS) {
  return Array.from({ length: steps + 1 }, (_, k) => {
    const share = even ? k / steps : (1 - Math.cos((Math.PI * k) / steps)) / 2;
    return low + (high - low) * share;
  });
}

const travelAngles = (design) => anglesBetween(design.low, design.high, design.turns);

// The path of P over some driver angles as { angles, points }: with others between them while a chord is
// longer than `chord` of the path's extent, or turns by more than 4 deg and can be seen.
function pathOf(linkage, given, chord = 0.01, most = 2000) {
  let angles = given;
  let points = angles.map((angle) => positionOf(linkage, angle).p);
  for (let round = 0; round < 24; round += 1) {
    const coarse = coarseChords(points, chord);
    const left = most - angles.length;
    if (left <= 0 || !coarse.includes(true)) break;
    const [nextAngles, nextPoints] = [[angles[0]], [points[0]]];
    let added = 0;
    for (let k = 1; k < angles.length; k += 1) {
      if (coarse[k - 1] && added < left) {
        const middle = (angles[k - 1] + angles[k]) / 2;
        nextAngles.push(middle);
        nextPoints.push(positionOf(linkage, middle).p);
        added += 1;
      }
      nextAngles.push(angles[k]);
      nextPoints.push(points[k]);
    }
    [angles, points] = [nextAngles, nextPoints];
  }
  return { angles, points };
}

// Which chords of a polygon have to be halved, as in Python.
function coarseChords(points, chord) {
  const spans = [0, 1].map((axis) => {
    const values = points.map((point) => point[axis]);
    return Math.max(...values) - Math.min(...values);
  });
  const extent = Math.max(...spans);
  const steps = points.slice(1).map((point, k) => [point[0] - points[k][0], point[1] - points[k][1]]);
  const lengths = steps.map(([x, y]) => Math.hypot(x, y));
  const ways = steps.map(([x, y]) => Math.atan2(y, x));
  const coarse = lengths.map((length) => length > chord * extent);
  for (let k = 1; k < steps.length; k += 1) {
    const longer = Math.max(lengths[k], lengths[k - 1]);
    if (longer <= (chord / 5) * extent || Math.abs(wrapped(ways[k] - ways[k - 1])) <= 4 / DEG) continue;
    for (const each of [k - 1, k]) if (lengths[each] > longer / 2) coarse[each] = true;
  }
  return coarse;
}

// How far a slide goes over the travel of a design: { linkage, from, to }; NaN of a linkage without one.
const slid = new WeakMap();
function slideOf(design) {
  if (!slid.has(design)) {
    const places = travelPath(design).angles.map((angle) => positionOf(design.linkage, angle).slide);
    slid.set(design, { linkage: design.linkage, from: Math.min(...places), to: Math.max(...places) });
  }
  return slid.get(design);
}

// The parts of a drawing as [name, class, path] of a design in a state; `at` is where a place is drawn, and
// `half` the half length of a block.
function partsOf(design, state, at, half) {
  const slid = slideOf(design);
  return kindOf(design.linkage).parts.map(({ name, style, closed, corners }) => [
    name,
    style,
    through(corners(slid, state, half).map(at), closed),
  ]);
}

// The same over the full travel of a design; kept, as every drawing of it needs it.
const travelled = new WeakMap();
function travelPath(design) {
  if (!travelled.has(design)) travelled.set(design, pathOf(design.linkage, travelAngles(design)));
  return travelled.get(design);
}
