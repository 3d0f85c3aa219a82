// The table of designs: sorted by its headers, filtered by the form above it.
class DesignTable {
  body; form; designs; open; onFilter;

  constructor(root, { designs, onPick, onFilter, onCompare }) {
    Object.assign(this, { designs, onFilter, body: $("tbody", root), form: $("form", root), open: new Set() });
    this.rows = $$("tr", this.body);
    this.none = $("[data-none]", root);
    this.headers = $$("th[aria-sort]", root);
    for (const header of this.headers) {
      $("button", header).addEventListener("click", () => this.sort(header));
    }
    this.body.addEventListener("click", (event) => {
      const row = event.target.closest("tr");
      if (event.target.closest("[data-alike]")) this.toggle(this.design(row).figures.family);
      else if (row && !event.target.closest("label")) onPick(Number(row.dataset.index));
    });
    for (const box of $$("input[data-compare]", this.body)) {
      box.addEventListener("change", () => onCompare(Number(box.closest("tr").dataset.index), box.checked));
    }
    this.form.addEventListener("input", () => this.filter());
    this.form.addEventListener("reset", () => setTimeout(() => this.filter()));
    this.form.addEventListener("submit", (event) => event.preventDefault());
    this.filter();
  }

  design(row) {
    return this.designs[Number(row.dataset.index)];
  }

  // Show the other designs of a family, or no longer.
  toggle(family) {
    if (!this.open.delete(family)) this.open.add(family);
    this.filter();
  }

  sort(header) {
    sortRows(this.rows, this.headers, header, (index) => this.designs[index].figures[header.dataset.key]);
    this.arrange();
  }

  // Rows as sorted, the others of an open family behind the one that stands for it.
  arrange() {
    const place = new Map(this.rows.map((row, k) => [row, k]));
    const behind = (row) => Number(row.classList.contains("member"));
    const first = (row) => place.get(behind(row) ? this.first.get(this.design(row).figures.family) : row);
    this.arranged = [...this.rows].sort((a, b) => first(a) - first(b) || behind(a) - behind(b));
    this.body.append(...this.arranged);
  }

  filter() {
    const wanted = new FormData(this.form);
    const text = String(wanted.get("text")).trim().toLowerCase();
    const [least, most] = [wanted.get("transmission"), wanted.get("size")];
    const passes = (row, { id, figures }) =>
      `${figures.rank} ${id} ${figures.grashof_class} ${figures.best_at || ""}`.toLowerCase().includes(text) &&
      (!wanted.get("class") || figures.grashof_class === wanted.get("class")) &&
      (!least || this.shown(row, this.form.elements.transmission.dataset.key) >= Number(least)) &&
      (!most || this.shown(row, "size") <= Number(most)) &&
      (!wanted.get("pareto") || figures.pareto);
    for (const row of this.rows) row.hidden = !passes(row, this.design(row));
    this.passing = this.listed();
    this.fold(Boolean(wanted.get("fold")));
    this.arrange();
    this.none.hidden = this.passing.length > 0;
    const families = this.first.size < this.passing.length ? ` in ${this.first.size} families` : "";
    $("output", this.form).textContent = `${this.passing.length} of ${this.rows.length}${families}`;
    this.onFilter(this.passing);
  }

  // Of each family one row stands for the others: the best that passes the filter.
  fold(folded) {
    const sizes = new Map();
    this.first = new Map();
    for (const row of [...this.rows].sort((a, b) => Number(a.dataset.index) - Number(b.dataset.index))) {
      const { family } = this.design(row).figures;
      const behind = this.first.has(family);
      const button = $("[data-alike]", row);
      if (button) button.hidden = true;
      row.classList.toggle("member", folded && behind && !row.hidden);
      if (row.hidden) continue;
      if (!behind) this.first.set(family, row);
      sizes.set(family, (sizes.get(family) || 0) + 1);
      row.hidden = folded && behind && !this.open.has(family);
    }
    for (const [family, row] of this.first) {
      const button = $("[data-alike]", row);
      if (!button || !folded || sizes.get(family) < 2) continue;
      button.hidden = false;
      button.textContent = `${sizes.get(family) - 1} like this`;
      button.setAttribute("aria-expanded", String(this.open.has(family)));
    }
  }

