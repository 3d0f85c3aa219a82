// A plot of the page: its caption with readings, and a drawing that is made once it comes into sight.
const watched = new WeakMap();
const sight = new IntersectionObserver(
  (entries) => {
    for (const { target, isIntersecting } of entries) watched.get(target).sighted(isIntersecting);
  },
  { rootMargin: "400px" },
);

class Picture {
  svg; marked; panel; caption; frame; onPick; options;

  constructor(node, { onPick = null } = {}) {
    Object.assign(this, { svg: $(":scope > svg", node), caption: $("figcaption", node), onPick });
    Object.assign(this, { seen: false, drawn: false, marked: null });
    watched.set(this.svg, this);
    sight.observe(this.svg);
    onResize(this.svg, () => {
      this.drawn = false;
      this.refresh();
    });
  }

  // Its look, and the marks that follow the driver: different for each kind of plot.
  paint(_svg, _box, _named = false) {}

  pointers() {}

  mark(..._marked) {}

  // Whether a file of it is about as high as it is wide.
  get tall() {
    return false;
  }

  sighted(seen) {
    this.seen = seen;
    if (this.drawn && this.marked) this.mark(...this.marked);
    this.refresh();
  }

  // Draws the visible plots that are out of date.
  refresh(always = false) {
    if (this.drawn || !this.panel || !(this.seen || always)) return;
    if (!repaint(this)) return;
    this.pointers();
    this.drawn = true;
    if (this.marked) this.mark(...this.marked);
  }

  show(panel, options = {}) {
    Object.assign(this, { panel, options, drawn: false });
    this.head();
    this.refresh();
  }

  // Title, and the name of each line with its value at the mark.
  head() {
    const title = document.createElement("b");
    title.textContent = withUnit(this.panel.title, this.panel.unit);
    const lines = this.panel.series.map(({ label }, k) =>
      this.named(label, `curve ${pen(k)}`, "M-11 0H11", document.createElement("output")),
    );
    const spots = (this.panel.points || []).map(({ label }, k) =>
      this.named(label, `spot ${spotPen(k)}`, spot(k)),
    );
    this.caption.replaceChildren(title, " ", ...lines, ...spots);
    this.outputs = lines.map((line) => $("output", line));
    this.noise = this.panel.series.map(({ values, xy }) => {
      const [low, high] = extent(values || xy.flat()) || [0, 0];
      return 1e-12 * Math.min(Math.max(-low, high), this.panel.most ?? Infinity);
    });
    this.svg.setAttribute("aria-label", title.textContent);
  }

  named(label, style, d, ...more) {
    const item = document.createElement("span");
    item.className = "reading";
    const sample = element("svg", { class: "sample", width: 22, height: 10, "aria-hidden": "true" });
    add(sample, "path", { class: style, d, transform: "translate(11 5)" });
    item.append(sample, label, " ", ...more);
    return item;
  }

  // Values at the mark as text, beside the names of their lines; rounding is nothing.
  tell(values) {
    this.outputs.forEach((output, k) => {
      const text = (value) => figure(value !== null && Math.abs(value) < this.noise[k] ? 0 : value);
      output.textContent = [values[k]].flat().map(text).join(", ");
    });
  }

  // Single points that lie in the frame.
  spots(svg, at) {
    const { left, right, top, bottom } = this.frame;
    (this.panel.points || []).forEach(({ xy }, k) => {
      xy[0].forEach((value, n) => {
        if (value === null || xy[1][n] === null) return;
        const [x, y] = at(value, xy[1][n]);
        if (x < left - 1 || x > right + 1 || y < top - 1 || y > bottom + 1) return;
        add(svg, "path", {
          d: spot(k),
          transform: `translate(${px(x)} ${px(y)})`,
          class: `spot ${spotPen(k)}`,
        });
      });
    });
  }

  // The names of both axes, below and to the left of a box.
  nameAxes(svg, { left, bottom }, across, up) {
    const { frame } = this;
    const text = (words, x, y, length, more) =>
      add(svg, "text", { x, y, "text-anchor": "middle", class: "axis", ...more }, shortened(words, length));
    if (across) text(across, px((frame.left + frame.right) / 2), bottom - 5, frame.right - frame.left);
    if (up) {
      const [x, y] = [left + 13, px((frame.top + frame.bottom) / 2)];
      text(up, x, y, frame.bottom - frame.top, { transform: `rotate(-90 ${x} ${y})` });
    }
  }

  // Calls back with places in the drawing while the mouse is pressed on it, and with `hover` also before.
  follow(callback, hover = false) {
    const at = (event) => {
      if (!this.drawn) return;
      const { left, top } = this.svg.getBoundingClientRect();
      callback([event.clientX - left, event.clientY - top]);
    };
    this.svg.addEventListener("pointerdown", (event) => {
      event.preventDefault();
      this.svg.setPointerCapture(event.pointerId);
      at(event);
    });
    this.svg.addEventListener("pointermove", (event) => {
      if (hover || this.svg.hasPointerCapture(event.pointerId)) at(event);
    });
  }

  put(dot, x, y) {
    const { left, right, top, bottom } = this.frame;
    const seen = x >= left - 1 && x <= right + 1 && y >= top - 1 && y <= bottom + 1;
    set(dot, {
      cx: seen ? px(x) : 0,
      cy: seen ? px(y) : 0,
      visibility: seen ? "visible" : "hidden",
    });
  }
}

// Paper has all that is open, in sight or not.
window.addEventListener("beforeprint", () => {
  for (const svg of $$("figure.plot > svg")) if (watched.has(svg)) watched.get(svg).refresh(true);
});
