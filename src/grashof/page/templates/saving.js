// Plots as files: pictures that need no style sheet, and tables.
const SHEET = { width: 720, curves: 400, tracks: 620, margin: 14, line: 18 };
// What becomes an attribute, of lines and of letters, with what goes without saying.
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
const LETTERS = { fill: "", "font-size": "", "font-weight": "400" };
// As `no_formula` in Python: no cell is a formula to a spreadsheet, also where it divides at semicolons.
const FORMULA = /(^|;)(?=\s*[=+\-@＝＋－＠]|[\t\r\n])/g;

// Text without what XML cannot hold.
const plain = (text) => String(text).replace(/[\u0000-\u0008\u000b\u000c\u000e-\u001f\ufffe\uffff]/g, "?");

// A plot as SVG of its own: white, with title, names of the axes and a legend.
function savedSvg(picture, heading) {
  const { width, margin } = SHEET;
  const holder = document.createElement("div");
  holder.className = "sheet";
  document.body.append(holder);
  const { panel } = picture;
  const svg = element("svg", { xmlns: "http://www.w3.org/2000/svg", "font-family": FONT });
  holder.append(svg);
  add(svg, "text", { x: margin, y: 24, class: "title" }, shortened(panel.title, width / 1.3));
  add(svg, "text", { x: margin, y: 42 }, shortened(heading, width - 2 * margin));
  const begin = legend(svg, panel, 60);
  const height = begin + (picture instanceof Tracks ? SHEET.tracks : SHEET.curves);
  const copy = Object.assign(Object.create(Object.getPrototypeOf(picture)), picture);
  const half = margin / 2;
  copy.paint(svg, { left: half, top: begin, right: width - half, bottom: height - half }, true);
  set(svg, { width, height, viewBox: `0 0 ${width} ${height}` });
  styleInlined(svg);
  svg.insertBefore(element("rect", { width, height, fill: "#ffffff" }), svg.firstChild);
  holder.remove();
  return `<?xml version="1.0" encoding="UTF-8"?>\n${plain(new XMLSerializer().serializeToString(svg))}\n`;
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
  for (const node of $$("[class]", svg)) node.removeAttribute("class");
}

// A plot as CSV: the driver angle or what else it goes over, then every line with its full name.
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
  const count = Math.max(0, ...columns.map(([, values]) => values.length));
  const rows = Array.from({ length: count }, (_, k) => columns.map(([, values]) => values[k] ?? ""));
  const lines = [columns.map(([words]) => cell(words)), ...rows].map((row) => row.join(","));
  return `\ufeff${lines.join("\n")}\n`; // spreadsheets read a table without the mark in some other code
}

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
  downloadBlob(name, new Blob([text], { type }));
}

function downloadBlob(name, blob) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 60000);
}

// The drawing as it stands, as SVG that needs no style sheet.
function savedDrawing(svg) {
  const { clientWidth: width, clientHeight: height } = svg;
  const holder = document.createElement("div");
  holder.className = "sheet";
  const copy = svg.cloneNode(true);
  for (const node of $$(".hold, .handle, .by-hand, image, title", copy)) node.remove();
  for (const name of ["id", "role", "tabindex", "style"]) copy.removeAttribute(name);
  for (const { name } of [...copy.attributes]) if (name.startsWith("aria-")) copy.removeAttribute(name);
  holder.append(copy);
  document.body.append(holder);
  set(copy, { xmlns: "http://www.w3.org/2000/svg", "font-family": FONT, width, height, viewBox: `0 0 ${width} ${height}` });
  styleInlined(copy);
  copy.removeAttribute("class");
  copy.insertBefore(element("rect", { width, height, fill: "#ffffff" }), copy.firstChild);
  holder.remove();
  return `<?xml version="1.0" encoding="UTF-8"?>\n${plain(new XMLSerializer().serializeToString(copy))}\n`;
}

// The same as a picture of three dots a pixel.
function downloadPng(name, svg, dots = 3) {
  const picture = new Image();
  picture.onload = () => {
    const canvas = document.createElement("canvas");
    Object.assign(canvas, { width: dots * picture.naturalWidth, height: dots * picture.naturalHeight });
    const context = canvas.getContext("2d");
    context.scale(dots, dots);
    context.drawImage(picture, 0, 0);
    URL.revokeObjectURL(picture.src);
    canvas.toBlob((blob) => downloadBlob(name, blob));
  };
  picture.src = URL.createObjectURL(new Blob([svg], { type: "image/svg+xml" }));
}
