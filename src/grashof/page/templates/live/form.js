// The task as a form: targets in a table, limits as sliders, the objective, kinds of linkage.
const GOALS = [
  ["transmission", "transmission angle"],
  ["compactness", "small size"],
  ["torque", "low peak torque"],
  ["point_speed_max", "low speed of P"],
  ["point_acceleration_max", "low acceleration of P"],
  ["band_made", "small band with tolerances"],
];
const OF_DWELLS = ["band_made", "transmission", "compactness", "torque"];
const AS_STATED = "as the file says"; // several goals, weighed
const MECHANISMS = [
  ["four-bar", "four-bar"],
  ["slider-crank", "slider-crank"],
  ["inverted-slider-crank", "inverted slider-crank"],
];
const ROTATABILITY = [
  ["", "usual"],
  ["full-crank", "driver turns fully"],
  ["crank-rocker", "crank-rocker"],
  ["any", "any"],
];

class Form {
  root; task; onFocusTarget;

  constructor(root, task, { onFocusTarget }) {
    Object.assign(this, { root, task, onFocusTarget });
    this.rows = $("[data-targets]", root);
    this.fill($("[name=objective]", root), GOALS);
    this.fill($("[name=rotatability]", root), ROTATABILITY);
    for (const [value, words] of MECHANISMS) {
      const label = document.createElement("label");
      const box = Object.assign(document.createElement("input"), { type: "checkbox", name: "mechanism", value });
      label.append(box, ` ${words}`);
      $("[data-mechanisms]", root).append(label);
    }
    this.listen();
  }

  fill(select, choices) {
    select.append(...choices.map(([value, words]) => new Option(words, value)));
  }

  listen() {
    const { root, task } = this;
    root.addEventListener("submit", (event) => event.preventDefault());
    root.addEventListener("change", (event) => {
      const { name, dataset } = event.target;
      if (dataset.cell) this.typed(event.target);
      else if (name === "mechanism") this.chooseKinds();
      else if (name === "objective") this.chooseGoal(event.target.value);
      else if (name === "rotatability") {
        task.edit(() => {
          if (event.target.value) task.requirements.rotatability = event.target.value;
          else delete task.requirements.rotatability;
        });
      } else if (dataset.limit) this.limit(event.target);
      else if (name === "closed") task.edit((document) => (document[task.kind].closed = event.target.checked));
    });
    root.addEventListener("input", (event) => {
      if (event.target.dataset.limit && event.target.type === "range") this.limit(event.target, true);
    });
    this.rows.addEventListener("click", (event) => {
      const button = event.target.closest("[data-do]");
      if (!button) return;
      const k = Number(button.closest("tr").dataset.target);
      if (button.dataset.do === "remove") task.edit(() => task.removeTarget(k));
      else this.onFocusTarget(k);
    });
  }

  // A number typed into the table; other text is undone.
  typed(input) {
    const value = Number(input.value);
    const k = Number(input.closest("tr").dataset.target);
    if (input.value.trim() === "" || !Number.isFinite(value)) input.value = String(this.task.targets[k][input.dataset.cell]);
    else this.task.edit(() => this.task.setTarget(k, { [input.dataset.cell]: value }));
  }

  chooseGoal(goal) {
    if (goal !== AS_STATED) this.task.edit((document) => (document.objective = { maximise: goal }));
  }

  chooseKinds() {
    const chosen = $$("[name=mechanism]:checked", this.root).map(({ value }) => value);
    if (!chosen.length) return this.show();
    this.task.edit((document) => {
      document.mechanism = chosen.length > 1 ? chosen : chosen[0];
      if (document.mechanism === "four-bar") delete document.mechanism;
    });
  }

  // A limit by its slider or its number; at the end of the slider, or empty, there is none.
  limit(input, moving = false) {
    const { task } = this;
    const key = input.dataset.limit;
    const { off } = this.range(key);
    const value = input.value === "" ? off : Number(input.value);
    const set = () => this.setLimit(key, value === off ? null : value);
    if (!moving && task.before === null) return task.edit(set);
    task.begin();
    task.change(set);
    if (!moving) task.end();
  }

  setLimit(key, value) {
    const wanted = this.task.requirements;
    if (key === "transmission_min_deg") {
      if (value === null) delete wanted[key];
      else wanted[key] = value;
      return;
    }
    const low = (wanted[key] || [0])[0];
    if (value === null && low === 0) delete wanted[key];
    else wanted[key] = [Math.min(low, value ?? 1e6), value ?? 1e6];
  }

