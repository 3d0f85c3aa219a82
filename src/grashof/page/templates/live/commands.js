// Buttons, menus and keys of the live page.
const MOST_POINTS = 200; // of a path, as `MOST_TARGETS` in `requests.py`

class Commands {
  root; live;

  constructor(live) {
    Object.assign(this, { live, root: live.root });
    const on = (selector, type, act) => {
      for (const node of $$(selector, this.root)) node.addEventListener(type, act);
    };
    on("[data-undo]", "click", () => live.task.undo());
    on("[data-redo]", "click", () => live.task.redo());
    on("[data-mode]", "click", ({ currentTarget }) => this.mode(currentTarget.dataset.mode));
    on("[data-save]", "click", ({ currentTarget }) => this.save(currentTarget.dataset.save));
    on("[name=snap]", "change", ({ target }) => (live.handles.snaps = target.checked));
    on("[name=count]", "change", ({ target }) => {
      const count = Math.round(Number(target.value));
      live.handles.count = Math.min(Math.max(Number.isFinite(count) ? count : FREEHAND, FEWEST.path), MOST_POINTS);
      target.value = String(live.handles.count);
    });
    on("[name=joints]", "change", ({ target }) => (live.handles.joints = target.value.split(" ")));
    on("[name=shape]", "change", ({ target }) => (live.handles.shape = target.value));
    on("[data-remove]", "click", () => live.handles.removeChosen());
    on("[name=paths]", "change", () => live.stage.draw());
    on("[name=ghosts]", "change", ({ target }) => {
      live.stage.ghosts = target.checked;
      live.stage.draw();
    });
    on("[name=catalogue]", "change", ({ target }) => target.value && this.open({ catalogue: target.value }));
    const opened = (open) => ({ target }) => {
      const [file] = target.files;
      target.value = "";
      this.closeMenus();
      if (file) open(file);
    };
    on("[name=problem]", "change", opened((file) => this.openFile(file)));
    on("[name=photo]", "change", opened((file) => this.openPhoto(file)));
    on("[name=drawing]", "change", opened((file) => this.openDrawing(file)));
    on("[data-distance]", "submit", (event) => this.scale(event));
    this.keys();
  }

  keys() {
    const { live } = this;
    this.root.addEventListener("keydown", (event) => {
      const typing = event.target.closest("input:not([type=checkbox], [type=range]), select");
      if (!(event.ctrlKey || event.metaKey) || typing) return;
      const key = event.key.toLowerCase();
      if (key === "z" && !event.shiftKey) live.task.undo();
      else if (key === "y" || key === "z") live.task.redo();
      else if (key === "s") this.save("problem");
      else return;
      event.preventDefault();
    });
    document.addEventListener("pointerdown", (event) => {
      for (const menu of $$(".menu[open]", this.root)) if (!menu.contains(event.target)) menu.open = false;
    });
  }

  closeMenus() {
    for (const menu of $$(".menu[open]", this.root)) menu.open = false;
  }

  open(wanted) {
    this.closeMenus();
    this.live.backdrop.clear();
    this.live.open(wanted);
  }

  async openFile(file) {
    this.open({ text: await file.text(), name: file.name.replace(/\.toml$/i, "") });
  }

  openPhoto(file) {
    const picture = new Image();
    picture.onload = () => {
      this.live.backdrop.showPhoto(picture.src, picture.naturalWidth, picture.naturalHeight);
      this.scalable();
    };
    picture.onerror = () => this.live.warn([`${file.name} is not a picture that the browser can show`]);
    picture.src = URL.createObjectURL(file);
  }

  async openDrawing(file) {
    await this.ask("outline", { text: await file.text() }, ({ polylines }) => {
      this.live.backdrop.showLines(polylines);
      this.scalable();
    });
  }

  scalable() {
    $("[data-mode=scale]", this.root).hidden = !this.live.backdrop.shown;
    this.mode("scale");
  }

  // Two clicks on the backdrop, then the distance between them.
  mode(mode) {
    const { live } = this;
    live.handles.setMode(mode);
    live.backdrop.marks = null;
    $("[data-distance]", this.root).hidden = true;
    if (mode !== "scale") return;
    live.backdrop.marks = [];
    live.handles.onPlace = (place) => {
      live.backdrop.marks.push(place);
      live.stage.draw();
      if (live.backdrop.marks.length < 2) return;
      live.handles.setMode("move");
      $("[data-distance]", this.root).hidden = false;
      $("[name=distance]", this.root).focus();
    };
  }

  scale(event) {
    event.preventDefault();
    const form = event.target;
    const distance = Number(new FormData(form).get("distance"));
    form.hidden = true;
    if (distance > 0) this.live.backdrop.scale(this.live.backdrop.marks, distance);
    form.reset();
  }

  async save(what) {
    this.closeMenus();
    const { live } = this;
    const name = fileName(live.task.name, live.design ? live.design.id : "task");
    const drawing = () => savedDrawing(live.stage.svg);
    if (what === "svg") return download(`${name}.svg`, drawing(), "image/svg+xml");
    if (what === "png") return download(`${name}.png`, await savedPng(drawing()), "image/png");
    const body = { file: what, ...(live.chosen === null ? {} : { key: live.chosen }) };
    await this.ask("file", body, ({ name: file, text, type }) => download(file, text, type));
  }

  // A side job: its result goes to `use`, a refusal is shown.
  async ask(what, body, use) {
    const { document, name } = this.live.task;
    const onLine = (line) => {
      if (line.kind === "error") this.live.warn(line.lines);
      else if (line.kind !== "done") use(line);
    };
    try {
      await this.live.transport.ask(what, { document, name, ...body }, onLine);
    } catch (error) {
      this.live.failed(error, () => this.ask(what, body, use));
    }
  }
}
