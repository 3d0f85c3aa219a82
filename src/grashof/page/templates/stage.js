// The drawing: the scene, the targets, and a linkage that follows its driver.
const MANY_TARGETS = 24;
const DIGIT = 7; // px: no character of an axis is wider
const BLOCK = 13; // px: half the length of the block of a slide
const STRIP = { left: 34, below: 18 }; // px: along the edges, for the numbers of the axes
const ZOOM = 1.25; // by one step of the wheel or press of a button
const CLOSEST = 1e6; // times as large as all of the drawing, at most

class Stage {
  trace; beside; behind; scene; svg; close; ghosts; drawnOver; onDrive; onDraw;

  constructor(svg, scene, { onDrive = null, onDraw = () => {} } = {}) {
    Object.assign(this, {
      svg,
      scene,
      onDrive,
      onDraw,
      design: null,
      together: [],
      theta2: 0,
      trace: true,
      ghosts: false,
      close: false,
      view: null,
      behind: null, // { points, draw }: the background of the drawing
      beside: () => {}, // draws additions to the linkage
      drawnOver: () => {}, // draws the top layer
    });
    onResize(svg, () => this.draw());
    if (onDrive) listenToJoints(this);
    listenToView(this);
  }

  // Shows a design, or only the scene; `together`: designs that share the scale.
  show(design, together = design ? [design] : []) {
    this.design = design;
    this.together = together;
    if (design) this.theta2 = within(design, this.theta2);
    this.draw();
  }

  draw() {
    const [width, height] = [this.svg.clientWidth, this.svg.clientHeight];
    if (width < 80) return;
    set(this.svg, { viewBox: `0 0 ${width} ${height}` });
    const behind = this.behind ? this.behind.points() : [];
    this.scale(width, height, [...pointsToSee(this.scene, this.together, this.close), ...behind]);
    this.svg.replaceChildren();
    const numbers = this.grid(width, height);
    if (this.behind) this.behind.draw();
    this.areas();
    this.beside();
    if (this.design && this.trace) this.traces();
    this.targets();
    if (this.design) {
      if (this.ghosts) this.drawGhosts();
      this.parts = this.linkage();
      this.move(this.theta2);
    }
    this.svg.append(numbers);
    this.drawnOver();
  }

  // The view of everything, or the view that was chosen.
  scale(width, height, seen) {
    this.whole = this.fitted(width, height, seen);
    const { unit, middle } = this.view || this.whole;
    const [x0, y0] = [width / 2 - unit * middle[0], height / 2 + unit * middle[1]];
    /** @param {number[]} place */
    this.at = ([x, y]) => [x0 + unit * x, y0 - unit * y];
    /** @param {number[]} place */
    this.back = ([x, y]) => [(x - x0) / unit, (y0 - y) / unit];
    this.unit = unit;
    this.decimals = Math.max(0, Math.ceil(Math.log10(unit)) + 1); // a tenth of a pixel and less
  }

  fitted(width, height, seen) {
    if (!seen.length) seen = [[0, 0], [1, 1]];
    const xs = seen.map((point) => point[0]);
    const ys = seen.map((point) => point[1]);
    const [left, right, low, high] = [Math.min(...xs), Math.max(...xs), Math.min(...ys), Math.max(...ys)];
    const margin = Math.min(40, width / 10);
    const unit = Math.min(
      (width - 2 * margin) / (right - left || 1),
      (height - 2 * margin) / (high - low || 1),
    );
    return { unit, middle: [(left + right) / 2, (low + high) / 2] };
  }

  // Larger by a factor about a place in the drawing, px.
  zoom(factor, about = [this.svg.clientWidth / 2, this.svg.clientHeight / 2]) {
    const most = CLOSEST * this.whole.unit;
    const unit = Math.min(Math.max(this.unit * factor, this.whole.unit / 20), most);
    const held = this.back(about);
    const { clientWidth, clientHeight } = this.svg;
    const middle = [
      held[0] - (about[0] - clientWidth / 2) / unit,
      held[1] + (about[1] - clientHeight / 2) / unit,
    ];
    this.see({ unit, middle });
  }

  // Moved by a distance in px.
  pan([dx, dy]) {
    const { unit, middle } = this.view || this.whole;
    this.see({ unit, middle: [middle[0] - dx / unit, middle[1] + dy / unit] });
  }

  // A part of the drawing; null for all of it.
  see(view) {
    this.view = view;
    this.draw();
  }

  // The part that is seen now, so that it stays while the drawing changes.
  hold() {
    this.view ||= this.whole;
  }

