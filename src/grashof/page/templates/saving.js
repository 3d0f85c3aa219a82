// Plots and drawings as files: pictures that need no style sheet, and tables.
const SHEET = { width: 720, curves: 400, tracks: 620, margin: 14, line: 18 };
// Styles that become attributes, of lines and of letters, with their defaults.
const SAVED = {
  fill: "",
  "fill-opacity": "1",
  stroke: "none",
  "stroke-width": "1px",
  "stroke-dasharray": "none",
  "stroke-linecap": "butt",
  "stroke-linejoin": "miter",
  opacity: "1",
};
const LETTERS = {
  fill: "",
  "font-size": "",
  "font-weight": "400",
  stroke: "none",
  "stroke-width": "1px",
  "paint-order": "normal",
};
const SCREEN = ["class", "id", "style", "role", "tabindex"]; // and aria-…, data-…
const FINE = 2; // pixels of a picture to one of the screen
// As `no_formula` in Python: no cell is a formula to a spreadsheet, also where it divides at semicolons.
const FORMULA = /(^|;)(?=\s*[=+\-@＝＋－＠]|[\t\r\n])/g;

// Text without the characters that XML forbids.
const plain = (text) => String(text).replace(/[\u0000-\u0008\u000b\u000c\u000e-\u001f\ufffe\uffff]/g, "?");

// A plot as SVG of its own: white, with title, names of the axes and a legend.
function savedSvg(picture, heading) {
  const { width, margin } = SHEET;
  const holder = sheet();
  const { panel } = picture;
  const svg = element("svg", { xmlns: "http://www.w3.org/2000/svg", "font-family": FONT });
  holder.append(svg);
  add(svg, "text", { x: margin, y: 24, class: "title" }, shortened(panel.title, width / 1.3));
  add(svg, "text", { x: margin, y: 42 }, shortened(heading, width - 2 * margin));
  const begin = legend(svg, panel, 60);
  const height = begin + (picture.tall ? SHEET.tracks : SHEET.curves);
  const copy = Object.assign(Object.create(Object.getPrototypeOf(picture)), picture);
  const half = margin / 2;
  copy.paint(svg, { left: half, top: begin, right: width - half, bottom: height - half }, true);
  return savedSheet(holder, svg, width, height);
}

// A drawing of the page as SVG of its own, as it is at this moment.
function savedDrawing(drawn) {
  const { clientWidth: width, clientHeight: height } = drawn;
  const holder = sheet();
  const svg = set(drawn.cloneNode(true), { xmlns: "http://www.w3.org/2000/svg", "font-family": FONT });
  holder.append(svg);
  for (const node of $$(".hold, .handle, .by-hand, image, title", svg)) node.remove();
  return savedSheet(holder, svg, width, height);
}

// Where saved drawings have the light colours of paper.
function sheet() {
  const holder = document.createElement("div");
  holder.className = "sheet";
  document.body.append(holder);
  return holder;
}

function savedSheet(holder, svg, width, height) {
  set(svg, { width, height, viewBox: `0 0 ${width} ${height}` });
  styleInlined(svg);
  svg.insertBefore(element("rect", { width, height, fill: "#ffffff" }), svg.firstChild);
  holder.remove();
  return `<?xml version="1.0" encoding="UTF-8"?>\n${plain(new XMLSerializer().serializeToString(svg))}\n`;
}

// The same as PNG, as fine as print needs it.
async function savedPng(text) {
  const image = new Image();
  image.src = `data:image/svg+xml;charset=utf-8,${encodeURIComponent(text)}`;
  await image.decode();
  const canvas = document.createElement("canvas");
  [canvas.width, canvas.height] = [FINE * image.width, FINE * image.height];
  canvas.getContext("2d").drawImage(image, 0, 0, canvas.width, canvas.height);
  return new Promise((resolve) => canvas.toBlob(resolve, "image/png"));
}

