// The ends of struts and springs, which a hand drags on the drawing; the effort and the lengths follow.

// A place in the frame of a link, in a position.
function placeOn(linkage, link, [x, y], state) {
  const [origin, tip] = [[0, 0], [1, 0]].map((at) => pointAt(linkage, link, at, state));
  const [cos, sin] = [tip[0] - origin[0], tip[1] - origin[1]];
  const [dx, dy] = [x - origin[0], y - origin[1]];
  return [dx * cos + dy * sin, dy * cos - dx * sin];
}

class StrutHands {
  stage; root; design; plots; found; held; focused; onChange;

  // onChange: is told the plots whenever an end has moved; onPick: the driver angle, deg, that a plot picks.
  constructor(stage, root, { onChange = (_plots) => {}, onPick = null } = {}) {
    Object.assign(this, { stage, root, onChange, design: null, found: null, held: null, focused: null, plots: {} });
    for (const key of ["effort", "effort-lengths"]) {
      const node = $(`#${key}`, root);
      if (node) this.plots[key] = new Curves(node, { onPick });
    }
    this.layer = element("g", { class: "strut-ends" });
    const { drawnOver, onDraw, svg } = stage;
    Object.assign(stage, {
      drawnOver: () => (drawnOver(), this.draw()),
      onDraw: (state) => (onDraw(state), this.follow(state)),
    });
    svg.addEventListener("pointerdown", (event) => this.down(event), { capture: true });
    svg.addEventListener("pointermove", (event) => this.held && this.held.pointer === event.pointerId && this.moved(event));
    for (const end of ["pointerup", "pointercancel"]) svg.addEventListener(end, () => (this.held = null));
    svg.addEventListener("keydown", (event) => this.key(event), { capture: true });
    $("[data-back]", root).addEventListener("click", () => this.back());
  }

  // Takes the struts of a design; none without an effort.
  show(design) {
    this.design = design && design.effort ? design : null;
    this.root.hidden = !this.design;
    if (this.stage.state) this.draw();
    if (!this.design) return;
    const { struts, effort } = this.design;
    for (const strut of struts) strut.found ||= strut.ends.map(({ at }) => at);
    const first = struts.map(({ ends, found }) => ({ ends: ends.map(({ link }, end) => ({ link, at: found[end] })) }));
    this.first = excessOf(effort, effortOf(effort, first));
    this.renew();
  }

  mark(degrees) {
    if (this.design) for (const plot of Object.values(this.plots)) plot.mark(degrees);
  }

  get isMoved() {
    return this.design.struts.some(({ ends, found }) => ends.some(({ at }, end) => at !== found[end]));
  }

  // Every end: its strut, its number and its words.
  ends() {
    return (this.design ? this.design.struts : []).flatMap(({ label, ends }, strut) =>
      ends.map(({ link }, end) => ({ strut, end, words: `end ${end + 1} of ${label}, on ${link === 1 ? "the ground" : `link ${link}`}` })),
    );
  }

  draw() {
    const { focused } = this;
    this.layer.replaceChildren();
    for (const { strut, end, words } of this.design === this.stage.design ? this.ends() : []) {
      const group = add(this.layer, "g", { class: "handle strut-end", tabindex: 0, role: "button", "aria-label": words });
      group.dataset.end = `${strut} ${end}`;
      add(group, "circle", { r: 13, class: "reach" });
      add(group, "circle", { r: 5 });
      add(group, "title", {}, `Drag ${words}`);
      group.addEventListener("focus", () => (this.focused = group.dataset.end));
      group.addEventListener("blur", () => (this.focused = null));
    }
    this.stage.svg.append(this.layer);
    this.follow(this.stage.state);
    if (focused) $(`[data-end="${focused}"]`, this.layer)?.focus({ preventScroll: true });
  }

  follow(state) {
    if (this.design !== this.stage.design) return;
    for (const group of this.layer.children) {
      const [x, y] = this.stage.at(this.placeOf(group.dataset.end, state));
      set(group, { transform: `translate(${px(x)} ${px(y)})` });
    }
  }

  placeOf(name, state = this.stage.state) {
    const [strut, end] = name.split(" ").map(Number);
    const { link, at } = this.design.struts[strut].ends[end];
    return pointAt(this.design.linkage, link, at, state);
  }

