// The parts of a task that can be dragged on the drawing: targets, angles, corners, regions.
const ARM = 46; // px: how far from a target the handle of its angle is
const FREEHAND = 12; // points that a line drawn by hand becomes

class Handles {
  stage; onMode; snaps; task; onPlace;

  constructor(stage, task, { onMode }) {
    Object.assign(this, { stage, task, onMode, mode: "move", snaps: false, held: null, focused: null, line: null, onPlace: null });
    this.layer = element("g", { class: "handles" });
    stage.drawnOver = () => this.draw();
    const { svg } = stage;
    svg.addEventListener("pointerdown", (event) => this.down(event), { capture: true });
    svg.addEventListener("pointermove", (event) => this.moved(event));
    for (const end of ["pointerup", "pointercancel"]) svg.addEventListener(end, () => this.up());
    svg.addEventListener("keydown", (event) => this.key(event), { capture: true });
    document.addEventListener("focusin", ({ target }) => {
      const handle = target.closest("[data-handle]");
      this.focused = handle ? handle.dataset.handle : null;
    });
    document.addEventListener("pointerdown", ({ target }) => {
      if (!svg.contains(target)) this.focused = null;
    });
  }

  setMode(mode) {
    this.mode = mode;
    this.stage.svg.classList.toggle("draws", mode !== "move");
    this.onMode(mode);
  }

  // A place as it is written into the file: on the grid where it snaps, else no finer than can be seen.
  rounded(/** @type {number[]} */ [x, y]) {
    const step = this.step();
    return [x, y].map((value) => Number((Math.round(value / step) * step).toPrecision(12)));
  }

  // The finest step that can be seen, or that of the grid.
  step() {
    return this.snaps ? this.grid() : 10 ** -Math.ceil(Math.log10(this.stage.unit));
  }

  // The distance of round numbers that are some 12 px apart.
  grid() {
    const rough = 12 / this.stage.unit;
    const power = 10 ** Math.floor(Math.log10(rough));
    return [1, 2, 5, 10].find((each) => each * power >= rough * 0.999) * power;
  }

  turned(degrees) {
    const step = this.snaps ? 5 : 0.1;
    return Number((Math.round(wrapped(degrees / DEG) * DEG / step) * step).toPrecision(12));
  }

  // Every handle: name, place, look, and the effect on the task of moving it to a place.
  list() {
    return [...this.ofTargets(), ...this.ofPolygons(), ...this.ofRegions(), ...this.ofBody()];
  }

  ofTargets() {
    const { task, stage } = this;
    const found = [];
    const last = task.closes ? task.targets.length - 1 : -1;
    task.targets.forEach(({ x, y, angle }, k) => {
      if (x === null || y === null || k === last) return;
      const words = `${task.kind === "motion" ? "pose" : "point"} ${k + 1}`;
      const move = ([u, v]) => task.setTarget(k, { x: u, y: v });
      found.push({ name: `target-${k}`, words, at: [x, y], style: "place", target: k, move });
      if (angle === null) return;
      const away = [(ARM / stage.unit) * Math.cos(angle / DEG), (ARM / stage.unit) * Math.sin(angle / DEG)];
      found.push({
        name: `angle-${k}`,
        words: `angle of pose ${k + 1}`,
        at: [x + away[0], y + away[1]],
        from: [x, y],
        style: "angle",
        target: k,
        turn: (degrees) => task.setTarget(k, { angle: degrees }),
        degrees: angle,
      });
    });
    return found;
  }

  ofPolygons() {
    const { task } = this;
    return task.polygons.flatMap(([words, corners, closed]) =>
      corners.map((at, k) => ({
        name: `${words} ${k}`,
        words: `corner ${k + 1} of ${words}`,
        at,
        style: "corner",
        move: (place) => (corners[k] = place),
        remove: () => (corners.length > (closed ? 3 : 2) ? corners.splice(k, 1) : task.removePolygon(corners)),
      })),
    );
  }

