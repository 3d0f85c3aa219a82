// Curves over the driver angle, with a mark that follows it, or over anything else.
const PEAK = 12; // a rate is drawn up to this multiple of its typical size, where it grows without bound

class Curves extends Picture {
  // panel: { title, unit, series: [{ label, values }] } with values at `places`; besides `over` (the name
  // of the places), `angles` (driver angles in deg at the places), `most` (size up to which values are drawn),
  // `limits` and `points`. options: `bounded`, the `bold` parts of the places, target `marks`, the
  // `window` of places that is shown, and `scaled`: the bold parts fill the frame.
  show(panel, options = {}) {
    const follows = this.panel;
    super.show(panel, options);
    if (follows) return;
    if (panel.angles && this.onPick) this.follow(([x]) => this.pick(x));
    else if (!panel.angles && isRising(panel.places)) this.follow(([x]) => this.read(x), true);
    this.svg.classList.toggle("picks", Boolean(panel.angles) || isRising(panel.places));
  }

  // Axes and lines, into a box of a drawing.
  paint(svg, box, named = false) {
    const [low, high] = this.panel.limits || this.limits();
    const [first, last] = this.span();
    const across = named || this.panel.over ? this.panel.over || this.panel.driver : "";
    const below = across ? 36 : 20;
    const height = box.bottom - box.top - below - 6;
    const numbers = ticksAlong(low, high, height, this.panel.unit === "deg", 26);
    const left = box.left + Math.max(46, longest(numbers) + 10) + (named ? 18 : 0);
    this.frame = { left, right: box.right - 10, top: box.top + 6, bottom: box.bottom - below };
    const { right, top, bottom } = this.frame;
    this.x = (place) => left + ((right - left) * (place - first)) / (last - first);
    this.y = (value) => bottom - ((bottom - top) * (value - low)) / (high - low);
    const grid = add(svg, "g", { class: "grid" });
    for (const { value, text } of numbers) {
      const y = this.y(value);
      add(grid, "path", { d: `M${px(left)} ${px(y)}H${right}`, class: value === 0 ? "zero" : "" });
      add(grid, "text", { x: left - 5, y: px(y + 4), "text-anchor": "end" }, text);
    }
    const degrees = !this.panel.over || this.panel.over.endsWith("(deg)");
    for (const { value, text } of ticksAlong(first, last, right - left, degrees)) {
      add(grid, "path", { d: `M${px(this.x(value))} ${top}V${bottom}` });
      add(grid, "text", { x: px(this.x(value)), y: bottom + 14, "text-anchor": "middle" }, text);
    }
    for (const place of this.options.marks || []) {
      add(grid, "path", { d: `M${px(this.x(place))} ${bottom}v-7`, class: "target-mark" });
    }
    const { bold } = this.options;
    this.panel.series.forEach(({ values }, k) => {
      add(svg, "path", { d: this.line(values), class: `curve ${pen(k)}${bold ? " faint" : ""}` });
      for (const part of bold || []) add(svg, "path", { d: this.line(values, part), class: `curve ${pen(k)}` });
    });
    this.spots(svg, (place, value) => [this.x(place), this.y(value)]);
    this.nameAxes(svg, box, across, named ? withUnit(this.panel.title, this.panel.unit) : "");
  }

  // Lifted in gaps, and where a value jumps through infinity.
  line(values, [from, to] = [-Infinity, Infinity]) {
    const { places } = this.panel;
    const most = this.most();
    const points = [];
    values.forEach((value, k) => {
      const place = places[k];
      const known = value !== null && place !== null && place >= from - 1e-9 && place <= to + 1e-9;
      const before = k ? values[k - 1] : null;
      if (before !== null && Math.abs(before) > most && Math.abs(value) > most && before * value < 0) {
        points.push(null);
      }
      points.push(known ? [this.x(place), this.y(value)] : null);
    });
    return cutPath(points, this.frame);
  }

  // The places that are shown.
  span() {
    const { places, points } = this.panel;
    const every = extent([...places, ...(points || []).flatMap(({ xy }) => xy[0])]) || [0, 1];
    const [low, high] = this.options.window || every;
    return high > low ? [low, high] : margined([low, high], 0);
  }

