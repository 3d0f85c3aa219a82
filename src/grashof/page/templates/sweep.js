// The page of a sweep: a table of combinations, and the best design of the one that is chosen.
class SweepPage extends MovingPage {
  name; designs; scenes; values; columns; axes; measure;

  constructor({ name, best, scenes, designs, values, columns, axes, measure }) {
    super(scenes[0] || {}, { layers: ["trace", "ghosts"] });
    Object.assign(this, { name, scenes, designs, values, columns, axes, measure, chosen: null });
    this.body = $("#combinations tbody");
    this.rows = $$("tr", this.body);
    this.headers = $$("#combinations th[aria-sort]");
    this.form = $("#combinations form");
    for (const [place, header] of this.headers.entries()) {
      $("button", header).addEventListener("click", () => this.sort(place));
    }
    this.body.addEventListener("click", (event) => {
      const row = event.target.closest("tr");
      if (row) this.choose(Number(row.dataset.index));
    });
    this.form.addEventListener("input", () => this.filter());
    this.form.addEventListener("submit", (event) => event.preventDefault());
    this.tradeoff = this.plotted($("#tradeoff"));
    this.pictures();
    this.filter();
    this.choose(best);
  }

  // The combinations as cells, over two numbers, or as points; none where they have nothing to compare.
  plotted(root) {
    if (!root) return null;
    const { axes, measure } = this;
    const numbers = this.columns.filter(({ key, text }) => !text && key !== "combination");
    const figures = (row) => Object.fromEntries(this.columns.map(({ key }, k) => [key, row[k]]));
    const designs = this.values.map((row) => ({ figures: { ...figures(row), rank: row[0], pareto: false } }));
    const onPick = (index) => this.choose(index);
    const wanted = { x: axes, y: [measure], area: [""] };
    const made =
      axes.length === 2
        ? new Cells(root, { columns: numbers, designs, axes, measure, onPick })
        : new Scatter(root, { columns: numbers, designs, wanted, called: "combination", onPick });
    offerSaves($(".save", root), "trade-off", () => fileName(this.name, "trade-off"), {
      svg: () => savedSvg(made, $("h1").textContent),
    });
    return made;
  }

  choose(index) {
    this.chosen = index;
    const row = this.rows.find((each) => Number(each.dataset.index) === index);
    for (const each of this.rows) {
      each.classList.toggle("chosen", each === row);
      $("[data-pick]", each).setAttribute("aria-pressed", String(each === row));
    }
    if (this.tradeoff) this.tradeoff.mark(index);
    const { drawing, scene, about, note } = this.designs[index];
    $("#chosen").textContent = `Combination ${$("[data-pick]", row).textContent}`;
    $("#about").textContent = about;
    $("#note").textContent = note;
    $("#note").hidden = !note;
    if (this.player) this.player.pause();
    $("#stage").style.visibility = scene === null ? "hidden" : "visible"; // no problem, nothing to draw
    if ($("#player")) $("#player").style.visibility = drawing ? "visible" : "hidden";
    for (const node of $$(".readout, .legend")) node.style.visibility = drawing ? "visible" : "hidden";
    if (scene === null) return;
    this.stage.scene = this.scenes[scene];
    this.stage.show(drawing);
    if (!drawing) return;
    this.travel(drawing);
    this.player.set(drawing.theta2[0]);
  }

  sort(place) {
    sortRows(this.rows, this.headers, this.headers[place], (index) => this.values[index][place]);
    this.body.append(...this.rows);
  }

  filter() {
    const wanted = new FormData(this.form);
    const text = String(wanted.get("text")).trim().toLowerCase();
    for (const row of this.rows) {
      const passes = row.textContent.toLowerCase().includes(text);
      row.hidden = !passes || (wanted.get("found") && row.dataset.found !== "1");
    }
    if (this.tradeoff) this.tradeoff.filter(this.listed());
    $("output", this.form).textContent = `${this.listed().length} of ${this.rows.length}`;
  }

  listed() {
    return this.rows.filter((row) => !row.hidden).map((row) => Number(row.dataset.index));
  }

  pictures() {
    for (const row of this.rows) {
      const { drawing } = this.designs[Number(row.dataset.index)];
      if (drawing) $(".thumb", row).replaceWith(thumbnail(drawing));
    }
  }

  state() {
    return { chosen: this.chosen, listed: this.listed(), ...this.stage.state };
  }
}

const sweepPage = new SweepPage(JSON.parse($("#data").textContent));
window.grashof = Object.freeze({ state: () => sweepPage.state() });