  // A number as the table shows it, rounded; NaN where it is not known.
  shown(row, key) {
    const { cellIndex } = this.headers.find((header) => header.dataset.key === key);
    return Number(row.cells[cellIndex].textContent);
  }

  // Designs as listed now, by their index.
  listed() {
    return (this.arranged || this.rows).filter((row) => !row.hidden).map((row) => Number(row.dataset.index));
  }

  // The chosen design; its family opens where another one stands for it.
  mark(index) {
    const { family } = this.designs[index].figures;
    if (this.passing.includes(index) && !this.listed().includes(index)) this.toggle(family);
    for (const row of this.rows) {
      const chosen = Number(row.dataset.index) === index;
      row.classList.toggle("chosen", chosen);
      $("[data-pick]", row).setAttribute("aria-pressed", String(chosen));
    }
  }

  compared(index, checked) {
    const row = this.rows.find((each) => Number(each.dataset.index) === index);
    const box = $("input[data-compare]", row);
    if (box) box.checked = checked;
  }

  // Small pictures: the path of P and the linkage halfway through the task.
  pictures() {
    for (const row of this.rows) {
      $(".thumb", row).replaceWith(thumbnail(this.design(row)));
    }
  }
}

// Rows by the value of each index, the other way round when their header is sorted already; unknown values go last.
function sortRows(rows, headers, header, value) {
  const now = header.getAttribute("aria-sort");
  const turned = now === "ascending" ? "descending" : "ascending";
  const order = now === "none" ? header.dataset.first : turned;
  for (const each of headers) each.setAttribute("aria-sort", each === header ? order : "none");
  const sign = order === "ascending" ? 1 : -1;
  const compared = (a, b) => {
    if (a === null || b === null) return Number(a === null) - Number(b === null);
    return sign * (typeof a === "number" && typeof b === "number" ? a - b : String(a).localeCompare(String(b)));
  };
  const index = (row) => Number(row.dataset.index);
  rows.sort((a, b) => compared(value(index(a)), value(index(b))) || index(a) - index(b));
}

function thumbnail(design, width = 66, height = 44) {
  const svg = element("svg", {
    class: "thumb",
    viewBox: `0 0 ${width} ${height}`,
    width,
    height,
    "aria-hidden": "true",
  });
  const { theta2, linkage, low, high } = design;
  const path = pathOf(linkage, anglesBetween(low, high, design.turns, 36), 0.04).points;
  const state = positionOf(linkage, theta2[theta2.length >> 1]);
  const points = [...path, ...drawnPoints(design, state)];
  const [xs, ys] = [points.map((point) => point[0]), points.map((point) => point[1])];
  const [left, right, bottom, top] = [Math.min(...xs), Math.max(...xs), Math.min(...ys), Math.max(...ys)];
  const unit = Math.min((width - 8) / (right - left || 1), (height - 8) / (top - bottom || 1));
  const at = ([x, y]) => [
    width / 2 + unit * (x - (left + right) / 2),
    height / 2 - unit * (y - (bottom + top) / 2),
  ];
  add(svg, "path", { d: through(path.map(at)), class: "trace" });
  for (const [, style, d] of partsOf(design, state, at, BLOCK / 2 / unit)) {
    add(svg, "path", { d, class: style });
  }
  for (const name of kindOf(linkage).ground) {
    const [cx, cy] = at(state[name]);
    add(svg, "circle", { cx: px(cx), cy: px(cy), r: 2, class: "pivot" });
  }
  return svg;
}

// A value with fixed decimals, or with few digits; an error that is only rounding is marked so.
function rounded(value, decimals, noise) {
  if (typeof value !== "number") return figure(value);
  if (value !== 0 && Math.abs(value) <= noise) return "≈ 0";
  return decimals === null ? figure(value) : fixed(value, decimals);
}
