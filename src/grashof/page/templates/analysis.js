// The page of an analysis: one linkage, and a mark on every curve that follows it.
class AnalysisPage {
  constructor({ scene, designs, panels, theta2 }) {
    Object.assign(this, { designs, panels, theta2, range: 0 });
    this.stage = new Stage($("#stage"), scene, {
      onDrive: (angle) => this.turnTo(angle),
      onDraw: (state) => this.moved(state),
    });
    this.player = new Player($("#player"), { onMove: (angle) => this.stage.move(angle) });
    const onPick = (degrees) => this.turnTo(degrees / DEG);
    this.curves = $$("#curves figure").map((node) => new Curves(node, { onPick }));
    $("#trace").addEventListener("change", (event) => {
      this.stage.trace = event.target.checked;
      this.stage.draw();
    });
    const ranges = $("#range");
    if (ranges) ranges.addEventListener("change", () => this.choose(Number(ranges.value)));
    listenToKeys(this.stage, this.player);
    listenOnPage(() => this.player);
    this.choose(0);
  }

  // One of the ranges that the driver can move in.
  choose(index) {
    this.player.pause();
    this.range = index;
    const { low, high, turns, direction } = this.designs[index];
    this.curves.forEach((curve, k) => {
      const series = this.panels[k].series.map(({ label, values }) => ({ label, values: values[index] }));
      curve.show({ ...this.panels[k], series }, this.theta2[index], { bounded: !turns });
    });
    this.stage.show(this.designs[index], this.designs);
    this.player.travel({ low, high, wraps: turns, sense: direction, step: 1 / DEG });
    tellTravel(this.stage, low, high);
    this.player.set(turns ? Math.PI / 3 : (low + high) / 2);
  }

  turnTo(theta2) {
    this.player.pause();
    this.player.set(theta2);
  }

  moved(state) {
    for (const curve of this.curves) curve.mark(state.theta2 * DEG);
    tellPosition(this.stage, state);
  }

  state() {
    return { range: this.range, playing: this.player.playing, ...this.stage.state };
  }
}

const page = new AnalysisPage(JSON.parse($("#data").textContent));
window.grashof = Object.freeze({ state: () => page.state() });