  // Place of the mouse or a finger in the drawing, px.
  pointer(event) {
    const frame = this.svg.getBoundingClientRect();
    return [event.clientX - frame.left - this.svg.clientLeft, event.clientY - frame.top - this.svg.clientTop];
  }

  // Lines below all that is drawn, their numbers above it; what lies outside a close view does not
  // reach under the numbers.
  grid(width, height) {
    const lines = add(this.svg, "g", { class: "grid" });
    const numbers = element("g", { class: "numbers" });
    if (this.close || this.view) {
      add(numbers, "path", { d: `M0 0H${STRIP.left}V${height - STRIP.below}H${width}V${height}H0Z` });
    }
    const text = (place, words, style = "") => add(numbers, "text", { ...place, class: style }, words);
    const name = withUnit("x", this.scene.unit);
    const end = width - 14 - DIGIT * name.length;
    text({ x: width - 6, y: height - 5, "text-anchor": "end" }, name, "axis");
    text({ x: 5, y: 13 }, withUnit("y", this.scene.unit), "axis");
    const [left, high] = this.back([0, 0]);
    const [right, low] = this.back([width, height]);
    for (const [axis, from, to] of [
      ["x", left, right],
      ["y", low, high],
    ]) {
      const { at, decimals } = ticks(from, to, (axis === "x" ? width : height) / 60);
      for (const value of at) {
        const [x, y] = this.at([value, value]);
        const label = fixed(value, decimals);
        if (axis === "x") {
          add(lines, "path", { d: `M${px(x)} 0V${height}` });
          if (x > STRIP.left && x + (DIGIT * label.length) / 2 < end)
            text({ x, y: height - 5, "text-anchor": "middle" }, label);
        } else {
          add(lines, "path", { d: `M0 ${px(y)}H${width}` });
          if (y > 30 && y < height - STRIP.below) text({ x: 5, y: y - 3 }, label);
        }
      }
    }
    return numbers;
  }

  areas() {
    const { scene } = this;
    const [width, height] = [this.svg.clientWidth, this.svg.clientHeight];
    const beyond = 20; // px: distance beyond the view of a side that is open or far away
    for (const corners of scene.keepOut || []) {
      add(this.svg, "path", { d: through(corners.map(this.at), true), class: "kept-out" });
    }
    const names = [];
    for (const { name, x, y, corners } of scene.regions || []) {
      const seen = (place, most) => Math.min(Math.max(place, -beyond), most + beyond);
      const [left, bottom] = this.at([x[0] === null ? -Infinity : x[0], y[0] === null ? -Infinity : y[0]]);
      const [right, top] = this.at([x[1] === null ? Infinity : x[1], y[1] === null ? Infinity : y[1]]);
      const [x0, x1, y0, y1] = [
        seen(left, width),
        seen(right, width),
        seen(top, height),
        seen(bottom, height),
      ];
      const single = x0 === x1 && y0 === y1;
      const shape = corners
        ? through(corners.map(this.at), true)
        : single
        ? `M${px(x0)} ${px(y0)}m-7 0h14m-7 -7v14`
        : `M${px(x0)} ${px(y0)}H${px(x1)}V${px(y1)}H${px(x0)}Z`;
      add(this.svg, "path", { d: shape, class: "region" });
      const highest = corners && corners.map(this.at).reduce((one, other) => (other[1] < one[1] ? other : one));
      this.regionName(name, highest || [x0, y0], names);
    }
    for (const corners of scene.outlines || []) {
      add(this.svg, "path", { d: through(corners.map(this.at)), class: "outline" });
    }
  }

  // At a corner of the region, within the drawing, below the names that are there already.
  regionName(name, [left, top], names) {
    const wide = 6 * name.length;
    const x = Math.min(Math.max(left + 4, 40), Math.max(this.svg.clientWidth - 10 - wide, 40));
    let y = Math.min(Math.max(top + 13, 26), this.svg.clientHeight - 20);
    const covers = (other) => Math.abs(other.y - y) < 12 && x < other.x + other.wide && other.x < x + wide;
    while (names.some(covers)) y += 12;
    names.push({ x, y, wide });
    add(this.svg, "text", { x, y, class: "region-name" }, name);
  }

