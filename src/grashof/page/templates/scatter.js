// A plot of designs, each a node by its index: one is chosen, by a click or by keys, and some are filtered out.
class Choices {
  svg; columns; designs; nodes; visible; chosen; onPick;

  constructor(root, { columns, designs, onPick }) {
    Object.assign(this, { svg: $("svg", root), columns, designs, onPick, chosen: 0, visible: new Set(designs.keys()) });
    this.svg.addEventListener("keydown", (event) => this.key(event));
    onResize(this.svg, () => this.draw());
  }

  // The steps of the arrow keys, and the design at a step from another one: different for each kind of plot.
  get steps() {
    return {};
  }

  next(_index, _step) {}

  // Into a box of a drawing.
  paint(_svg, _box) {}

  draw() {
    repaint(this);
  }

  // The chosen design has a ring or frame, and is where the tab key enters.
  mark(index) {
    this.chosen = index;
    if (!this.nodes) return;
    const entered = this.nodes.has(index) ? index : Math.min(...this.nodes.keys());
    for (const [k, node] of this.nodes) {
      node.classList.toggle("chosen", k === index);
      node.classList.toggle("filtered", !this.visible.has(k));
      node.setAttribute("aria-pressed", String(k === index));
      node.tabIndex = k === entered ? 0 : -1;
    }
    const node = this.nodes.get(index);
    // On top of the others, but not while the focus is here: moving a node drops it.
    if (node && !this.svg.contains(document.activeElement)) node.parentNode.append(node);
  }

  filter(visible) {
    this.visible = new Set(visible);
    this.mark(this.chosen);
  }

  // Arrows go from one to the next, Enter and space pick.
  key(event) {
    const at = event.target.closest("[data-index]");
    const step = this.steps[event.key];
    if (!at || !(step || event.key === "Enter" || event.key === " ")) return;
    event.preventDefault();
    event.stopPropagation();
    const index = Number(at.dataset.index);
    if (!step) {
      this.onPick(index);
      return;
    }
    const next = this.nodes.get(this.next(index, step));
    if (!next) return;
    for (const node of this.nodes.values()) node.tabIndex = -1;
    next.tabIndex = 0;
    next.focus();
  }
}

// Designs by two quantities, a third as the area of the points.
class Scatter extends Choices {
  called;

  // wanted: keys of the first choice for each axis; called: the word for a design.
  constructor(root, { columns, designs, wanted = {}, called = "design", onPick }) {
    super(root, { columns, designs, onPick });
    this.called = called;
    this.selects = Object.fromEntries($$("select", root).map((select) => [select.dataset.axis, select]));
    const usual = {
      x: ["size"],
      y: [...this.differing(), "transmission_min_task_deg", "transmission_min_cycle_deg"],
      area: ["torque_peak", ""],
    };
    for (const [axis, select] of Object.entries(this.selects)) {
      const offered = columns.map(({ key, label, unit }) => new Option(withUnit(label, unit), key));
      select.append(...(axis === "area" ? [new Option("none", "")] : []), ...offered);
      const keys = [...select.options].map(({ value }) => value);
      select.value = [...(wanted[axis] || []), ...usual[axis], keys[0]].find((key) => keys.includes(key));
      select.addEventListener("change", () => this.draw());
    }
  }

  // Errors that designs are chosen by, where they differ by more than rounding.
  differing() {
    return ["error", "structural_error_max_deg", "structural_error_max"].filter((key) => {
      const column = this.columns.find((each) => each.key === key);
      const [low, high] = extent(this.designs.map(({ figures }) => figures[key])) || [0, 0];
      return column && high - low > Math.max(column.noise || 0, 1e-6 * high);
    });
  }

  // Heading of its file: empty, since it has no lines.
  get panel() {
    const [up, across] = ["y", "x"].map((axis) => this.column(axis).label);
    return { title: `${up} against ${across}`, series: [] };
  }

  column(axis) {
    return this.columns.find(({ key }) => key === this.selects[axis].value);
  }

  value(index, axis) {
    const column = this.column(axis);
    return column ? this.designs[index].figures[column.key] : null;
  }

