// The page of an analysis: one linkage, and groups of plots with marks that follow it.
const CROWD = 5; // lines from which a plot is twice as wide

// A group that folds: its plots are made when it is opened for the first time.
class Group {
  node; pictures; page; plots;

  constructor(node, plots, page) {
    Object.assign(this, { node, plots, page, pictures: [] });
    node.addEventListener("toggle", () => this.open());
    this.open();
  }

  open() {
    if (!this.node.open || this.pictures.length) return;
    const onPick = (degrees) => this.page.turnTo(degrees / DEG);
    const figures = this.plots.map((panel) => {
      const node = $("#plot").content.firstElementChild.cloneNode(true);
      const picture = panel.places ? new Curves(node, { onPick }) : new Tracks(node, { onPick });
      node.classList.toggle("tracks", !panel.places);
      node.classList.toggle("wide", panel.series.length > CROWD);
      this.saves(node, panel, picture);
      this.pictures.push(picture);
      return node;
    });
    $(".cards", this.node).append(...figures);
    this.show();
  }

  saves(node, panel, picture) {
    const { name, heading } = this.page;
    offerSaves($(".save", node), panel.title, () => fileName(name, panel.key) || "plot", {
      svg: () => savedSvg(picture, heading),
      csv: () => savedCsv(panel),
    });
  }

  // The plots, those over the driver angle within the range that the driver is in.
  show() {
    this.pictures.forEach((picture, k) => {
      const panel = this.plots[k];
      picture.show(panel, { window: panel.over ? null : this.page.windowOf(panel) });
      picture.mark(this.page.degrees);
    });
  }

  // Plots take the places and lines of others by their keys.
  renew(curves) {
    const other = this.plots.filter(({ key }) => key in curves);
    for (const panel of other) {
      const { series, places, angles } = curves[panel.key];
      Object.assign(panel, { series, places, angles });
    }
    if (!other.length) return;
    this.node.open = true;
    this.show();
  }

  mark(degrees) {
    for (const picture of this.pictures) picture.mark(degrees);
  }
}

class AnalysisPage extends MovingPage {
  designs;

  constructor({ name, scene, designs, groups, columns, driver }) {
    super(scene, { layers: ["trace", "ghosts"] });
    Object.assign(this, { name, designs, range: 0, degrees: 0, heading: $("h1").textContent });
    this.groups = [];
    const nodes = $$("#groups details");
    const panels = groups.map((plots) => plots.map((plot) => panelOf(plot, columns, driver)));
    this.groups = panels.map((plots, k) => new Group(nodes[k], plots, this));
    for (const open of [true, false]) {
      $(open ? "#open-all" : "#close-all").addEventListener("click", () => {
        for (const node of nodes) node.open = open;
      });
    }
    for (const design of designs) design.struts = designs[0].struts; // ends that are moved are so in every range
    this.struts = new StrutHands(this.stage, $("#struts"), { onChange: (curves) => this.renew(curves) });
    const ranges = $("#range");
    if (ranges) ranges.addEventListener("change", () => this.choose(Number(ranges.value)));
    this.choose(0);
  }

  // One of the ranges that the driver can move in.
  choose(index) {
    this.player.pause();
    this.range = index;
    const { low, high, turns } = this.designs[index];
    for (const group of this.groups) group.show();
    this.stage.show(this.designs[index], this.designs);
    this.struts.show(this.designs[index]);
    this.travel(this.designs[index]);
    this.player.set(turns ? Math.PI / 3 : (low + high) / 2);
  }

  // Plots by their keys, whose lines have moved.
  renew(curves) {
    for (const group of this.groups) group.renew(curves);
  }

  // The part of a plot over the driver angle that lies in the range; null for all of it, as of tracks.
  windowOf({ places }) {
    if (this.designs.length < 2 || !places) return null;
    const { low, high } = this.designs[this.range];
    const inside = (place) => place !== null && place >= low * DEG - 1e-3 && place <= high * DEG + 1e-3;
    return extent(places.filter(inside));
  }

  moved(state) {
    this.degrees = state.theta2 * DEG;
    for (const group of this.groups) group.mark(this.degrees);
    super.moved(state);
  }

  state() {
    const groups = this.groups.map(({ node, pictures }) => ({
      title: $("h3", node).textContent,
      open: node.open,
      made: pictures.length,
      drawn: pictures.filter((picture) => picture.drawn).length,
    }));
    return { range: this.range, playing: this.player.playing, groups, byHand: this.struts.state(), ...this.stage.state };
  }
}

// A plot with its columns in their places.
function panelOf(plot, columns, driver) {
  const column = (index) => (index === undefined ? undefined : columns[index]);
  const line = (each) => ({ ...each, values: column(each.values), xy: each.xy && each.xy.map(column) });
  return {
    ...plot,
    driver,
    places: column(plot.places),
    angles: column(plot.angles),
    series: plot.series.map(line),
    points: plot.points && plot.points.map(line),
  };
}

const analysisPage = new AnalysisPage(JSON.parse($("#data").textContent));
window.grashof = Object.freeze({ state: () => analysisPage.state() });
