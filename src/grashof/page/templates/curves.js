// Curves over the driver angle, with a mark that follows it.
const PENS = ["pen-1", "pen-2", "pen-3", "pen-4"];
const PEAK = 12; // a rate is drawn up to so many times its typical size, where it grows without bound

class Curves {
  // panel: { title, unit, series: [{ label, values }], limits } with values at `places` (deg, rising).
  constructor(figureNode, { onPick = null } = {}) {
    Object.assign(this, { svg: $("svg", figureNode), readout: $("figcaption", figureNode), onPick });
    onResize(this.svg, () => this.draw());
    if (onPick) this.picks();
  }

  show(panel, places, { bounded = false, bold = null, marks = [] } = {}) {
    Object.assign(this, { panel, places, bounded, bold, marks });
    const items = panel.series.map(({ label }, k) => {
      const item = document.createElement("span");
      item.className = `reading ${PENS[k]}`;
      item.append(label, " ", document.createElement("output"));
      return item;
    });
    const title = document.createElement("b");
    title.textContent = withUnit(panel.title, panel.unit);
    this.readout.replaceChildren(title, " ", ...items);
    this.outputs = items.map((item) => $("output", item));
    this.draw();
  }

  draw() {
    const [width, height] = [this.svg.clientWidth, this.svg.clientHeight];
    if (width < 80 || !this.panel) return;
    set(this.svg, { viewBox: `0 0 ${width} ${height}` });
    this.svg.replaceChildren();
    this.frame = { left: 46, right: width - 10, top: 6, bottom: height - 20 };
    this.axes();
    const { left, right, top, bottom } = this.frame;
    const [w, h] = [right - left, bottom - top];
    // A picture of its own cuts off what leaves the frame.
    const layer = add(this.svg, "svg", {
      x: left,
      y: top,
      width: w,
      height: h,
      viewBox: `${left} ${top} ${w} ${h}`,
    });
    this.panel.series.forEach(({ values }, k) => {
      add(layer, "path", { d: this.line(values), class: `curve ${PENS[k]}${this.bold ? " faint" : ""}` });
      if (this.bold) add(layer, "path", { d: this.line(values, this.bold), class: `curve ${PENS[k]}` });
    });
    this.cursor = add(this.svg, "path", { class: "cursor" });
    this.dots = this.panel.series.map((_, k) => add(this.svg, "circle", { r: 4, class: `dot ${PENS[k]}` }));
    if (this.marked) this.mark(...this.marked);
  }

  line(values, [from, to] = [-Infinity, Infinity]) {
    const { top, bottom } = this.frame;
    // Not far out of the frame: dashes without end take the browser a second to draw.
    const y = (value) => Math.min(Math.max(this.y(value), 2 * top - bottom), 2 * bottom - top);
    const inside = (place) => place >= from - 1e-9 && place <= to + 1e-9;
    const points = values.map((value, k) =>
      value === null || !inside(this.places[k]) ? null : [this.x(this.places[k]), y(value)],
    );
    return through(points);
  }

  axes() {
    const { left, right, top, bottom } = this.frame;
    const [first, last] = [this.places[0], this.places.at(-1)];
    const [low, high] = this.panel.limits || this.limits();
    this.x = (place) => left + ((right - left) * (place - first)) / (last - first);
    this.y = (value) => bottom - ((bottom - top) * (value - low)) / (high - low);
    const layer = add(this.svg, "g", { class: "grid" });
    const about = (bottom - top) / 26;
    const { at, decimals } =
      this.panel.unit === "deg" ? degreeTicks(low, high, about) : ticks(low, high, about);
    for (const value of at) {
      add(layer, "path", { d: `M${left} ${px(this.y(value))}H${right}`, class: value === 0 ? "zero" : "" });
      const label = Math.abs(value) >= 1e5 ? minus(value.toExponential(1)) : fixed(value, decimals);
      add(layer, "text", { x: left - 5, y: this.y(value) + 4, "text-anchor": "end" }, label);
    }
    for (const place of degreeTicks(first, last, (right - left) / 48).at) {
      add(layer, "path", { d: `M${px(this.x(place))} ${top}V${bottom}` });
      add(
        layer,
        "text",
        { x: this.x(place), y: bottom + 14, "text-anchor": "middle" },
        fixed(place, 0),
      );
    }
    for (const place of this.marks) {
      add(layer, "path", { d: `M${px(this.x(place))} ${bottom}v-7`, class: "target-mark" });
    }
  }

  limits() {
    const known = this.panel.series.flatMap(({ values }) => values).filter((value) => value !== null);
    if (!known.length) return [0, 1];
    let [low, high] = [Math.min(...known), Math.max(...known)];
    const sizes = known.map(Math.abs).sort((a, b) => a - b);
    const most = PEAK * sizes[sizes.length >> 1];
    if (this.bounded && most > 0) [low, high] = [Math.max(low, -most), Math.min(high, most)];
    const margin = 0.06 * (high - low) || 0.1 * Math.abs(high) || 1;
    return [low - margin, high + margin];
  }

  // Puts the mark at a driver angle in deg; `values` where they are known better than by the samples.
  mark(place, values = this.panel.series.map((series) => interpolated(this.places, series.values, place))) {
    this.marked = [place, values];
    this.outputs.forEach((output, k) => {
      output.textContent = figure(values[k]);
    });
    if (!this.cursor) return;
    const { top, bottom } = this.frame;
    set(this.cursor, { d: `M${px(this.x(place))} ${top}V${bottom}` });
    this.dots.forEach((dot, k) => {
      const y = values[k] === null ? NaN : this.y(values[k]);
      const seen = y >= top - 1 && y <= bottom + 1;
      set(dot, { cx: px(this.x(place)), cy: seen ? px(y) : 0, visibility: seen ? "visible" : "hidden" });
    });
  }

  picks() {
    const pick = (event) => {
      const { left, right } = this.frame;
      const at = event.clientX - this.svg.getBoundingClientRect().left;
      const share = Math.min(Math.max((at - left) / (right - left), 0), 1);
      this.onPick(this.places[0] + share * (this.places.at(-1) - this.places[0]));
    };
    this.svg.addEventListener("pointerdown", (event) => {
      event.preventDefault();
      this.svg.setPointerCapture(event.pointerId);
      pick(event);
    });
    this.svg.addEventListener("pointermove", (event) => {
      if (this.svg.hasPointerCapture(event.pointerId)) pick(event);
    });
  }
}
