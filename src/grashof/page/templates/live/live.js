// The live page: the task as the hand leaves it, the designs that follow it, and those that a search finds.
const REST = 120; // ms without a change after which a search begins
const OTHERS = 10; // designs whose paths are drawn beside the chosen one
const AGAIN = 2000; // ms after which a server that does not answer is asked again

class Live extends MovingPage {
  transport; root; version; lost; preferred; transmission; velocity; torque; columns; given; pictured;

  constructor(root, transport, link) {
    super({}, { root });
    Object.assign(this, { root, transport, designs: [], chosen: null, preferred: null, version: 0, listed: null, busy: null, lost: [] });
    Object.assign(this, { trackDue: false, searchDue: false, published: null, columns: [], compared: [], timer: null });
    Object.assign(this, { given: null, refusedAt: null, pictured: "" });
    this.task = new Task({ onChange: (what) => this.changed(what) });
    this.stage.beside = () => this.paths();
    this.handles = new Handles(this.stage, this.task, {
      onMode: (mode) => this.showMode(mode),
      onFocus: (handle) => ($("[data-remove]", root).disabled = !handle || !(handle.remove || handle.target !== undefined)),
    });
    this.backdrop = new Backdrop(this.stage);
    this.stage.behind = this.backdrop;
    this.form = new Form($(".asked", root), this.task, { onFocusTarget: (k) => this.handles.toggleLock(k) });
    this.listing = new Listing($(".answer", root), {
      onPick: (key) => this.pick(key),
      onCompare: (key, wanted) => this.compare(key, wanted),
    });
    const turnTo = (degrees) => this.turnTo(degrees / DEG);
    for (const name of ["transmission", "torque", "velocity"]) {
      this[name] = new Curves($(`#${name}`, root), { onPick: turnTo });
    }
    this.struts = new StrutHands(this.stage, $("#struts", root), { onPick: turnTo });
    this.comparison = null;
    new Sharing(this, new Commands(this));
    this.open(link ? { link } : {});
  }

  // Begins with a task: that of the server, a link with its design, one of the catalogue, or a file's text.
  async open(wanted) {
    try {
      const { document, name, catalogue, given = null } = await this.transport.begin(wanted);
      this.forget();
      this.catalogue(catalogue, name);
      this.given = given;
      this.task.open(document, name);
    } catch (error) {
      // An error leaves the page unchanged, or with the task of the server.
      if (error.lines && !this.task.kind && Object.keys(wanted).length) await this.open({});
      this.failed(error, () => this.open(wanted));
    }
  }

  // Nothing of the last task stays.
  forget() {
    this.player.pause();
    Object.assign(this, { designs: [], chosen: null, preferred: null, followed: null });
    Object.assign(this, { lost: [], compared: [], listed: null, asked: null });
    Object.assign(this.stage, { view: null, design: null, together: [] });
    this.listing.clear();
    this.showComparison();
    this.notice("");
    this.warn([]);
  }

  catalogue(names, name) {
    const select = $("[name=catalogue]", this.root);
    if (!names) return;
    select.replaceChildren(new Option("choose", ""), ...names.map((each) => new Option(each, each)));
    select.value = names.includes(name) ? name : "";
  }

  // The task has changed, or only how it looks: it is drawn at once, followed, and searched when it rests.
  changed({ opened = false, looks = false }) {
    this.form.show({ opened });
    $("[data-undo]", this.root).disabled = !this.task.past.length;
    $("[data-redo]", this.root).disabled = !this.task.future.length;
    $("[data-title]", this.root).textContent = this.task.document.title || this.task.name;
    $("[data-mode=add]", this.root).hidden = !this.task.list;
    this.handles.offerJoints($("[name=joints]", this.root));
    const before = this.pictured;
    this.stage.scene = sceneOf(this.task, this.published);
    this.pictured = JSON.stringify(this.stage.scene); // its lists are those of the task, which change
    if (opened || looks || before !== this.pictured) this.stage.draw();
    const document = JSON.stringify(this.task.document);
    if (document === this.asked) return;
    this.asked = document;
    if (!opened) this.given = null;
    this.version += 1;
    this.trackDue = this.designs.length > 0 && !opened;
    this.searchDue = false;
    clearTimeout(this.timer);
    this.timer = setTimeout(() => {
      this.searchDue = true;
      this.pump();
    }, REST);
    if (this.busy && this.busy.what === "search") this.busy.leave();
    this.pump();
  }

