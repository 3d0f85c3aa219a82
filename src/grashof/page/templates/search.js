// The page of a search: the chosen design is drawn, marked and described everywhere.
class SearchPage extends MovingPage {
  designs; scene; found; values; name; columns; loci;

  constructor({ name, found, scene, columns, axes, values, designs, loci }) {
    super(scene, { layers: ["trace", "ghosts", "close"] });
    Object.assign(this, { name, found, scene, columns, values, designs, loci, chosen: 0 });
    const choose = (index) => this.choose(index);
    const turnTo = (degrees) => this.turnTo(degrees / DEG);
    this.transmission = new Curves($("#transmission"), { onPick: turnTo });
    this.output = designs[0].function !== undefined && new Curves($("#output"));
    this.error = this.output && new Curves($("#error"));
    this.torque = designs[0].torque && new Curves($("#torque"), { onPick: turnTo });
    this.dwell = $("#dwell") && new Curves($("#dwell"), { onPick: turnTo });
    this.struts = new StrutHands(this.stage, $("#struts"), { onPick: turnTo });
    this.scatter = $("#scatter") && new Scatter($("#scatter"), { columns: axes, designs, onPick: choose });
    this.comparison = new Comparison($("#compare"), {
      scene,
      designs,
      columns,
      onPick: choose,
      onChange: (index, wanted) => this.compared(index, wanted),
    });
    this.table = new DesignTable($("#designs"), {
      designs,
      onPick: (index) => {
        this.choose(index);
        $("#chosen").scrollIntoView({ block: "nearest" });
      },
      onFilter: (shown) => this.scatter && this.scatter.filter(shown),
      onCompare: (index, wanted) => this.comparison.toggle(index, wanted),
    });
    this.table.pictures();
    this.controls();
    this.saves();
    this.choose(0);
  }

  get design() {
    return this.designs[this.chosen];
  }

  choose(index) {
    this.player.pause();
    this.chosen = index;
    this.curves(this.design);
    this.stage.show(this.design);
    this.struts.show(this.design);
    this.travel(this.design);
    this.player.set(this.design.theta2[0]);
    this.table.mark(index);
    if (this.scatter) this.scatter.mark(index);
    this.describe(this.design);
    this.tellCompared();
  }

  turnTo(theta2) {
    super.turnTo(this.design.turns ? countedIn(this.player, theta2) : theta2);
  }

  // The driver moves over its full range, or only through the task.
  travel({ low, high, turns, direction, task }) {
    const choice = $("#only-task");
    choice.disabled = !task || this.scene.closed;
    const part = choice.checked && !choice.disabled;
    const [from, to] = part ? [Math.min(...task), Math.max(...task)] : [low, high];
    this.player.travel({ low: from, high: to, wraps: turns && !part, sense: direction, step: 1 / DEG });
    tellTravel(this.stage, low, high);
  }

  curves(design) {
    const travel = showTravel(design, this.scene.closed, this.transmission, this.torque);
    if (this.output) this.outputs(design);
    if (this.dwell) this.rests(design, travel);
  }

  // The last link, or the slide, which stands still between the marks.
  rests(design, { places, states, options }) {
    const values = outputsOf(states);
    const [unit, label] = states[0].slide === undefined ? ["deg", "last link"] : [this.scene.unit, "slide"];
    const panel = { title: "Output", unit, driver: "driver angle theta2 (deg)", places, angles: places };
    this.dwell.show({ ...panel, series: [{ label, values }] }, options);
  }

  // Wanted and generated output of a function, and the error between them.
  outputs(design) {
    const empty = [null, null];
    const none = { title: "output", unit: "", over: "", inputs: [0, 1], wanted: empty, generated: empty, error: empty };
    const { title, unit, over, inputs, wanted, generated, error } = design.function || none;
    const panel = { unit, places: inputs, over };
    const first = design.theta2[0];
    const marks = design.theta2.map((angle) => Math.abs(angle - first) * DEG);
    const series = [{ label: "wanted", values: wanted }, { label: "generated", values: generated }];
    this.output.show({ ...panel, title: title[0].toUpperCase() + title.slice(1), series }, { marks, bounded: true });
    const errors = [{ label: "error", values: error }];
    this.error.show({ ...panel, title: "Structural error", series: errors }, { marks, bounded: true });
  }

  moved(state) {
    const degrees = state.theta2 * DEG;
    this.transmission.mark(degrees, [state.mu * DEG]);
    if (this.torque) this.torque.mark(degrees);
    if (this.dwell) this.dwell.mark(degrees);
    this.struts.mark(degrees);
    super.moved(state);
  }

