// Play, pause, step and set: a value that runs to and fro over its travel, or around.
class Player {
  low; high; wraps; onMove; step;

  constructor(root, { onMove }) {
    Object.assign(this, {
      onMove,
      low: 0,
      high: 1,
      wraps: false,
      sense: 1,
      value: 0,
      playing: false,
      step: 0.01,
    });
    this.button = $("[data-play]", root);
    this.slider = $("input[type=range]", root);
    this.pace = $("[data-pace]", root);
    this.button.addEventListener("click", () => this.toggle());
    this.slider.addEventListener("input", () => {
      this.pause();
      this.set(this.low + (this.high - this.low) * Number(this.slider.value));
    });
  }

  // The ends of the travel, whether it goes around, and in which sense; `step` is one press of a key.
  travel({ low, high, wraps, sense = 1, step }) {
    Object.assign(this, { low, high, wraps, sense, step });
    this.set(this.value);
  }

  set(value) {
    const span = this.high - this.low;
    if (this.wraps && (value < this.low || value > this.high)) {
      value = this.low + ((((value - this.low) % span) + span) % span);
    }
    this.value = Math.min(Math.max(value, this.low), this.high);
    this.slider.value = span > 0 ? (this.value - this.low) / span : 0;
    this.onMove(this.value);
  }

  toggle() {
    if (this.playing) this.pause();
    else this.play();
  }

  play() {
    this.playing = true;
    this.shown();
    let before = performance.now();
    const frame = (now) => {
      if (!this.playing) return;
      const seconds = Math.min((now - before) / 1000, 0.1);
      before = now;
      const next = this.value + (this.sense * seconds * (this.high - this.low)) / this.seconds();
      if (!this.wraps && (next > this.high || next < this.low)) this.sense = -this.sense;
      this.set(next);
      requestAnimationFrame(frame);
    };
    requestAnimationFrame(frame);
  }

  // Seconds over the travel: the pace is stated for a whole turn where the travel is an angle.
  seconds() {
    const paced = Number(this.pace.value);
    return this.pace.dataset.pace === "turn" ? (paced * (this.high - this.low)) / TURN : paced;
  }

  pause() {
    this.playing = false;
    this.shown();
  }

  shown() {
    this.button.textContent = this.playing ? "Pause" : "Play";
    this.button.setAttribute("aria-pressed", String(this.playing));
  }

  // Arrows step, Home and End go to the ends; returns whether the key was one of them.
  key(event) {
    if (event.altKey || event.ctrlKey || event.metaKey) return false;
    const steps = { ArrowLeft: -1, ArrowDown: -1, ArrowRight: 1, ArrowUp: 1, PageDown: -10, PageUp: 10 };
    if (event.key in steps) this.set(this.value + steps[event.key] * (event.shiftKey ? 10 : 1) * this.step);
    else if (event.key === "Home") this.set(this.low);
    else if (event.key === "End") this.set(this.high);
    else return false;
    this.pause();
    return true;
  }
}

// A page with a drawing that a player, hands and keys move; without a player it stands still.
class MovingPage {
  stage; player;

  // layers: ids of the boxes that show more in the drawing, as it calls them.
  constructor(scene, { root = document, layers = [] } = {}) {
    if (!$("#player", root)) {
      this.stage = new Stage($("#stage", root), scene);
      return;
    }
    this.stage = new Stage($("#stage", root), scene, {
      onDrive: (theta2) => this.turnTo(theta2),
      onDraw: (state) => this.moved(state),
    });
    this.player = new Player($("#player", root), { onMove: (theta2) => this.stage.move(theta2) });
    for (const name of layers.filter((each) => $(`#${each}`))) {
      $(`#${name}`).addEventListener("change", (event) => {
        this.stage[name] = event.target.checked;
        this.stage.draw();
      });
    }
    this.stage.svg.addEventListener("keydown", (event) => {
      if (this.player.key(event)) event.preventDefault();
    });
    listenOnPage(() => this.current());
  }

  // The player that keys move where no drawing has the focus.
  current() {
    return this.player;
  }

  turnTo(theta2) {
    this.player.pause();
    this.player.set(theta2);
  }

  travel({ low, high, turns, direction }) {
    this.player.travel({ low, high, wraps: turns, sense: direction, step: 1 / DEG });
    tellTravel(this.stage, low, high);
  }

  moved(state) {
    tellPosition(this.stage, state);
  }
}

// Anywhere on the page the space bar plays and pauses, and the arrows to the left and right turn the
// driver, unless the element with the focus needs them.
function listenOnPage(player) {
  document.addEventListener("keydown", (event) => {
    if (event.defaultPrevented) return;
    const needs = (selector) => event.target.closest(selector);
    if (event.key === " ") {
      if (needs("button, input, select, summary, a, [role=button]")) return;
      player().toggle();
    } else if (event.key === "ArrowLeft" || event.key === "ArrowRight") {
      if (needs("input:not([type=checkbox]), select, .scroll, pre") || !player().key(event)) return;
    } else return;
    event.preventDefault();
  });
}