  // One job at a time: designs are followed first, then searched for.
  pump() {
    if (this.busy) return;
    if (this.trackDue) {
      this.trackDue = false;
      const keys = this.chosen === null ? [] : [this.chosen];
      this.run("track", { keys });
    } else if (this.searchDue) {
      this.searchDue = false;
      this.run("search", this.given === null ? {} : { given: this.given });
    }
  }

  async run(what, options) {
    const { version } = this;
    const leaving = new AbortController();
    const busy = { what, leave: () => leaving.abort() };
    this.busy = busy;
    this.tell(what === "track" ? "following" : "searching");
    const { document, name } = this.task;
    try {
      const body = { document, name, ...options };
      await this.transport.ask(what, body, (line) => this.received(line, version), leaving.signal);
    } catch (error) {
      if (error.name !== "AbortError") this.failed(error, () => this.again());
    } finally {
      this.busy = null;
    }
    this.pump();
  }

  // The same once more, of a server that did not answer.
  again() {
    this.searchDue = true;
    this.pump();
  }

  received(line, version) {
    if (line.kind === "error") this.refused(line.lines);
    else if (line.kind === "progress") {
      const solved = line.starts === null ? "" : `${line.solved} of ${line.starts} starts, `;
      this.tell(`searching: ${solved}${line.verified} designs`);
    }
    else if (line.kind === "problem") this.stated(line, version);
    else if (line.kind === "done") this.took = line.seconds;
    else if (line.kind === "list") this.list(line, version);
  }

  // The task is valid: its file and its summary.
  stated({ text, asked }, version) {
    if (version !== this.version) return;
    if (version !== this.refusedAt) this.warn([]);
    this.form.showFile(text, asked);
  }

  list(line, version) {
    const { phase, designs, columns, scene, lost, found, note } = line;
    if (phase !== "track" && version !== this.version) return;
    const first = this.designs.length === 0;
    this.listed = { version, phase };
    Object.assign(this, { columns, found, lost });
    if (phase === "track") {
      // Those that are lost or not followed stay as they were until the next search.
      const moved = new Map(designs.map((design) => [design.key, design]));
      this.designs = this.designs.map((design) => moved.get(design.key) || design);
      this.followed = designs.map(({ key }) => key);
    } else {
      this.designs = designs;
      this.followed = null;
    }
    this.published = scene.published;
    this.stage.scene = sceneOf(this.task, this.published);
    this.listing.show({ designs, columns, lost, phase, found });
    this.notice(note ? `${note[0].toUpperCase()}${note.slice(1)}.` : "");
    this.headline(line);
    // A design that a search has not found yet may come back until it is done.
    const kept = [this.preferred, this.chosen].find((key) => this.has(key));
    if (this.designs.length) this.choose(kept ?? this.designs[0].key, { first });
    else this.showNone();
    if (phase === "found") {
      this.preferred = this.chosen;
      this.compared = this.compared.filter((key) => this.has(key));
    }
    this.showComparison();
  }

  has(key) {
    return this.designs.some((design) => design.key === key);
  }

  headline({ phase, designs, lost, headline, found }) {
    const count = `${designs.length} design${designs.length === 1 ? "" : "s"}`;
    const words = {
      track: `${count} ${designs.length === 1 ? "follows" : "follow"}${lost.length ? `, ${lost.length} lost` : ""}`,
      searching: `${count} so far`,
      found: found ? headline : "Closest misses: no design meets all requirements",
    };
    $("[data-headline]", this.root).textContent = words[phase];
    if (phase === "found") this.tell(found ? "verified, ranked" : "no design");
  }

  showNone() {
    this.chosen = null;
    this.stage.show(null);
    this.struts.show(null);
    for (const name of ["transmission", "torque", "velocity"]) $(`#${name}`, this.root).hidden = true;
  }

  get design() {
    return this.designs.find(({ key }) => key === this.chosen);
  }

  // As a hand does: the design stays the chosen one in the lists to come.
  pick(key) {
    this.preferred = key;
    this.choose(key);
  }

  choose(key, { first = false } = {}) {
    const other = key !== this.chosen;
    this.chosen = key;
    const { design } = this;
    if (other) this.player.pause();
    this.stage.svg.classList.toggle("lost", this.lost.some((each) => each.key === key));
    this.curves(design);
    this.stage.show(design);
    this.struts.show(design);
    this.travel(design);
    if (first || other) this.player.set(design.theta2[0]);
    else this.player.set(within(design, this.stage.theta2));
    this.listing.mark(key);
  }