  // Name and values of the design that is shown.
  describe({ id, figures }) {
    const { found } = this;
    $("#chosen").textContent = `${found ? "Design" : "Closest miss"} ${figures.rank}`;
    const pareto = figures.pareto && found ? ", Pareto-optimal" : "";
    $("#about").textContent = `${id}, ${figures.grashof_class}${pareto}`;
    $("#named").textContent = $("#chosen").textContent.toLowerCase();
    for (const node of $$("[data-rank]")) node.textContent = figures.rank;
    if (!found) $("#misses").textContent = figures.misses;
    const known = this.values.filter(({ key }) => figures[key] !== null);
    const lines = known.map(({ key, name, unit, about, decimals, noise }) => {
      const line = document.createElement("div");
      line.title = about ? `${key}: ${about}` : key;
      line.append(document.createElement("dt"), document.createElement("dd"));
      line.firstChild.textContent = name;
      line.lastChild.textContent = `${rounded(figures[key], decimals, noise)} ${unit}`.trim();
      return line;
    });
    $("#figures dl").replaceChildren(...lines);
  }

  compared(index, wanted) {
    this.table.compared(index, wanted);
    this.tellCompared();
  }

  tellCompared() {
    const compared = this.comparison.indexes.includes(this.chosen);
    $("#add").textContent = compared ? "Remove from comparison" : "Compare";
    $("#add").setAttribute("aria-pressed", String(compared));
  }

  controls() {
    if (this.loci) {
      $("#loci").addEventListener("change", (event) => {
        this.stage.beside = event.target.checked ? () => drawLoci(this.stage, this.loci) : () => {};
        this.stage.draw();
      });
    }
    $("#only-task").addEventListener("change", () => this.travel(this.design));
    $("#add").addEventListener("click", () => {
      this.comparison.toggle(this.chosen, !this.comparison.indexes.includes(this.chosen));
    });
    const targets = $("#targets");
    targets.append(...this.design.theta2.map((_, k) => new Option(`target ${k + 1}`, k)));
    targets.addEventListener("change", () => {
      this.turnTo(within(this.design, this.design.theta2[Number(targets.value)]));
      targets.value = "";
    });
  }

  current() {
    return this.comparison.root.contains(document.activeElement) ? this.comparison.player : this.player;
  }

  // The contents of the page as files; the table as listed now, with every digit.
  saves() {
    const design = () => `${this.found ? "design" : "closest-miss"}-${this.design.figures.rank}`;
    const heading = () => `${$("h1").textContent}, ${$("#named").textContent} (${this.design.id})`;
    const plots = { transmission: this.transmission, output: this.output, error: this.error, torque: this.torque, dwell: this.dwell, ...this.struts.plots };
    for (const [key, picture] of Object.entries(plots).filter((entry) => entry[1])) {
      const title = { transmission: "transmission angle", error: "structural error", "effort-lengths": "lengths" }[key] || key;
      offerSaves($(`#${key} .save`), title, () => fileName(this.name, design(), key), {
        svg: () => savedSvg(picture, heading()),
        csv: () => savedCsv(picture.panel),
      });
    }
    offerSaves($("#save-drawing"), "drawing", () => fileName(this.name, design()), {
      svg: () => savedDrawing(this.stage.svg),
    });
    if (this.scatter) {
      offerSaves($("#scatter .save"), "comparison", () => fileName(this.name, this.scatter.panel.title), {
        svg: () => savedSvg(this.scatter, $("h1").textContent),
      });
    }
    const file = () => fileName(this.name, this.found ? "designs" : "closest-misses");
    offerSaves($("#save-table"), "table", file, { csv: () => this.listedCsv() });
  }

  listedCsv() {
    const rows = this.table.listed().map((index) => this.designs[index].figures);
    const known = ({ key }) => rows.some((row) => row[key] !== null);
    const others = ["best_at", "caution", "mechanism", "grashof_class", "misses"];
    const named = ["rank", "id", ...others].map((key) => this.values.find((each) => each.key === key));
    const [rank, id, ...words] = named.filter((each) => each && (each.key === "rank" || known(each)));
    const columns = [rank, id, ...this.columns, ...words];
    return csvOf(
      columns.map(({ key, label, name, unit }) => [withUnit(label || name, unit), rows.map((row) => row[key])]),
    );
  }

  state() {
    return {
      design: this.design.id,
      ...this.stage.state,
      playing: this.player.playing,
      listed: this.table.listed().map((index) => this.designs[index].id),
      compared: this.comparison.state(),
      byHand: this.struts.state(),
    };
  }
}

// Without any design the page shows the task.
function start(data) {
  if (data.designs.length) return new SearchPage(data);
  new Stage($("#stage"), data.scene).show(null);
  return { state: () => ({ design: null }) };
}

const searchPage = start(JSON.parse($("#data").textContent));
window.grashof = Object.freeze({ state: () => searchPage.state() });
