// The parts of a task that can be dragged on the drawing: targets, angles, corners, regions.
const ARM = 46; // px: how far from a target the handle of its angle is
const FREEHAND = 12; // points that a line drawn by hand becomes, by default

class Handles {
  stage; onMode; onFocus; snaps; task; onPlace; count; joints; shape;

  constructor(stage, task, { onMode, onFocus }) {
    Object.assign(this, { stage, task, onMode, onFocus, mode: "move", snaps: false, held: null, focused: null, line: null, onPlace: null });
    Object.assign(this, { count: FREEHAND, joints: ["o2", "o4"], shape: "box", pointer: null });
    this.layer = element("g", { class: "handles" });
    stage.drawnOver = () => this.draw();
    const { svg } = stage;
    svg.addEventListener("pointerdown", (event) => this.down(event), { capture: true });
    svg.addEventListener("pointermove", (event) => event.pointerId === this.pointer && this.moved(event));
    for (const end of ["pointerup", "pointercancel"]) {
      svg.addEventListener(end, (event) => event.pointerId === this.pointer && this.up(end === "pointerup"));
    }
    svg.addEventListener("keydown", (event) => this.key(event), { capture: true });
    document.addEventListener("focusin", ({ target }) => {
      const handle = target.closest("[data-handle]");
      if (!target.closest("[data-remove]")) this.focus(handle ? handle.dataset.handle : null);
    });
    document.addEventListener("pointerdown", ({ target }) => {
      if (!svg.contains(target) && !target.closest("[data-remove]")) this.focus(null);
    });
  }

  focus(name) {
    this.focused = name;
    this.onFocus(this.chosen());
  }

  // The handle for keys and for *Remove*.
  chosen() {
    return (this.focused && this.list().find(({ name }) => name === this.focused)) || null;
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
    return this.snaps ? this.grid() : finestStep(this.stage);
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
    return [...this.ofTargets(), ...this.ofPolygons(), ...this.ofPlaces(), ...this.ofBody()];
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
    const rounded = (place) => this.rounded(place);
    return this.task.polygons.flatMap(({ words, list, k, closed }) => {
      const put = (corners) => (list[k] = corners);
      const remove = () => list.splice(k, 1);
      return cornerHandles({ words, corners: list[k], closed, fewest: closed ? 3 : 2, put, remove }, this.stage, rounded);
    });
  }

  ofPlaces() {
    return placesOf(this.task).flatMap((place) => placeHandles(place, this.stage, (at) => this.rounded(at)));
  }

  // Corners of the body, where it stands at the first pose.
  ofBody() {
    const { motion } = this.task.document;
    const frame = frameOfBody(this.task);
    if (!frame || !motion.body) return [];
    const put = (corners) => (motion.body = corners);
    const body = { words: "the body", corners: motion.body, closed: true, fewest: 3, frame, put, remove: () => {} };
    return cornerHandles(body, this.stage, (place) => this.rounded(place));
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
    if (from) add(group, "path", { d: through([from, at].map(this.stage.at)), class: "arm" });
    add(group, "circle", { cx: px(x), cy: px(y), r: style === "insert" ? 8 : 13, class: "reach" });
    if (style === "corner") add(group, "rect", { x: px(x - 4), y: px(y - 4), width: 8, height: 8 });
    else if (style === "insert") add(group, "path", { d: `M${px(x - 4)} ${px(y)}h8m-4 -4v8` });
    else add(group, "circle", { cx: px(x), cy: px(y), r: style === "angle" ? 5 : 6.5 });
    group.classList.toggle("locked", this.isLocked(name));
    add(group, "title", {}, this.isLocked(name) ? `${words}, locked` : words);
    return group;
  }

  isLocked(name) {
    return this.task.locked.has(name.replace("angle-", "target-"));
  }

  down(event) {
    if (event.button || this.pointer !== null) return;
    const { stage, task } = this;
    const place = stage.back(stage.pointer(event));
    const grip = event.target.closest("[data-handle]");
    if (this.mode === "move") {
      const handle = grip && this.nearest(place);
      if (!handle) return;
      this.focus(handle.name);
      this.find(handle.name).focus({ preventScroll: true });
      if (this.isLocked(handle.name)) return this.taken(event);
      const off = handle.turn ? [0, 0] : [handle.at[0] - place[0], handle.at[1] - place[1]];
      this.held = { name: handle.becomes || handle.name, off };
      stage.hold();
      task.begin();
      if (handle.becomes) this.grow(handle);
    } else if (this.mode === "draw") {
      stage.hold(); // new designs do not change the scale meanwhile
      this.line = [place];
    } else if (this.mode === "add") {
      stage.hold();
      if (task.list) task.edit(() => task.addTarget(this.rounded(place)));
    } else if (this.mode === "scale") this.onPlace(place);
    else this.addCorner(place);
    this.taken(event);
  }

