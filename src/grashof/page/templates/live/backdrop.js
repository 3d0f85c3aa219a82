// A photo or the lines of a drawing behind the task, at a place and a scale.
class Backdrop {
  stage; lines;

  constructor(stage) {
    Object.assign(this, { stage, picture: null, lines: null, at: [0, 0], unit: 1, marks: null });
  }

  // A picture of a size in px, in the middle of the visible part.
  showPhoto(href, width, height) {
    const { stage } = this;
    const { clientWidth, clientHeight } = stage.svg;
    this.clear();
    this.unit = Math.min(clientWidth / width, clientHeight / height) / stage.unit;
    const [x, y] = stage.back([clientWidth / 2, clientHeight / 2]);
    this.picture = { href, width, height };
    this.at = [x - (width * this.unit) / 2, y - (height * this.unit) / 2];
    stage.draw();
  }

  // Polylines as they are in their drawing.
  showLines(lines) {
    this.clear();
    Object.assign(this, { lines, at: [0, 0], unit: 1 });
    this.stage.see(null);
  }

  clear() {
    if (this.picture) URL.revokeObjectURL(this.picture.href);
    Object.assign(this, { picture: null, lines: null, marks: null });
  }

  get shown() {
    return Boolean(this.picture || this.lines);
  }

  // Corners to be seen besides the task.
  points() {
    return (this.lines || []).flat().map((point) => this.place(point));
  }

  place([x, y]) {
    return [this.at[0] + this.unit * x, this.at[1] + this.unit * y];
  }

  // Scaled about the first of two places, to a distance between them.
  scale([from, to], distance) {
    const factor = distance / (Math.hypot(to[0] - from[0], to[1] - from[1]) || 1);
    this.at = this.at.map((value, axis) => from[axis] + factor * (value - from[axis]));
    this.unit *= factor;
    this.marks = null;
    this.stage.draw();
  }

  draw() {
    const { stage } = this;
    const first = stage.svg.firstChild;
    const behind = element("g", { class: "backdrop" });
    if (this.picture) {
      const { href, width, height } = this.picture;
      const [x, y] = stage.at([this.at[0], this.at[1] + height * this.unit]);
      const size = this.unit * stage.unit;
      add(behind, "image", { href, x: px(x), y: px(y), width: px(width * size), height: px(height * size), preserveAspectRatio: "none" });
    }
    for (const line of this.lines || []) {
      add(behind, "path", { d: through(line.map((point) => stage.at(this.place(point)))) });
    }
    stage.svg.insertBefore(behind, first);
    for (const mark of this.marks || []) {
      const [x, y] = stage.at(mark);
      add(stage.svg, "path", { d: `M${px(x)} ${px(y)}m-9 0h18m-9 -9v18`, class: "by-hand" });
    }
  }
}