  down(event) {
    const grip = event.target.closest("[data-end]");
    if (!grip || event.button || this.held || this.stage.svg.classList.contains("draws")) return;
    const [place, now] = [this.placeOf(grip.dataset.end), this.stage.back(this.stage.pointer(event))];
    this.held = { name: grip.dataset.end, pointer: event.pointerId, off: [place[0] - now[0], place[1] - now[1]] };
    grip.focus({ preventScroll: true });
    this.stage.svg.setPointerCapture(event.pointerId);
    event.preventDefault();
    event.stopPropagation();
  }

  moved(event) {
    const [x, y] = this.stage.back(this.stage.pointer(event));
    const { name, off } = this.held;
    this.put(name, [x + off[0], y + off[1]]);
  }

  // Arrows move the end with the focus by the finest step that can be seen, with shift ten times.
  key(event) {
    const grip = event.target.closest("[data-end]");
    const way = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[event.key];
    if (!grip || !way || event.ctrlKey || event.metaKey || event.altKey) return;
    const step = finestStep(this.stage) * (event.shiftKey ? 10 : 1);
    const [x, y] = this.placeOf(grip.dataset.end);
    this.put(grip.dataset.end, [x + way[0] * step, y + way[1] * step]);
    event.preventDefault();
    event.stopPropagation();
  }

  // Moves an end to a place in the drawing; in the frame of its link no finer than can be seen.
  put(name, place) {
    const [strut, end] = name.split(" ").map(Number);
    const step = finestStep(this.stage);
    const found = this.design.struts[strut].ends[end];
    const at = placeOn(this.design.linkage, found.link, place, this.stage.state);
    found.at = at.map((value) => Number((Math.round(value / step) * step).toPrecision(12)));
    this.changed();
  }

  back() {
    for (const { ends, found } of this.design.struts) ends.forEach((end, k) => (end.at = found[k]));
    this.changed();
  }

  changed() {
    this.stage.move(this.stage.theta2);
    this.renew();
    this.onChange(this.found.curves);
  }

  renew() {
    const { effort, struts } = this.design;
    this.found = effortPlots(effort, struts, this.stage.scene.unit);
    const { curves } = this.found;
    for (const [key, plot] of Object.entries(this.plots)) plot.show(curves[key]);
    this.tell();
  }

  // What the parts do, and their ends as a file has them.
  tell() {
    const { struts, effort } = this.design;
    const [deviation, lines] = [$("[data-deviation]", this.root), $("ul", this.root)];
    const words = (excess) => `${excess > 0 ? "greatest deviation" : "least margin"} ${figure(Math.abs(excess))} N`;
    deviation.textContent = words(this.found.excess) + (this.isMoved ? `; as found: ${words(this.first)}` : "");
    $("[data-back]", this.root).hidden = !this.isMoved;
    lines.replaceChildren(...struts.map((strut, k) => this.line(strut, effort.parts[k], this.found.lengths[k])));
  }

  line({ label, chosen, ends }, { compressed, extended }, lengths) {
    const line = document.createElement("li");
    const [least, most] = extent(lengths);
    const past = [[least < compressed * (1 - 1e-9), "too short"], [most > extended * (1 + 1e-9), "too long"]];
    const wrong = past.filter(([is]) => is).map(([, word]) => word);
    const range = (low, high) => `${figure(low)} to ${figure(high)}`;
    const unit = this.stage.scene.unit ? `${this.stage.scene.unit} ` : "";
    line.classList.toggle("caution", wrong.length > 0);
    const place = ({ link, at }) => `{ link = ${link}, at = [${at.map((value) => Number(value.toPrecision(12))).join(", ")}] }`;
    const told = `${label}, ${chosen}: ${range(least, most)} ${unit}long, its size ${range(compressed, extended)}`;
    line.append(told, wrong.length ? `: ${wrong.join(" and ")}` : "");
    if (this.isMoved) {
      const code = document.createElement("code");
      code.textContent = `between = [${ends.map(place).join(", ")}]`;
      line.append("; ", code);
    }
    return line;
  }

  state() {
    const { design, found } = this;
    return design && { ...found, struts: design.struts.map(({ ends }) => ends) };
  }
}
