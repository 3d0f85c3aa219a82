// Designs side by side, at the same scale, at the same place of the task at the same moment.
class Comparison {
  designs; scene; root; onChange; onPick; columns;

  constructor(root, { scene, designs, columns, onPick, onChange }) {
    Object.assign(this, { root, scene, designs, columns, onPick, onChange, indexes: [], stages: [] });
    this.list = $("[data-list]", root);
    this.player = new Player(root, { onMove: (progress) => this.move(progress) });
    this.travel();
    root.addEventListener("keydown", (event) => {
      if (event.target.closest(".stage") && this.player.key(event)) event.preventDefault();
    });
  }

  // From the first target to the last, or around.
  travel() {
    const { designs, scene } = this;
    const last = (designs[0] ? designs[0].theta2.length : 2) - (scene.closed ? 0 : 1);
    this.player.travel({ low: 0, high: last, wraps: scene.closed, step: 0.02 });
  }

  // Another list, and which designs of it are compared.
  renew(given) {
    Object.assign(this, given);
    this.root.hidden = !this.indexes.length;
    if (this.root.hidden) this.player.pause();
    this.travel();
    this.draw();
  }

  toggle(index, wanted) {
    this.indexes = this.indexes.filter((each) => each !== index);
    if (wanted) this.indexes.push(index);
    else if (!this.indexes.length) this.player.pause();
    this.root.hidden = !this.indexes.length;
    this.draw();
    this.onChange(index, wanted);
  }

  draw() {
    const chosen = this.indexes.map((index) => this.designs[index]);
    this.stages = [];
    this.list.replaceChildren(...this.indexes.map((index) => this.card(index)));
    this.stages.forEach((stage, k) => stage.show(chosen[k], chosen));
    this.move(this.player.value);
  }

  card(index) {
    const design = this.designs[index];
    const card = $("template", this.root).content.cloneNode(true).firstElementChild;
    const pick = $("[data-pick]", card);
    pick.textContent = `Design ${design.figures.rank}`;
    pick.addEventListener("click", () => this.onPick(index));
    $("[data-remove]", card).addEventListener("click", () => this.toggle(index, false));
    $("[data-remove]", card).setAttribute("aria-label", `Remove design ${design.figures.rank}`);
    const output = $("output", card);
    const svg = $(".stage", card);
    svg.setAttribute("aria-label", `Design ${design.figures.rank}`);
    this.stages.push(
      new Stage(svg, this.scene, {
        onDraw: ({ theta2, mu }) => {
          output.textContent = `θ2 ${fixed(theta2 * DEG, 1)} deg, μ ${fixed(mu * DEG, 1)} deg`;
        },
      }),
    );
    $("tbody", card).append(
      ...this.columns.map(({ key, label, unit, decimals, noise }) => {
        const row = document.createElement("tr");
        const value = rounded(design.figures[key], decimals < 0 ? null : decimals, noise);
        for (const text of [label, value, unit]) row.insertCell().textContent = text;
        return row;
      }),
    );
    return card;
  }

  move(progress) {
    this.stages.forEach((stage) => stage.move(angleAt(stage.design, progress)));
  }

  state() {
    return this.indexes.map((index, k) => ({ design: this.designs[index].id, ...this.stages[k].state }));
  }
}

// Driver angle between target number `progress` and the next; after the last one a turn is completed.
function angleAt({ theta2, direction }, progress) {
  const knots = [...theta2, theta2[0] + direction * TURN];
  const k = Math.min(Math.floor(progress), knots.length - 2);
  return knots[k] + (knots[k + 1] - knots[k]) * (progress - k);
}
