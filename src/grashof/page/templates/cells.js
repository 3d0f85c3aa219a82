// Combinations of two numbers as a grid of cells, coloured by a third.
const CELLS = { least: 14, wide: 46, dark: 0.55 }; // px from which a cell has its number, and its colour that needs a light one

class Cells extends Choices {
  across; up; note;

  // axes: the keys across and up; measure: the key of the first choice for the colour of the cells.
  constructor(root, { columns, designs, axes, measure, onPick }) {
    super(root, { columns, designs, onPick });
    this.note = $("figcaption", root);
    [this.across, this.up] = axes.map((key) => columns.find((column) => column.key === key));
    this.select = $("select", root);
    const measures = columns.filter(({ key }) => !axes.includes(key));
    this.select.append(...measures.map(({ key, label, unit }) => new Option(withUnit(label, unit), key)));
    this.select.value = measures.some(({ key }) => key === measure) ? measure : measures[0].key;
    this.select.addEventListener("change", () => this.draw());
  }

  get measure() {
    return this.columns.find(({ key }) => key === this.select.value);
  }

  get panel() {
    const { label, unit } = this.measure;
    return { title: withUnit(label, unit), series: [] };
  }

  value(index, column) {
    return this.designs[index].figures[column.key];
  }

  places(column) {
    return [...new Set(this.designs.map(({ figures }) => figures[column.key]))].sort((a, b) => a - b);
  }

  // Stronger colours are better, where one side of the measure is.
  paint(svg, box) {
    const [xs, ys] = [this.places(this.across), this.places(this.up)];
    const rows = ys.map((value) => ({ text: figure(value) }));
    const frame = { left: box.left + 28 + longest(rows), right: box.right - 8, top: box.top + 6, bottom: box.bottom - 40 };
    const [wide, high] = [(frame.right - frame.left) / xs.length, (frame.bottom - frame.top) / ys.length];
    const layer = add(svg, "g", { class: "cells" });
    this.range = extent(this.designs.map((_, k) => this.value(k, this.measure)));
    this.nodes = new Map();
    this.designs.forEach((_, k) => {
      const [x, y] = [xs.indexOf(this.value(k, this.across)), ys.indexOf(this.value(k, this.up))];
      const corner = [frame.left + wide * x, frame.bottom - high * (y + 1)];
      this.nodes.set(k, this.cell(layer, k, corner, wide, high));
    });
    this.numbers(svg, frame, xs, rows, wide, high);
    this.mark(this.chosen);
    const [low, most] = this.range || [0, 0];
    const [pale, strong] = this.measure.better < 0 ? ["strong", "pale"] : ["pale", "strong"];
    this.note.textContent = this.range
      ? `${withUnit(this.measure.label, this.measure.unit)} from ${figure(low)} (${pale}) to ${figure(most)} (${strong}). A click picks a combination.`
      : "No combination has one. A click picks a combination.";
  }

  cell(layer, k, /** @type {number[]} */ [left, top], wide, high) {
    const { figures } = this.designs[k];
    const { key, label, unit } = this.measure;
    const value = figures[key];
    const name = `combination ${figures.rank}: ${value === null ? "no design" : `${withUnit(label, unit)} ${figure(value)}`}`;
    const node = add(layer, "g", { class: "cell", tabindex: -1, role: "button", "aria-label": name, "data-index": k });
    const share = this.share(value);
    const d = `M${px(left + 0.5)} ${px(top + 0.5)}h${px(wide - 1)}v${px(high - 1)}h${px(1 - wide)}Z`;
    add(node, "path", { d, class: value === null ? "empty" : "full", "fill-opacity": value === null ? 1 : px(0.12 + 0.8 * share) });
    add(node, "title", {}, name);
    if (wide >= CELLS.wide && high >= CELLS.least) {
      const style = value !== null && share > CELLS.dark ? "light" : "";
      const middle = { x: px(left + wide / 2), y: px(top + high / 2 + 4), "text-anchor": "middle", class: style };
      add(node, "text", middle, value === null ? "none" : figure(value));
    }
    node.addEventListener("click", () => this.onPick(k));
    return node;
  }

  // From 0, the worst, to 1.
  share(value) {
    if (value === null || !this.range) return 0;
    const [low, high] = this.range;
    const share = high - low > 1e-6 * Math.abs(high) ? (value - low) / (high - low) : 0.5;
    return this.measure.better < 0 ? 1 - share : share;
  }

  numbers(svg, frame, xs, rows, wide, high) {
    const { left, right, top, bottom } = frame;
    const columns = xs.map((value) => ({ text: figure(value) }));
    const every = Math.ceil((longest(columns) + 8) / wide);
    columns.forEach(({ text }, k) => {
      if (k % every) return;
      add(svg, "text", { x: px(left + wide * (k + 0.5)), y: bottom + 14, "text-anchor": "middle" }, text);
    });
    rows.forEach(({ text }, k) => {
      if (k % Math.ceil(CELLS.least / high)) return;
      add(svg, "text", { x: left - 5, y: px(bottom - high * (k + 0.5) + 4), "text-anchor": "end" }, text);
    });
    const named = (column, length) => shortened(withUnit(column.label, column.unit), length);
    const across = { x: px((left + right) / 2), y: bottom + 31, "text-anchor": "middle", class: "axis" };
    add(svg, "text", across, named(this.across, right - left));
    const [x, y] = [left - longest(rows) - 14, px((top + bottom) / 2)];
    const up = { x, y, "text-anchor": "middle", class: "axis", transform: `rotate(-90 ${x} ${y})` };
    add(svg, "text", up, named(this.up, bottom - top));
  }

  get steps() {
    return { ArrowRight: [1, 0], ArrowLeft: [-1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
  }

  next(index, step) {
    const wanted = [this.across, this.up].map((column, axis) => {
      const places = this.places(column);
      return places[places.indexOf(this.value(index, column)) + step[axis]];
    });
    return this.designs.findIndex((_, k) =>
      [this.across, this.up].every((column, axis) => this.value(k, column) === wanted[axis]),
    );
  }
}