  ofRegions() {
    const { task } = this;
    return task.regions.flatMap(([names, box]) => {
      const words = `${names.map((name) => name.toUpperCase()).join(", ")} region`;
      const remove = () => names.forEach((name) => delete task.requirements[name]);
      if (Array.isArray(box)) {
        const move = (place) => task.setRegion(names, place);
        return [{ name: `${words} 0`, words, at: box, style: "corner", move, remove }];
      }
      const { x, y } = box;
      if (!x || !y) return [];
      const corner = (i, j) => ({
        name: `${words} ${i}${j}`,
        words: `corner of ${words}`,
        at: [x[i], y[j]],
        style: "corner",
        remove,
        move: ([u, v]) => {
          const sides = { x: [...x], y: [...y] };
          sides.x[i] = i ? Math.max(u, x[0]) : Math.min(u, x[1]);
          sides.y[j] = j ? Math.max(v, y[0]) : Math.min(v, y[1]);
          task.setRegion(names, sides);
        },
      });
      return [corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)];
    });
  }

  // Corners of the body, where it stands at the first pose.
  ofBody() {
    const { body } = this.task.document.motion || {};
    const [pose] = this.task.targets;
    if (!body || !pose || pose.x === null || pose.angle === null) return [];
    const [cos, sin] = [Math.cos(pose.angle / DEG), Math.sin(pose.angle / DEG)];
    return bodyAt(body, [pose.x, pose.y], pose.angle / DEG).map((at, k) => ({
      name: `body ${k}`,
      words: `corner ${k + 1} of the body`,
      at,
      style: "corner",
      move: ([x, y]) => {
        const [dx, dy] = [x - pose.x, y - pose.y];
        body[k] = this.rounded([dx * cos + dy * sin, dy * cos - dx * sin]);
      },
      remove: () => body.length > 3 && body.splice(k, 1),
    }));
  }

  draw() {
    this.layer.replaceChildren();
    for (const handle of this.list()) this.layer.append(this.drawn(handle));
    if (this.line) add(this.layer, "path", { d: through(this.line.map(this.stage.at)), class: "by-hand" });
    this.stage.svg.append(this.layer);
    if (this.focused) this.find(this.focused)?.focus({ preventScroll: true });
  }

  find(name) {
    return $$("[data-handle]", this.layer).find((each) => each.dataset.handle === name);
  }

  drawn({ name, words, at, from, style }) {
    const group = element("g", { class: `handle ${style}`, tabindex: 0, role: "button", "aria-label": words });
    group.dataset.handle = name;
    const [x, y] = this.stage.at(at);
    if (from) add(group, "path", { d: through([from, at].map(this.stage.at)) });
    add(group, "circle", { cx: px(x), cy: px(y), r: 13, class: "reach" });
    if (style === "corner") add(group, "rect", { x: px(x - 4), y: px(y - 4), width: 8, height: 8 });
    else add(group, "circle", { cx: px(x), cy: px(y), r: style === "angle" ? 5 : 6.5 });
    group.classList.toggle("locked", this.isLocked(name));
    add(group, "title", {}, this.isLocked(name) ? `${words}, locked` : words);
    return group;
  }

  isLocked(name) {
    return this.task.locked.has(name.replace("angle-", "target-"));
  }

  down(event) {
    if (event.button) return;
    const { stage, task } = this;
    const place = stage.back(stage.pointer(event));
    const grip = event.target.closest("[data-handle]");
    if (this.mode === "move") {
      const handle = grip && this.list().find(({ name }) => name === grip.dataset.handle);
      if (!handle) return;
      this.focused = handle.name;
      grip.focus({ preventScroll: true });
      if (this.isLocked(handle.name)) return this.taken(event);
      const off = handle.turn ? [0, 0] : [handle.at[0] - place[0], handle.at[1] - place[1]];
      this.held = { name: handle.name, off };
      stage.hold();
      task.begin();
    } else if (this.mode === "draw") {
      this.line = [place];
    } else if (this.mode === "add") {
      stage.hold();
      if (task.list) task.edit(() => task.addTarget(this.rounded(place)));
    } else if (this.mode === "scale") this.onPlace(place);
    else this.addCorner(place);
    this.taken(event);
  }

  // The hand has taken something: nobody else does.
  taken(event) {
    event.preventDefault();
    event.stopPropagation();
    this.stage.svg.setPointerCapture(event.pointerId);
  }

  // The first click of an area or outline begins it with three corners about the place.
  addCorner(place) {
    const { stage, task } = this;
    stage.hold();
    const r = 50 / stage.unit;
    const [x, y] = place;
    const corner = (...at) => this.rounded(at);
    task.edit((document) => {
      if (this.mode === "area") {
        (task.requirements.keep_out ||= []).push([corner(x - r, y - r), corner(x + r, y - r), corner(x + r, y + r), corner(x - r, y + r)]);
      } else if (this.mode === "outline") {
        ((document.scene ||= {}).outlines ||= []).push([corner(x - r, y), corner(x + r, y)]);
      } else if (this.mode.startsWith("region")) {
        const names = this.mode.split(" ").slice(1);
        task.setRegion(names, { x: [corner(x - r, y)[0], corner(x + r, y)[0]], y: [corner(x, y - r)[1], corner(x, y + r)[1]] });
      }
    });
    this.setMode("move");
  }

  moved(event) {
    const { stage, task } = this;
    const place = stage.at && stage.back(stage.pointer(event));
    if (this.line) {
      const [x, y] = stage.at(this.line.at(-1));
      const [u, v] = stage.at(place);
      if (Math.hypot(u - x, v - y) > 3) this.line.push(place);
      this.draw();
    }
    if (!this.held) return;
    const handle = this.list().find(({ name }) => name === this.held.name);
    if (!handle) return;
    const { off } = this.held;
    task.change(() => {
      if (handle.turn) {
        handle.turn(this.turned(Math.atan2(place[1] - handle.from[1], place[0] - handle.from[0]) * DEG));
      } else handle.move(this.rounded([place[0] + off[0], place[1] + off[1]]));
    });
  }

  up() {
    if (this.held) {
      this.held = null;
      this.task.end();
    }
    if (this.line) {
      const points = this.line;
      this.line = null;
      if (points.length > 4) {
        this.task.edit(() => this.task.setPath(resampled(points, FREEHAND).map((point) => this.rounded(point))));
      }
      this.setMode("move");
    }
  }

  // Arrow keys move the handle with the focus by a step, with shift ten times; Delete removes it, L locks it.
  key(event) {
    const handle = this.focused && this.list().find(({ name }) => name === this.focused);
    if (event.key === "Escape" && this.mode !== "move") return this.setMode("move");
    if (!handle || event.ctrlKey || event.metaKey || event.altKey) return;
    const ways = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
    const times = event.shiftKey ? 10 : 1;
    const { task, stage } = this;
    if (event.key in ways && !this.isLocked(handle.name)) {
      stage.hold();
      const [dx, dy] = ways[event.key];
      const step = this.step() * times;
      task.edit(() => {
        if (handle.turn) handle.turn(this.turned(handle.degrees + (dy - dx) * times * (this.snaps ? 5 : 1)));
        else handle.move(this.rounded([handle.at[0] + dx * step, handle.at[1] + dy * step]));
      });
    } else if (event.key === "Delete" || event.key === "Backspace") this.remove(handle);
    else if (event.key === "l" || event.key === "L") this.toggleLock(handle.target);
    else return;
    event.preventDefault();
    event.stopPropagation();
  }

  remove(handle) {
    if (this.isLocked(handle.name)) return;
    this.stage.hold();
    if (handle.target !== undefined) this.task.edit(() => this.task.removeTarget(handle.target));
    else if (handle.remove) this.task.edit(handle.remove);
  }

  toggleLock(target) {
    if (target === undefined) return;
    const { locked } = this.task;
    if (!locked.delete(`target-${target}`)) locked.add(`target-${target}`);
    this.task.onChange({ looks: true });
  }
}
