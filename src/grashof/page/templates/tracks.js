// Tracks in a plane, with equal scales, and a mark on each where their driver angles are known.
class Tracks extends Picture {
  // panel: { title, unit, series: [{ label, xy: [xs, ys] }] }; besides `angles`, `points`, and `most` with
  // `middle`: how far from which point the view reaches.
  show(panel, options = {}) {
    const follows = this.panel;
    super.show(panel, options);
    if (follows || !panel.angles || !this.onPick) return;
    this.follow((at) => this.pick(at));
    this.svg.classList.add("picks");
  }

  get tall() {
    return true;
  }

  paint(svg, box, named = false) {
    const [xs, ys] = [0, 1].map((axis) => margined(this.reach(axis), 0.05));
    const [width, height] = [box.right - box.left, box.bottom - box.top];
    const below = named ? 36 : 20;
    const rough = ticksAlong(...ys, height - below - 6, false, 40);
    const left = box.left + Math.max(46, longest(rough) + 10) + (named ? 18 : 0);
    this.frame = { left, right: box.left + width - 10, top: box.top + 6, bottom: box.bottom - below };
    const { right, top, bottom } = this.frame;
    const unit = Math.min((right - left) / (xs[1] - xs[0]), (bottom - top) / (ys[1] - ys[0]));
    const x0 = (left + right) / 2 - (unit * (xs[0] + xs[1])) / 2;
    const y0 = (top + bottom) / 2 + (unit * (ys[0] + ys[1])) / 2;
    this.at = (x, y) => [x0 + unit * x, y0 - unit * y];
    const grid = add(svg, "g", { class: "grid" });
    for (const { value, text } of ticksAlong((left - x0) / unit, (right - x0) / unit, right - left, false)) {
      const x = px(x0 + unit * value);
      add(grid, "path", { d: `M${x} ${top}V${bottom}`, class: value === 0 ? "zero" : "" });
      add(grid, "text", { x, y: bottom + 14, "text-anchor": "middle" }, text);
    }
    const [low, high] = [(y0 - bottom) / unit, (y0 - top) / unit];
    for (const { value, text } of ticksAlong(low, high, bottom - top, false, 40)) {
      const y = y0 - unit * value;
      add(grid, "path", { d: `M${px(left)} ${px(y)}H${right}`, class: value === 0 ? "zero" : "" });
      add(grid, "text", { x: left - 5, y: px(y + 4), "text-anchor": "end" }, text);
    }
    this.panel.series.forEach(({ xy: [across, up] }, k) => {
      const points = across.map((x, n) => (x === null || up[n] === null ? null : this.at(x, up[n])));
      add(svg, "path", { d: cutPath(points, this.frame), class: `curve ${pen(k)}` });
    });
    this.spots(svg, this.at);
    const name = (axis) => (named ? withUnit(axis, this.panel.unit) : "");
    this.nameAxes(svg, box, name("x"), name("y"));
  }

  // The range of the visible tracks along an axis.
  reach(axis) {
    const { series, points, most, middle } = this.panel;
    const near = (x, y) =>
      x !== null && y !== null && (most === undefined || Math.hypot(x - middle[0], y - middle[1]) <= most);
    const tracks = series.flatMap(({ xy }) => xy[axis].filter((_, k) => near(xy[0][k], xy[1][k])));
    return extent([...tracks, ...(points || []).flatMap(({ xy }) => xy[axis])]) || [0, 1];
  }

  pointers() {
    const { angles, series } = this.panel;
    this.dots = angles ? series.map((_, k) => add(this.svg, "circle", { r: 4, class: `dot ${pen(k)}` })) : [];
    for (const dot of this.dots) set(dot, { visibility: "hidden" });
  }

  mark(angle) {
    this.marked = [angle];
    const { angles, series } = this.panel;
    if (!angles || !this.seen) return;
    const row = rowAtAngle(angles, angle);
    const places = series.map(({ xy }) => xy.map((column) => valueAt(column, row)));
    this.tell(places);
    if (!this.drawn) return;
    this.dots.forEach((dot, k) => {
      this.put(dot, ...(places[k].includes(null) ? [NaN, NaN] : this.at(...places[k])));
    });
  }

  // The driver goes to where a track is nearest.
  pick([x, y]) {
    const { angles, series } = this.panel;
    let [least, found] = [Infinity, null];
    for (const { xy } of series) {
      angles.forEach((angle, k) => {
        if (angle === null || xy[0][k] === null || xy[1][k] === null) return;
        const at = this.at(xy[0][k], xy[1][k]);
        const away = Math.hypot(at[0] - x, at[1] - y);
        if (away < least) [least, found] = [away, angle];
      });
    }
    if (found !== null) this.onPick(found);
  }
}
