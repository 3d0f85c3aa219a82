// The table of designs: sorted by its headers, filtered by the form above it.
class DesignTable {
  constructor(root, { designs, onPick, onFilter, onCompare }) {
    Object.assign(this, { designs, onFilter, body: $("tbody", root), form: $("form", root) });
    this.rows = $$("tr", this.body);
    this.none = $("[data-none]", root);
    this.headers = $$("th[aria-sort]", root);
    for (const header of this.headers) {
      $("button", header).addEventListener("click", () => this.sort(header));
    }
    this.body.addEventListener("click", (event) => {
      const row = event.target.closest("tr");
      if (row && !event.target.closest("label")) onPick(Number(row.dataset.index));
    });
    for (const box of $$("input[data-compare]", this.body)) {
      box.addEventListener("change", () => onCompare(Number(box.closest("tr").dataset.index), box.checked));
    }
    this.form.addEventListener("input", () => this.filter());
    this.form.addEventListener("reset", () => setTimeout(() => this.filter()));
    this.form.addEventListener("submit", (event) => event.preventDefault());
  }

  // By a header, the other way round when it is sorted already; what is not known goes last.
  sort(header) {
    const rising = header.getAttribute("aria-sort") === "ascending";
    const first = header.getAttribute("aria-sort") === "none" ? header.dataset.first : null;
    const order = first || (rising ? "descending" : "ascending");
    for (const each of this.headers) each.setAttribute("aria-sort", each === header ? order : "none");
    const sign = order === "ascending" ? 1 : -1;
    const key = header.dataset.key;
    const value = (row) => this.designs[Number(row.dataset.index)].figures[key];
    const compared = (a, b) => {
      if (a === null || b === null) return (a === null) - (b === null);
      return sign * (typeof a === "string" ? a.localeCompare(b) : a - b);
    };
    this.rows.sort((a, b) => compared(value(a), value(b)) || a.dataset.index - b.dataset.index);
    this.body.append(...this.rows);
  }

  filter() {
    const wanted = new FormData(this.form);
    const text = wanted.get("text").trim().toLowerCase();
    const [least, most] = [wanted.get("transmission"), wanted.get("size")];
    const passes = (row, { id, figures }) =>
      `${figures.rank} ${id} ${figures.grashof_class}`.toLowerCase().includes(text) &&
      (!wanted.get("class") || figures.grashof_class === wanted.get("class")) &&
      (!least || this.shown(row, this.form.elements.transmission.dataset.key) >= Number(least)) &&
      (!most || this.shown(row, "size") <= Number(most)) &&
      (!wanted.get("pareto") || figures.pareto);
    for (const row of this.rows) row.hidden = !passes(row, this.designs[Number(row.dataset.index)]);
    const shown = this.listed();
    this.none.hidden = shown.length > 0;
    $("output", this.form).textContent = `${shown.length} of ${this.rows.length}`;
    this.onFilter(shown);
  }

  // A number as the table shows it, rounded; NaN where it is not known.
  shown(row, key) {
    const { cellIndex } = this.headers.find((header) => header.dataset.key === key);
    return Number(row.cells[cellIndex].textContent);
  }

  // Designs as listed now, by their index.
  listed() {
    return this.rows.filter((row) => !row.hidden).map((row) => Number(row.dataset.index));
  }

  mark(index) {
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
      const design = this.designs[Number(row.dataset.index)];
      $(".thumb", row).replaceWith(thumbnail(design));
    }
  }
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
  const { o2, o4, a, b, p } = positionOf(linkage, theta2[theta2.length >> 1]);
  const points = [...path, o2, o4, a, b, p];
  const [xs, ys] = [points.map((point) => point[0]), points.map((point) => point[1])];
  const [left, right, bottom, top] = [Math.min(...xs), Math.max(...xs), Math.min(...ys), Math.max(...ys)];
  const unit = Math.min((width - 8) / (right - left || 1), (height - 8) / (top - bottom || 1));
  const at = ([x, y]) => [
    width / 2 + unit * (x - (left + right) / 2),
    height / 2 - unit * (y - (bottom + top) / 2),
  ];
  add(svg, "path", { d: through(path.map(at)), class: "trace" });
  add(svg, "path", { d: through([a, b, p].map(at), true), class: "coupler" });
  add(svg, "path", { d: through([o2, a].map(at)), class: "driver" });
  add(svg, "path", { d: through([o4, b].map(at)), class: "output" });
  for (const pivot of [o2, o4]) {
    const [cx, cy] = at(pivot);
    add(svg, "circle", { cx: px(cx), cy: px(cy), r: 2, class: "pivot" });
  }
  return svg;
}