// Buttons of a picture: `svg` makes it, `csv` its numbers; `file` names both.
function offerSaves(node, title, file, { svg = null, csv = null }) {
  const savers = {
    SVG: () => download(`${file()}.svg`, svg(), "image/svg+xml"),
    PNG: async () => download(`${file()}.png`, await savedPng(svg()), "image/png"),
    CSV: () => download(`${file()}.csv`, csv(), "text/csv"),
  };
  for (const button of $$("button", node)) {
    button.setAttribute("aria-label", `Save ${title} as ${button.textContent}`);
    button.addEventListener("click", savers[button.textContent]);
  }
}

// Names of lines and points in rows; returns where the plot begins below them.
function legend(svg, panel, top) {
  const { width, margin, line } = SHEET;
  const lines = panel.series.map(({ label }, k) => [label, `curve ${pen(k)}`, "M-12 0H12"]);
  const spots = (panel.points || []).map(({ label }, k) => [label, `spot ${spotPen(k)}`, spot(k)]);
  let [x, y] = [margin, top];
  for (const [label, style, d] of [...lines, ...spots]) {
    const text = shortened(label, width - 2 * margin - 30);
    const wide = 30 + textWidth(text) + 16;
    if (x > margin && x + wide > width - margin) [x, y] = [margin, y + line];
    add(svg, "path", { d, class: style, transform: `translate(${px(x + 12)} ${y - 4})` });
    add(svg, "text", { x: px(x + 30), y, class: "name" }, text);
    x += wide;
  }
  return y + 8;
}

// Every style that shows becomes an attribute, and no class is left.
function styleInlined(svg) {
  for (const node of $$("path, text, circle", svg)) {
    const style = getComputedStyle(node);
    for (const [name, usual] of Object.entries(node.tagName === "text" ? LETTERS : SAVED)) {
      const value = style.getPropertyValue(name);
      if (value !== usual) node.setAttribute(name, value.replaceAll("px", ""));
    }
  }
  for (const node of $$("g", svg)) {
    const { opacity } = getComputedStyle(node);
    if (opacity !== "1") node.setAttribute("opacity", opacity);
  }
  for (const node of [svg, ...$$("*", svg)]) {
    for (const { name } of [...node.attributes]) {
      if (SCREEN.includes(name) || /^(aria|data)-/.test(name)) node.removeAttribute(name);
    }
  }
}

// A plot as CSV: the driver angle or its other variable, then every line with its full name.
function savedCsv({ title, unit, over, driver, places, angles, series, points = [] }) {
  const columns = [];
  const column = (words, values) => columns.push([words, values]);
  if (places) {
    if (angles && angles !== places) column(driver, angles);
    column(over || driver, places);
    for (const { label, values } of series) column(withUnit(`${title}, ${label}`, unit), values);
  } else {
    if (angles) column(driver, angles);
    for (const { label, xy } of series) {
      xy.forEach((values, axis) => column(withUnit(`${title}, ${label}, ${"xy"[axis]}`, unit), values));
    }
  }
  for (const { label, xy } of points) {
    column(places ? `${label}, ${over || driver}` : withUnit(`${label}, x`, unit), xy[0]);
    column(withUnit(places ? label : `${label}, y`, unit), xy[1]);
  }
  return csvOf(columns);
}

// Columns of words and values below them.
function csvOf(columns) {
  const count = Math.max(0, ...columns.map(([, values]) => values.length));
  const rows = Array.from({ length: count }, (_, k) => columns.map(([, values]) => field(values[k] ?? "")));
  const lines = [columns.map(([words]) => cell(words)), ...rows].map((row) => row.join(","));
  return `\ufeff${lines.join("\n")}\n`; // spreadsheets read a table without the mark in some other code
}

const field = (value) => (typeof value === "string" ? cell(value) : value);

function cell(words) {
  const text = plain(words).replace(FORMULA, "$1'");
  return /[",;\r\n]|^\s|\s$/.test(text) ? `"${text.replaceAll('"', '""')}"` : text;
}

// A name that every system takes, of letters and digits.
function fileName(...parts) {
  const words = parts.map((part) => part.replace(/[^\p{L}\p{N}._-]+/gu, "-").replace(/^[.-]+|[.-]+$/g, ""));
  return words.filter(Boolean).join("-").slice(0, 120);
}

function download(name, text, type) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([text], { type }));
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 60000);
}