  targets() {
    const { scene, design } = this;
    const layer = add(this.svg, "g", { class: "targets" });
    if (scene.published) {
      add(layer, "path", { d: through(scene.published.path.map(this.at)), class: "published" });
    }
    this.labels = new Labels([{ x: this.svg.clientWidth - 52, y: 20, wide: 104, high: 36 }]); // the buttons of the view
    this.ways = {};
    const poses = posesOf(scene, design);
    for (const pose of poses) if (pose) this.labels.keep(this.at(pose.at), 3);
    for (const point of scene.points || []) this.labels.keep(this.at(point), 3);
    const every = poses.length > MANY_TARGETS ? Math.round(poses.length / 12) : 1;
    poses.forEach((pose, k) => {
      if (!pose || k % every) return;
      const style = pose.whole ? "body" : "body free";
      if (scene.body && pose.angle !== null) {
        add(layer, "path", {
          d: through(bodyAt(scene.body, pose.at, pose.angle).map(this.at), true),
          class: style,
        });
      }
      const [x, y] = this.at(pose.at);
      if (pose.angle !== null && !scene.bare) {
        const [cos, sin] = [Math.cos(pose.angle), Math.sin(pose.angle)];
        add(layer, "path", { d: `M${px(x)} ${px(y)}l${px(22 * cos)} ${px(-22 * sin)}`, class: "pose" });
      }
      add(layer, "circle", { cx: x, cy: y, r: 2.5, class: "pose-origin" });
      this.number(layer, [x, y], k + 1);
    });
    const points = scene.points || [];
    const returns = points.length > 1 && points[0].every((value, k) => value === points.at(-1)[k]);
    const shown = returns ? points.slice(0, -1) : points;
    const step = shown.length > MANY_TARGETS ? Math.round(shown.length / 12) : 1;
    shown.forEach((point, k) => {
      const [x, y] = this.at(point);
      add(layer, "circle", { cx: x, cy: y, r: shown.length > MANY_TARGETS ? 2.5 : 4, class: "target" });
      if (k % step === 0) this.number(layer, [x, y], k + 1);
    });
  }

  // The number of a target; none where others cover most of its place whatever side it goes to.
  number(layer, point, number) {
    const { place, covered } = this.labels.beside(point, number, [-1, -1]);
    if (covered > 40) this.labels.taken.pop();
    else add(layer, "text", { ...place, class: "number" }, number);
  }

  traces() {
    const { linkage, task } = this.design;
    const draw = ({ points }, style) =>
      add(this.svg, "path", { d: through(points.map(this.at)), class: style });
    draw(travelPath(this.design), task === undefined ? "trace" : "trace whole");
    if (task) draw(pathOf(linkage, anglesBetween(...task, true)), "trace");
  }

  drawGhosts() {
    const { linkage, theta2, assemblies } = this.design;
    const every = theta2.length > MANY_TARGETS ? Math.round(theta2.length / 12) : 1;
    const layer = add(this.svg, "g", { class: "ghosts" });
    theta2.forEach((angle, k) => {
      if (k % every) return;
      const state = positionOf(linkage, angle, assemblies[k]);
      for (const [, style, d] of partsOf(this.design, state, this.at, BLOCK / this.unit).reverse()) {
        add(layer, "path", { d, class: style });
      }
    });
  }

  // The parts that move, the ground pivots, and the guide of a slide.
  linkage() {
    const { ground: pivots, moving, parts: links } = kindOf(this.design.linkage);
    const ground = add(this.svg, "g", { class: "ground" });
    if (guideOf(this.design)) add(ground, "path", { d: this.guide(...guideOf(this.design)), class: "guide" });
    for (const name of pivots) {
      const [x, y] = this.at(this.design.linkage[name]);
      add(ground, "path", { d: `M${px(x)} ${px(y)}l-8 13h16Z` });
      this.labels.keep([x, y + 5], 8);
      add(ground, "text", this.labels.beside([x + 3, y + 5], name, [1, 0.2]).place, name.toUpperCase());
    }
    const layer = add(this.svg, "g", { class: "linkage" });
    const parts = {};
    if (this.scene.body) parts.body = add(layer, "path", { class: "body live" });
    if (this.design.cylinder) {
      parts.bracket = add(layer, "path", { class: `bracket ${this.design.cylinder.on}` });
      parts.piston = add(layer, "path", { class: "piston" });
      parts.ram = add(layer, "path", { class: "ram" });
    }
    this.struts = (this.design.struts || []).map(() => ({
      rod: add(layer, "path", { class: "piston" }),
      body: add(layer, "path", { class: "ram strut" }),
      pivots: [0, 1].map(() => add(layer, "circle", { r: 3, class: "joint" })),
    }));
    for (const { name, style } of links) parts[name] = add(layer, "path", { class: style });
    parts.sense = add(layer, "path", { class: "sense" });
    for (const name of [...pivots, ...moving]) {
      parts[name] = add(layer, "circle", { r: name === "p" ? 3.5 : 4, class: `joint ${name}` });
    }
    if (parts.ram) {
      for (const name of ["base", "pivot"]) parts[name] = add(layer, "circle", { r: 4, class: "joint" });
    }
    for (const name of moving) parts[`name-${name}`] = add(layer, "text", {}, name.toUpperCase());
    if (this.onDrive) {
      parts.hold = add(layer, "path", { class: "hold", "data-joint": "a" });
      add(parts.hold, "title", {}, "Drag the driver");
      for (const name of moving.filter((each) => each !== "a")) {
        parts[`hold-${name}`] = add(layer, "circle", { r: 12, class: "hold", "data-joint": name });
        add(parts[`hold-${name}`], "title", {}, `Drag ${name.toUpperCase()}`);
      }
    }
    return parts;
  }