  limits() {
    const { places, series, points } = this.panel;
    const [first, last] = this.span();
    const { bold, scaled } = this.options;
    const parts = scaled && bold ? bold : [[first, last]];
    const inside = (place) => place !== null && parts.some(([from, to]) => place >= from - 1e-3 && place <= to + 1e-3);
    const known = series.flatMap(({ values }) => values.filter((_, k) => inside(places[k])));
    const most = this.most();
    let [low, high] = extent(known) || [0, 1];
    [low, high] = [Math.max(low, -most), Math.min(high, most)];
    const spots = extent((points || []).flatMap(({ xy }) => xy[1].filter((_, k) => inside(xy[0][k]))));
    if (spots) [low, high] = [Math.min(low, spots[0]), Math.max(high, spots[1])];
    return margined([low, high], 0.06);
  }

  most() {
    const { most, series } = this.panel;
    if (most !== undefined || !this.options.bounded) return most ?? Infinity;
    const sizes = series.flatMap(({ values }) => values.filter((value) => value !== null).map(Math.abs));
    return PEAK * sizes.sort((a, b) => a - b)[sizes.length >> 1] || Infinity;
  }

  pointers() {
    this.cursor = add(this.svg, "path", { class: "cursor" });
    this.dots = this.panel.series.map((_, k) => add(this.svg, "circle", { r: 4, class: `dot ${pen(k)}` }));
    for (const dot of this.dots) set(dot, { visibility: "hidden" });
  }

  // Puts the mark at a driver angle in deg; `values` where they are known better than by the samples.
  mark(angle, values = null) {
    this.marked = [angle, values];
    const { angles } = this.panel;
    if (angles && this.seen) this.markRow(rowAtAngle(angles, angle), values);
  }

  markRow(row, given = null) {
    const { places, series } = this.panel;
    const values = given || series.map((each) => valueAt(each.values, row));
    this.tell(values);
    if (!this.drawn) return;
    const place = valueAt(places, row);
    const { left, right, top, bottom } = this.frame;
    const x = place === null ? NaN : this.x(place);
    set(this.cursor, { d: x >= left - 1 && x <= right + 1 ? `M${px(x)} ${top}V${bottom}` : "" });
    this.dots.forEach((dot, k) => this.put(dot, x, values[k] === null ? NaN : this.y(values[k])));
  }

  // The place at a position in the drawing.
  placeAt(x) {
    const { left, right } = this.frame;
    const [first, last] = this.span();
    return first + (last - first) * Math.min(Math.max((x - left) / (right - left), 0), 1);
  }

  pick(x) {
    const { angles, places } = this.panel;
    const place = this.placeAt(x);
    const angle = angles === places ? place : valueAt(angles, rowAt(places, place));
    if (angle !== null) this.onPick(angle);
  }

  // A mark of its own, where nothing that moves says where it is.
  read(x) {
    this.markRow(rowAt(this.panel.places, this.placeAt(x)));
  }
}

// The transmission angle of a design over its travel, and its drive torque where it is known; the states between,
// their places and the options of curves over them.
function showTravel(design, closed, transmission, torque) {
  const { angles } = travelPath(design);
  const places = angles.map((angle) => angle * DEG);
  const states = angles.map((angle) => positionOf(design.linkage, angle));
  const marks = design.theta2.map((angle) => within(design, angle) * DEG);
  const bold = closed || !design.task ? null : partsOfTask(design);
  const options = { bold, marks, bounded: !design.turns };
  const driver = "driver angle theta2 (deg)";
  const mu = { title: "Transmission angle", unit: "deg", limits: [0, 90], driver, places, angles: places };
  transmission.show({ ...mu, series: [{ label: "μ", values: states.map((state) => state.mu * DEG) }] }, { bold, marks });
  if (torque && design.torque) {
    const sampled = travelAngles(design).map((angle) => angle * DEG);
    const drive = { title: "Drive torque", unit: "N m", driver, places: sampled, angles: sampled };
    const wanted = design.wanted && [design.wanted[0].map((angle) => within(design, angle) * DEG), design.wanted[1]];
    const points = wanted ? [{ label: "wanted", xy: wanted }] : [];
    torque.show({ ...drive, series: [{ label: "T", values: design.torque }], points }, options);
  }
  return { places, states, options };
}

const isRising = (places) =>
  places.every((place, k) => k === 0 || (place !== null && place >= places[k - 1]));