  // Splits a side at a new corner, which is dragged from now on.
  grow(handle, place = handle.at) {
    this.focused = handle.becomes;
    this.task.change(() => handle.move(this.rounded(place)));
    this.focus(handle.becomes);
  }

  // The hand has taken something: nobody else does.
  taken(event) {
    this.pointer = event.pointerId;
    event.preventDefault();
    event.stopPropagation();
    this.stage.svg.setPointerCapture(event.pointerId);
  }

  // Of handles that cover each other.
  nearest([x, y]) {
    const away = ({ at }) => Math.hypot(at[0] - x, at[1] - y);
    return this.list().reduce((best, other) => (away(other) < away(best) ? other : best));
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
      } else if (this.mode === "region") task.setPlace(this.joints, this.placeAt(place, r));
    });
    this.setMode("move");
  }

  // Joints of a new place; those on the body only where it has a frame.
  offerJoints(select) {
    for (const option of select.options) option.hidden = option.value.endsWith("_on_body") && !frameOfBody(this.task);
    if (select.selectedOptions[0].hidden) select.value = select.options[0].value;
    this.joints = select.value.split(" ");
  }

  // A new place of the chosen shape about a point, in the frame of its joints.
  placeAt([x, y], r) {
    const frame = this.joints[0].endsWith("_on_body") ? frameOfBody(this.task) : STILL;
    const [u, v] = frame.back([x, y]);
    const at = (...place) => this.rounded(place);
    const corners = [at(u - r, v - r), at(u + r, v - r), at(u + r, v + r), at(u - r, v + r)];
    const shapes = {
      box: { x: [corners[0][0], corners[2][0]], y: [corners[0][1], corners[2][1]] },
      polygon: { inside: corners },
      line: { on: [at(u - r, v), at(u + r, v)] },
      point: at(u, v),
    };
    return shapes[this.shape];
  }

  moved(event) {
    const { stage, task } = this;
    const place = stage.at && stage.back(stage.pointer(event));
    if (this.line) {
      const between = event.getCoalescedEvents ? event.getCoalescedEvents() : [];
      for (const each of between.length ? between : [event]) {
        const next = stage.back(stage.pointer(each));
        const [[x, y], [u, v]] = [this.line.at(-1), next].map(stage.at);
        if (Math.hypot(u - x, v - y) > 3) this.line.push(next);
      }
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

  // The pointer is released, or cancelled by the browser, which discards a drawn line.
  up(done) {
    this.pointer = null;
    if (this.held) {
      this.held = null;
      this.task.end();
    }
    if (this.line) {
      const { points, closed } = sampled(this.line, this.count);
      const path = withoutRepeats(points.map((point) => this.rounded(point)));
      const enough = this.line.length > 4 && path.length >= FEWEST.path + Number(closed);
      this.line = null;
      if (done && enough) this.task.edit(() => this.task.setPath(path, closed));
      this.setMode("move");
    }
  }

  // Arrow keys move the handle with the focus by a step, with shift ten times; Delete removes it, L locks it.
  key(event) {
    const handle = this.chosen();
    if (event.key === "Escape" && this.mode !== "move") return this.setMode("move");
    if (!handle || event.ctrlKey || event.metaKey || event.altKey) return;
    const ways = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
    const times = event.shiftKey ? 10 : 1;
    const { task, stage } = this;
    if (event.key in ways && !this.isLocked(handle.name)) {
      stage.hold();
      const [dx, dy] = ways[event.key];
      const step = this.step() * times;
      const next = [handle.at[0] + dx * step, handle.at[1] + dy * step];
      if (handle.becomes) {
        task.begin();
        this.grow(handle, next);
        task.end();
      } else {
        task.edit(() => {
          if (handle.turn) handle.turn(this.turned(handle.degrees + (dy - dx) * times * (this.snaps ? 5 : 1)));
          else handle.move(this.rounded(next));
        });
      }
    } else if (handle.becomes && ["Enter", " ", "Insert"].includes(event.key)) {
      task.begin();
      this.grow(handle);
      task.end();
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
    this.onFocus(this.chosen());
  }

  removeChosen() {
    const handle = this.chosen();
    if (handle) this.remove(handle);
  }

  toggleLock(target) {
    if (target === undefined) return;
    const { locked } = this.task;
    if (!locked.delete(`target-${target}`)) locked.add(`target-${target}`);
    this.task.onChange({ looks: true });
  }
}
