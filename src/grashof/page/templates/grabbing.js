// Dragging and zooming: the driver or another joint is dragged, the drawing is moved or enlarged.
const STRETCH = 40 / DEG; // a joint that is dragged takes the driver no farther at a time

// Driver angle near the one now at which a joint is nearest to a place.
function nearestAngle(design, theta2, name, [x, y]) {
  const away = (angle) => {
    const [px0, py0] = positionOf(design.linkage, within(design, angle))[name];
    return Math.hypot(px0 - x, py0 - y);
  };
  let [best, step] = [theta2, STRETCH / 32];
  for (let k = -32; k <= 32; k += 1) {
    const angle = theta2 + k * step;
    if (away(angle) < away(best)) best = angle;
  }
  for (; step > 1e-9; step /= 2) {
    for (const angle of [best - step, best + step]) if (away(angle) < away(best)) best = angle;
  }
  return best;
}

// The finest step that can be seen in a drawing.
const finestStep = (stage) => 10 ** -Math.ceil(Math.log10(stage.unit));

// Dragging the driver adds up turns, so that one held at its limit comes back where it left it.
function listenToJoints(stage) {
  let held = null;
  const angleAt = (event) => {
    const [x, y] = stage.back(stage.pointer(event));
    const { o2 } = stage.design.linkage;
    return Math.atan2(y - o2[1], x - o2[0]);
  };
  stage.svg.addEventListener("pointerdown", (event) => {
    const grip = event.target.closest(".hold");
    if (!stage.design || !grip || event.button) return;
    event.preventDefault();
    stage.svg.focus({ preventScroll: true });
    stage.svg.setPointerCapture(event.pointerId);
    held = { name: grip.dataset.joint, last: angleAt(event), wanted: stage.theta2 };
  });
  stage.svg.addEventListener("pointermove", (event) => {
    if (!held) return;
    if (held.name === "a") {
      const angle = angleAt(event);
      held.wanted += wrapped(angle - held.last);
      held.last = angle;
    } else {
      held.wanted = nearestAngle(stage.design, stage.theta2, held.name, stage.back(stage.pointer(event)));
    }
    stage.onDrive(held.wanted);
  });
  for (const end of ["pointerup", "pointercancel"]) stage.svg.addEventListener(end, () => (held = null));
}

// The wheel brings the drawing closer where it has the focus, or with Ctrl; dragging its ground moves it, two
// fingers do both, a double click shows all of it.
function listenToView(stage) {
  const { svg } = stage;
  const fingers = new Map();
  const free = (event) => !event.defaultPrevented && !event.target.closest(".hold, .handle");
  svg.addEventListener(
    "wheel",
    (event) => {
      if (!event.ctrlKey && document.activeElement !== svg) return;
      event.preventDefault();
      stage.zoom(ZOOM ** (-Math.sign(event.deltaY) * Math.min(Math.abs(event.deltaY) / 100, 1)), stage.pointer(event));
    },
    { passive: false },
  );
  svg.addEventListener("dblclick", (event) => {
    if (free(event)) stage.see(null);
  });
  svg.addEventListener("pointerdown", (event) => {
    if (!free(event) || event.button || !stage.at) return;
    fingers.set(event.pointerId, stage.pointer(event));
    if (event.pointerType === "mouse" || fingers.size > 1) svg.setPointerCapture(event.pointerId);
  });
  svg.addEventListener("pointermove", (event) => {
    const before = fingers.get(event.pointerId);
    if (!before) return;
    const now = stage.pointer(event);
    const other = [...fingers].find(([id]) => id !== event.pointerId);
    if (!other && event.pointerType !== "mouse") return; // one finger scrolls the page
    fingers.set(event.pointerId, now);
    stage.pan([(now[0] - before[0]) / fingers.size, (now[1] - before[1]) / fingers.size]);
    if (!other) return;
    const apart = (place) => Math.hypot(place[0] - other[1][0], place[1] - other[1][1]);
    if (apart(before) > 20) stage.zoom(apart(now) / apart(before), other[1]);
  });
  for (const end of ["pointerup", "pointercancel"]) svg.addEventListener(end, (event) => fingers.delete(event.pointerId));
  const buttons = svg.parentNode && svg.parentNode.querySelector(":scope > .view");
  if (!buttons) return;
  buttons.addEventListener("click", (event) => {
    const button = event.target.closest("[data-view]");
    if (!button) return;
    if (button.dataset.view === "all") stage.see(null);
    else stage.zoom(button.dataset.view === "in" ? ZOOM ** 2 : ZOOM ** -2);
  });
}
