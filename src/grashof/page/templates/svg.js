// Small functions: elements, paths, round numbers for axes, numbers as text.
/** @type {(selector: string, root?: ParentNode) => any} */
const $ = (selector, root = document) => root.querySelector(selector);
/** @type {(selector: string, root?: ParentNode) => any[]} */
const $$ = (selector, root = document) => [...root.querySelectorAll(selector)];

function element(name, attributes = {}, text = null) {
  const made = document.createElementNS("http://www.w3.org/2000/svg", name);
  set(made, attributes);
  if (text !== null) made.textContent = text;
  return made;
}

function set(node, attributes) {
  for (const [name, value] of Object.entries(attributes)) node.setAttribute(name, value);
  return node;
}

function add(parent, name, attributes, text) {
  return parent.appendChild(element(name, attributes, text));
}

const px = (value) => value.toFixed(2);

// A path through points, lifted where one is null.
function through(points, closed = false) {
  let drawing = false;
  const parts = points.map((point) => {
    const part = point === null ? "" : `${drawing ? "L" : "M"}${px(point[0])} ${px(point[1])}`;
    drawing = point !== null;
    return part;
  });
  return parts.join("") + (closed ? "Z" : "");
}

// Round numbers between two limits, `about` of them, and how many decimals they need.
function ticks(low, high, about, steps = [1, 2, 5, 10]) {
  const rough = (high - low) / Math.max(about, 1);
  if (!(rough > 0) || !Number.isFinite(rough)) return { at: [low], decimals: 3 };
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = steps.find((each) => each * power >= rough * 0.999) * power;
  const at = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; k += 1) at.push(k * step);
  return { at, decimals: Math.max(0, -Math.floor(Math.log10(step) + 1e-9)) };
}

// The same for degrees, in the steps that an engineer reads.
function degreeTicks(low, high, about) {
  if (high - low < about) return ticks(low, high, about);
  const step =
    [1, 2, 5, 10, 15, 30, 45, 60, 90, 180, 360].find((each) => (high - low) / each <= about) || 360;
  const at = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; k += 1) at.push(k * step);
  return { at, decimals: 0 };
}

const minus = (text) => text.replaceAll("-", "−");

// Fixed decimals; a value that rounds to zero has no sign.
const fixed = (value, decimals) => minus((Number(value.toFixed(decimals)) + 0).toFixed(decimals));

function figure(value, digits = 4) {
  if (value === null || value === undefined || Number.isNaN(value)) return "–";
  if (typeof value === "boolean") return value ? "yes" : "no";
  if (typeof value !== "number") return String(value);
  if (Number.isInteger(value) && Math.abs(value) < 1e6) return minus(String(value));
  return minus(String(Number(value.toPrecision(digits))));
}

const withUnit = (label, unit) => (unit ? `${label} (${unit})` : label);

// Paints a plot anew over all of its element; whether that is wide enough for it.
function repaint(plot) {
  const { svg } = plot;
  const [width, height] = [svg.clientWidth, svg.clientHeight];
  if (width < 80) return false;
  set(svg, { viewBox: `0 0 ${width} ${height}` });
  svg.replaceChildren();
  plot.paint(svg, { left: 0, top: 0, right: width, bottom: height });
  return true;
}

// Calls back now and whenever the size of an element changes.
function onResize(node, callback) {
  let [width, height] = [0, 0];
  new ResizeObserver(() => {
    const { clientWidth, clientHeight } = node;
    if (clientWidth === 0 || (Math.abs(clientWidth - width) < 1 && Math.abs(clientHeight - height) < 1)) return;
    [width, height] = [clientWidth, clientHeight];
    callback();
  }).observe(node);
}