  move(theta2) {
    if (!this.design) return;
    this.theta2 = within(this.design, theta2);
    const { linkage, direction } = this.design;
    const state = positionOf(linkage, this.theta2);
    this.state = state;
    this.onDraw(state);
    if (!this.parts) return;
    const places = Object.fromEntries(pointsOf(linkage).map((name) => [name, this.at(state[name])]));
    const { parts } = this;
    for (const [name, , d] of partsOf(this.design, state, this.at, BLOCK / this.unit)) {
      set(parts[name], { d });
    }
    for (const [name, [x, y]] of Object.entries(places)) {
      set(parts[name], { cx: px(x), cy: px(y) });
      if (parts[`hold-${name}`]) set(parts[`hold-${name}`], { cx: px(x), cy: px(y) });
    }
    const joints = [...kindOf(linkage).moving].sort().map((name) => [name, places[name]]);
    const middle = [0, 1].map((axis) => joints.reduce((sum, [, at]) => sum + at[axis], 0) / joints.length);
    const labels = new Labels(this.labels.taken);
    for (const [, joint] of joints) labels.keep(joint);
    for (const [name, joint] of joints) {
      const away = [joint[0] - middle[0], joint[1] - middle[1]];
      const { way, place } = labels.beside(joint, name, away, this.ways[name]);
      this.ways[name] = way;
      set(parts[`name-${name}`], place);
    }
    if (parts.body) {
      const corners = bodyAt(this.scene.body, state.p, state.guided);
      set(parts.body, { d: through(corners.map(this.at), true) });
    }
    if (parts.ram) {
      const found = cylinderAt(this.design.linkage, this.design.cylinder, state);
      const [base, end, pivot] = [found.base, found.end, found.pivot].map(this.at);
      set(parts.bracket, { d: through(found.bracket.map(this.at)) });
      set(parts.ram, { d: through([base, end]) });
      set(parts.piston, { d: through([end, pivot]) });
      set(parts.base, { cx: px(base[0]), cy: px(base[1]) });
      set(parts.pivot, { cx: px(pivot[0]), cy: px(pivot[1]) });
    }
    this.struts.forEach(({ rod, body, pivots }, k) => {
      const [from, end, to] = strutAt(linkage, this.design.struts[k], state).map(this.at);
      set(rod, { d: through([end, to]) });
      set(body, { d: through([from, end]) });
      [from, to].forEach(([x, y], which) => set(pivots[which], { cx: px(x), cy: px(y) }));
    });
    set(parts.sense, { d: this.senseArrow(places.o2, direction) });
    if (parts.hold) set(parts.hold, { d: through([places.o2, places.a]) });
  }

  // A line below the block of a slide, from end to end, hatched on its far side.
  guide(from, to) {
    const [[x0, y0], [x1, y1]] = [this.at(from), this.at(to)];
    const [ux, uy] = unitVector(x1 - x0, y1 - y0);
    const on = (along, beside) => [x0 + along * ux - beside * uy, y0 + along * uy + beside * ux];
    const [first, last] = [-1.5 * BLOCK, Math.hypot(x1 - x0, y1 - y0) + 1.5 * BLOCK];
    const lines = [[on(first, 0.6 * BLOCK), on(last, 0.6 * BLOCK)]];
    for (let at = first + 6; at < last; at += 8) lines.push([on(at, 0.6 * BLOCK), on(at - 6, 0.6 * BLOCK + 6)]);
    return lines.map((ends) => through(ends)).join("");
  }

  // An arrow about O2, ahead of the driver in the sense in which it meets the targets.
  senseArrow([x, y], direction) {
    const radius = Math.max(18, Math.min(0.4 * this.design.linkage.r2 * this.unit, 60));
    const on = (angle, r = radius) => [x + r * Math.cos(angle), y - r * Math.sin(angle)];
    const [from, to] = [this.theta2 + direction * 0.25, this.theta2 + direction * 1.25];
    const arc = Array.from({ length: 13 }, (_, k) => on(from + ((to - from) * k) / 12));
    const barb = to - (direction * 8) / radius;
    return through(arc) + through([on(barb, radius + 4), on(to), on(barb, radius - 4)]);
  }
}