  paint(svg, box) {
    const top = box.top + 8;
    const bottom = box.bottom - 34;
    this.shown = [...this.designs.keys()].filter(
      (k) => this.value(k, "x") !== null && this.value(k, "y") !== null,
    );
    const up = this.limits("y");
    const numbers = ticksAlong(...up, bottom - top, false, 36);
    const frame = {
      left: box.left + Math.max(46, longest(numbers) + 10),
      right: box.right - 14,
      top,
      bottom,
    };
    const across = this.limits("x");
    const along = ticksAlong(...across, frame.right - frame.left, false, 70);
    const scales = { x: this.axis(svg, "x", frame, across, along), y: this.axis(svg, "y", frame, up, numbers) };
    this.place = (k) => [scales.x(this.value(k, "x")), scales.y(this.value(k, "y"))];
    this.front(svg);
    const layer = add(svg, "g", { class: "points" });
    // Big ones first, so that none is hidden.
    const order = [...this.shown].sort((a, b) => this.radius(b) - this.radius(a));
    this.nodes = new Map(order.map((k) => [k, this.point(layer, k)]));
    this.mark(this.chosen);
  }

  limits(axis) {
    const [low, high] = extent(this.shown.map((k) => this.value(k, axis))) || [0, 1];
    const margin = Math.max(0.08 * (high - low), 1e-3 * Math.abs(high)) || 1; // more than rounding
    return [low - margin, high + margin];
  }

  axis(svg, axis, { left, right, top, bottom }, /** @type {number[]} */ [low, high], numbers) {
    const share = (value) => (value - low) / (high - low);
    const scale =
      axis === "x"
        ? (value) => left + (right - left) * share(value)
        : (value) => bottom - (bottom - top) * share(value);
    const layer = add(svg, "g", { class: "grid" });
    for (const { value, text } of numbers) {
      const place = px(scale(value));
      if (axis === "x") {
        add(layer, "path", { d: `M${place} ${top}V${bottom}` });
        add(layer, "text", { x: place, y: bottom + 14, "text-anchor": "middle" }, text);
      } else {
        add(layer, "path", { d: `M${left} ${place}H${right}` });
        add(layer, "text", { x: left - 5, y: Number(place) + 4, "text-anchor": "end" }, text);
      }
    }
    const { label, unit } = this.column(axis);
    const place =
      axis === "x" ? { x: right, y: bottom + 29, "text-anchor": "end" } : { x: left + 5, y: top + 9 };
    add(layer, "text", { ...place, class: "axis" }, withUnit(label, unit));
    return scale;
  }

  radius(k) {
    const values = this.shown.map((each) => this.value(each, "area")).filter((value) => value !== null);
    const value = this.value(k, "area");
    if (value === null || !values.length) return 5;
    const [low, high] = [Math.min(...values), Math.max(...values)];
    const share = high > low ? (value - low) / (high - low) : 0.5;
    return Math.sqrt(12 + 70 * share);
  }

  // A step line through the designs that no other beats in both axes.
  front(svg) {
    const better = { x: this.column("x").better, y: this.column("y").better };
    if (!better.x || !better.y) return;
    const gain = (k, axis) => better[axis] * this.value(k, axis);
    const best = [];
    for (const k of [...this.shown].sort(
      (a, b) => gain(b, "x") - gain(a, "x") || gain(b, "y") - gain(a, "y"),
    )) {
      if (!best.length || gain(k, "y") > gain(best.at(-1), "y")) best.push(k);
    }
    const corners = best.flatMap((k, n) => {
      const [x, y] = this.place(k);
      return n
        ? [
            [x, this.place(best[n - 1])[1]],
            [x, y],
          ]
        : [[x, y]];
    });
    add(svg, "path", { d: through(corners), class: "front" });
  }

  point(layer, k) {
    const { figures } = this.designs[k];
    const [cx, cy] = this.place(k);
    const values = ["x", "y", "area"]
      .map((axis) => this.column(axis))
      .filter(Boolean)
      .map(({ key, label, unit, noise }) => `${label} ${rounded(figures[key], null, noise)} ${unit}`.trim());
    const name = `${this.called} ${figures.rank}: ${values.join(", ")}${figures.pareto ? ", Pareto-optimal" : ""}`;
    const style = `point${figures.pareto ? " pareto" : ""}`;
    const node = add(layer, "circle", {
      cx,
      cy,
      r: this.radius(k),
      class: style,
      tabindex: -1,
      role: "button",
      "aria-label": name,
      "data-index": k,
    });
    add(node, "title", {}, name);
    node.addEventListener("click", () => this.onPick(k));
    return node;
  }

  get steps() {
    return { ArrowRight: 1, ArrowUp: 1, ArrowLeft: -1, ArrowDown: -1 };
  }

  // Along the x axis, around.
  next(index, step) {
    const order = [...this.shown].sort((a, b) => this.place(a)[0] - this.place(b)[0]);
    return order[(order.indexOf(index) + step + order.length) % order.length];
  }
}
