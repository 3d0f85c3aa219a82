// Common to all plots: pens, numbers along axes, lines that end at the frame, rows between samples.
const PENS = 8; // the styles of lines; the next eight have the same colours, dotted
const SPOTS = [
  "M-3.5 0a3.5 3.5 0 1 0 7 0a3.5 3.5 0 1 0 -7 0Z",
  "M-3 -3h6v6h-6Z",
  "M0 -4.5l4.5 4.5l-4.5 4.5l-4.5 -4.5Z",
  "M-4 3.5h8l-4 -7Z",
];
const LETTER = 6.4; // px: few characters of an axis are wider
const FONT = "Helvetica, Arial, sans-serif";

const pen = (k) => `pen-${(k % PENS) + 1}${k >= PENS ? " again" : ""}`;

// Single points begin at the last pen.
const spotPen = (k) => `pen-${PENS - (k % PENS)}`;
const spot = (k) => SPOTS[k % SPOTS.length];

const measure = document.createElement("canvas").getContext("2d");
function textWidth(text) {
  measure.font = `12px ${FONT}`;
  return measure.measureText(text).width;
}

// As much of a text as fits.
function shortened(text, width) {
  if (textWidth(text) <= width) return text;
  let kept = [...text];
  while (kept.length && textWidth(`${kept.join("")}…`) > width) kept = kept.slice(0, -1);
  return `${kept.join("")}…`;
}

// Ticks with their numbers as text, with a power of ten where they are long.
function numbered({ at, decimals }) {
  const most = Math.max(...at.map(Math.abs));
  const step = at.length > 1 ? at[1] - at[0] : most;
  const order = (value) => Math.floor(Math.log10(value) + 1e-9);
  const digits = (value) => Math.min(Math.max(order(Math.abs(value)) - order(step), 0), 12);
  const longer = Math.max(order(most), 0) + 2 + decimals > digits(most) + 5;
  const power = most >= 1e5 || (decimals > 4 && longer);
  const text = (value) => {
    if (!power) return fixed(value, decimals);
    if (Math.abs(value) < step / 2) return "0";
    return minus(value.toExponential(digits(value)).replace("e+", "e"));
  };
  return at.map((value) => ({ value, text: text(value) }));
}

const longest = (labels) => LETTER * Math.max(1, ...labels.map(({ text }) => text.length));

// Ticks whose numbers do not touch, along a length in pixels.
function ticksAlong(low, high, length, degrees, least = 48) {
  let about = length / least;
  for (;;) {
    const labels = numbered((degrees ? degreeTicks : ticks)(low, high, about));
    if (about < 1.5 || longest(labels) + 8 < length / Math.max(labels.length - 1, 1)) return labels;
    about *= 0.7;
  }
}

// The part of a line from one point to another that lies in a box, or null.
function inBox([x0, y0], [x1, y1], { left, right, top, bottom }) {
  let [from, to] = [0, 1];
  for (const [start, way, low, high] of [
    [x0, x1 - x0, left, right],
    [y0, y1 - y0, top, bottom],
  ]) {
    if (way === 0) {
      if (start < low || start > high) return null;
    } else {
      const [enter, leave] = way > 0 ? [low, high] : [high, low];
      from = Math.max(from, (enter - start) / way);
      to = Math.min(to, (leave - start) / way);
    }
  }
  if (from > to) return null;
  const at = (share) => [x0 + share * (x1 - x0), y0 + share * (y1 - y0)];
  return [from > 0 ? at(from) : [x0, y0], to < 1 ? at(to) : [x1, y1]];
}

// A path through the points, null between its pieces, clipped to a box.
function cutPath(points, box) {
  const kept = [];
  for (let k = 1; k < points.length; k += 1) {
    const piece = points[k - 1] && points[k] ? inBox(points[k - 1], points[k], box) : null;
    if (!piece) continue;
    const last = kept.at(-1);
    if (!last || last[0] !== piece[0][0] || last[1] !== piece[0][1]) kept.push(null, piece[0]);
    kept.push(piece[1]);
  }
  return through(kept);
}

// Least and largest of some numbers; null where none is known.
function extent(values) {
  let [low, high] = [Infinity, -Infinity];
  for (const value of values) {
    if (value === null || value === undefined) continue;
    if (value < low) low = value;
    if (value > high) high = value;
  }
  return low <= high ? [low, high] : null;
}

const margined = (/** @type {number[]} */ [low, high], share) => {
  const margin = share * (high - low) || 0.1 * Math.abs(high) || 1;
  return [low - margin, high + margin];
};

// Where a column takes a value, as a row with its share of the next one; null where it does not. Rounding
// may leave a value just outside.
function rowAt(column, value, near = 1e-3) {
  let beside = null;
  for (let k = 0; k + 1 < column.length; k += 1) {
    const [here, next] = [column[k], column[k + 1]];
    if (here === null || next === null) continue;
    if (Math.min(here, next) <= value && value <= Math.max(here, next)) {
      return here === next ? k : k + (value - here) / (next - here);
    }
    if (Math.abs(value - here) <= near) beside = k;
    else if (Math.abs(value - next) <= near) beside = k + 1;
  }
  return beside;
}

// The same of driver angles in deg, whatever turn the column counts from.
function rowAtAngle(column, angle) {
  const found = rowAt(column, angle);
  if (found !== null || !extent(column)) return found;
  return rowAt(column, angle + 360 * Math.ceil((extent(column)[0] - angle) / 360 - 1e-6));
}

// A column at a row; null beside a gap.
function valueAt(column, row) {
  if (row === null) return null;
  const k = Math.floor(row);
  const [here, next] = [column[k], column[k + 1]];
  if (here === null || here === undefined) return null;
  if (row === k) return here;
  return next === null || next === undefined ? null : here + (row - k) * (next - here);
}