  limitOf(key) {
    const value = (this.task.document.requirements || {})[key];
    if (value === undefined) return null;
    const most = Array.isArray(value) ? value[1] : value;
    return most >= 1e6 ? null : most;
  }

  // { low, high, off, step } of a slider; lengths go up to some sizes of the task.
  range(key) {
    if (key === "transmission_min_deg") return { low: 0, high: 60, off: 0, step: 1 };
    const xs = this.task.targets.flatMap(({ x }) => (x === null ? [] : [x]));
    const ys = this.task.targets.flatMap(({ y }) => (y === null ? [] : [y]));
    const spans = [xs, ys].map((all) => (all.length ? Math.max(...all) - Math.min(...all) : 1));
    const size = Math.hypot(...spans) || 1;
    const power = 10 ** Math.floor(Math.log10(size));
    const high = Math.ceil((6 * size) / power) * power;
    return { low: power / 10, high: Math.max(high, this.limitOf(key) ?? 0), off: high, step: power / 20 };
  }

  // The current task; unfinished input stays, except in another task.
  show({ opened = false } = {}) {
    const { task, root } = this;
    const { document } = task;
    const unit = document.length_unit || "";
    const typing = opened ? null : root.ownerDocument.activeElement;
    this.table(typing);
    for (const node of $$("[data-unit]", root)) node.textContent = unit ? ` (${unit})` : "";
    const dwell = task.kind === "dwell"; // six-bars alone, and goals of its own
    // two outputs have a kind of their own, too
    $("[data-mechanisms]", root).closest("fieldset").hidden = dwell || Array.isArray(document.stroke);
    for (const option of $("[name=objective]", root).options) {
      option.hidden = dwell ? !OF_DWELLS.includes(option.value) : option.value === "band_made";
    }
    const kinds = [document.mechanism || "four-bar"].flat();
    for (const box of $$("[name=mechanism]", root)) box.checked = kinds.includes(box.value);
    this.select($("[name=objective]", root), this.goal());
    this.select($("[name=rotatability]", root), (document.requirements || {}).rotatability || "");
    for (const input of $$("[data-limit]", root)) {
      if (input === typing && input.type === "number") continue;
      const { low, high, off, step } = this.range(input.dataset.limit);
      const value = this.limitOf(input.dataset.limit);
      if (input.type === "range") Object.assign(input, { min: low, max: high, step, value: value ?? off });
      else input.value = value === null ? "" : String(value);
    }
    const closed = $("[name=closed]", root);
    closed.closest("label").hidden = task.kind !== "path";
    closed.checked = Boolean((document.path || {}).closed);
  }

  // The valid task as its file and its summary.
  showFile(text, asked) {
    $("[data-file]", this.root).textContent = text;
    $("[data-asked]", this.root).replaceChildren(
      ...asked.map((words) => Object.assign(document.createElement("li"), { textContent: words })),
    );
  }

  goal() {
    const usual = this.task.kind === "dwell" ? "band_made" : "transmission";
    const wanted = (this.task.document.objective || {}).maximise ?? usual;
    return typeof wanted === "string" ? wanted : AS_STATED;
  }

  select(select, value) {
    if (![...select.options].some((option) => option.value === value)) select.append(new Option(value, value));
    select.value = value;
  }

  table(typing) {
    const { task, rows } = this;
    const turns = task.kind === "motion";
    const { targets } = task;
    const last = task.closes ? targets.length - 1 : targets.length;
    $("[data-angle]", this.root).hidden = !turns;
    while (rows.children.length > last) rows.lastElementChild.remove();
    while (rows.children.length < last) rows.append(this.row(rows.children.length));
    targets.slice(0, last).forEach((target, k) => {
      const row = rows.children[k];
      for (const input of $$("input", row)) {
        const value = target[input.dataset.cell];
        input.closest("td").hidden = input.dataset.cell === "angle" && !turns;
        if (input !== typing) input.value = value === null ? "" : String(value);
        input.disabled = value === null;
      }
      const locked = task.locked.has(`target-${k}`);
      const lock = $("[data-do=lock]", row);
      lock.textContent = locked ? "unlock" : "lock";
      lock.setAttribute("aria-pressed", String(locked));
      $("[data-do=remove]", row).disabled = targets.length <= FEWEST[task.kind] || locked;
    });
    $("[data-table]", this.root).hidden = !last;
  }

  row(k) {
    const row = $("template", this.root).content.cloneNode(true).firstElementChild;
    row.dataset.target = k;
    $("th", row).textContent = k + 1;
    for (const input of $$("input", row)) input.setAttribute("aria-label", `${input.dataset.cell} of target ${k + 1}`);
    return row;
  }
}