  curves(design) {
    $("#transmission", this.root).hidden = false;
    $("#velocity", this.root).hidden = !this.task.list; // P has no meaning for functions and strokes
    $("#torque", this.root).hidden = !design.torque;
    const { places, states, options } = showTravel(design, this.stage.scene.closed, this.transmission, this.torque);
    const speeds = states.map((state) => pointSpeed(design.linkage, state));
    const unit = this.stage.scene.unit ? `${this.stage.scene.unit}/rad` : "per rad";
    const panel = { title: "Velocity of P per driver speed", unit, places, angles: places };
    this.velocity.show({ ...panel, series: [{ label: "v", values: speeds }] }, { ...options, scaled: true });
  }

  moved(state) {
    const degrees = state.theta2 * DEG;
    this.transmission.mark(degrees, [state.mu * DEG]);
    this.velocity.mark(degrees, [pointSpeed(this.design.linkage, state)]);
    if (this.design.torque) this.torque.mark(degrees);
    this.struts.mark(degrees);
    super.moved(state);
  }

  current() {
    const { comparison } = this;
    return comparison && comparison.root.contains(document.activeElement) ? comparison.player : this.player;
  }

  // The paths of the other designs, in the colours of their rows.
  paths() {
    if (!$("[name=paths]", this.root).checked) return;
    const shown = this.designs.filter(({ key }) => !this.followed || this.followed.includes(key)).slice(0, OTHERS);
    for (const design of shown) {
      if (design.key === this.chosen) continue;
      const { points } = design.task ? pathOf(design.linkage, anglesBetween(...design.task, true, 60)) : travelPath(design);
      add(this.stage.svg, "path", { d: through(points.map(this.stage.at)), class: `other pen-${1 + (design.key % 8)}` });
    }
  }

  compare(key, wanted) {
    this.compared = this.compared.filter((each) => each !== key);
    if (wanted) this.compared.push(key);
    this.showComparison();
  }

  showComparison() {
    const known = this.compared.filter((key) => this.has(key));
    this.listing.markCompared(known);
    if (!known.length && !this.comparison) return;
    const { scene } = this.stage;
    this.comparison ||= new Comparison($("#compare", this.root), {
      scene,
      designs: this.designs,
      columns: this.columns,
      onPick: (index) => this.pick(this.designs[index].key),
      onChange: (index, wanted) => this.compare(this.designs[index].key, wanted),
    });
    const indexes = known.map((key) => this.designs.findIndex((design) => design.key === key));
    this.comparison.renew({ scene, designs: this.designs, columns: this.columns, indexes });
  }

  showMode(mode) {
    for (const button of $$("[data-mode]", this.root)) {
      button.setAttribute("aria-pressed", String(button.dataset.mode === mode));
    }
    for (const options of $$("[data-when]", this.root)) options.hidden = options.dataset.when !== mode;
  }

  tell(words) {
    $("[data-status]", this.root).textContent = words;
  }

  notice(words) {
    const node = $("[data-notice]", this.root);
    node.textContent = words;
    node.hidden = !words;
  }

  // Lines of an error, shown until a task is valid.
  warn(lines) {
    const node = $("[data-warning]", this.root);
    this.refusedAt = lines.length ? this.version : null;
    node.textContent = lines.join("\n");
    node.hidden = !lines.length;
    this.form.root.classList.toggle("refused", lines.length > 0);
  }

  refused(lines) {
    this.warn(lines);
    this.tell("refused");
  }

  // A refusal is shown; a request without an answer is sent again.
  failed(error, again) {
    if (error.lines) return this.refused(error.lines);
    this.notice("The server does not answer; the request is repeated every two seconds. Is grashof live still running?");
    this.tell("no answer");
    setTimeout(again, AGAIN);
  }

  state() {
    const { version, listed, chosen, lost, busy, compared } = this;
    const designs = this.designs.map(({ key, id, linkage }) => ({ key, id, linkage }));
    const rows = [...this.listing.rows.keys()];
    const { theta2 } = this.stage;
    const { document } = this.task;
    const { scene } = this.stage;
    return { scene, version, listed, chosen, lost, designs, rows, compared, theta2, busy: busy && busy.what, document };
  }
}

function startLive(root, token, link = "") {
  const live = new Live(root, typeof token === "string" ? new HttpTransport(token) : token, link);
  window.grashof = Object.freeze({ state: () => live.state() });
  return live;
}
