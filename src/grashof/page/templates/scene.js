// The drawing of a problem and of a linkage: places and their texts.
// Corners of the body that stands at a place in a direction.
function bodyAt(body, [x, y], angle) {
  const [cos, sin] = [Math.cos(angle), Math.sin(angle)];
  return body.map(([u, v]) => [x + u * cos - v * sin, y + u * sin + v * cos]);
}

// Poses as a design has them where they leave parts free: { at, angle, whole }, or null.
function posesOf(scene, design) {
  return (scene.poses || []).map(([x, y, angle], k) => {
    const whole = x !== null && angle !== null;
    if (whole) return { at: [x, y], angle, whole };
    if (!design) return x === null ? null : { at: [x, y], angle: null, whole };
    const state = positionOf(design.linkage, design.theta2[k], design.assemblies[k]);
    return {
      at: x === null ? state.p : [x, y],
      angle: angle === null ? state.guided : angle,
      whole,
    };
  });
}

// Everything that has to be seen of a scene with some designs; `close`: the targets without the linkage.
function pointsToSee(scene, designs, close) {
  const points = [...(scene.outlines || []).flat(), ...(scene.points || [])];
  if (!close) points.push(...(scene.regions || []).flatMap(({ corners }) => corners || [])); // boxes may be huge
  for (const design of designs.length ? designs : [null]) {
    for (const pose of posesOf(scene, design)) {
      if (!pose) continue;
      points.push(pose.at);
      if (scene.body && pose.angle !== null) points.push(...bodyAt(scene.body, pose.at, pose.angle));
    }
    if (!design || close) continue;
    for (const angle of travelPath(design).angles) {
      const state = positionOf(design.linkage, angle);
      points.push(...drawnPoints(design, state));
      if (design.cylinder) points.push(design.cylinder.base);
      for (const strut of design.struts || []) points.push(...strutAt(design.linkage, strut, state));
    }
  }
  return points;
}

// All that a linkage covers in a state, but for the width of blocks.
function drawnPoints(design, state) {
  const { parts } = kindOf(design.linkage);
  const corners = parts.flatMap((part) => part.corners(slideOf(design), state, 0));
  return [...pointsOf(design.linkage).map((name) => state[name]), ...corners];
}

// Where the block of a slide on the ground is at the ends of its travel; null where there is none.
function guideOf(design) {
  const { linkage, from, to } = slideOf(design);
  const slider = kindOf(linkage).dyads.find(({ kind }) => kind === "RRP");
  if (!slider) return null;
  const { angle, offset } = slider.sizes;
  const frame = { at: linkage.o2, along: [Math.cos(angle), Math.sin(angle)] };
  return [from, to].map((at) => carried(frame, [at, offset]));
}

// The parts of a design's travel, in deg, that it does its task in: two where it passes the end of a whole turn.
function partsOfTask({ task, low, high, turns }) {
  const [from, to] = task.map((angle) => angle * DEG).sort((a, b) => a - b);
  const ways = turns ? [from, from - 360].map((start) => [start, start + to - from]) : [[from, to]];
  return ways.map((part) => [Math.max(part[0], low * DEG), Math.min(part[1], high * DEG)]).filter(([a, b]) => a < b);
}

// An angle of a driver that turns fully, moved by whole turns into a part of its travel or to its nearer end.
function countedIn({ low, high }, theta2) {
  const angle = low + ((((theta2 - low) % TURN) + TURN) % TURN);
  return angle - high > low + TURN - angle ? angle - TURN : angle;
}

// The angles and the place of P as text, beside the drawing and for screen readers.
function tellPosition(stage, state) {
  const { theta2, p, slide } = state;
  const links = Object.keys(kindOf(stage.design.linkage).links).slice(1);
  const angles = links.map((number) => `θ${number} ${fixed(state[`theta${number}`] * DEG, 2)}`);
  const place = p.map((value) => fixed(value, stage.decimals)).join(", ");
  const slid = slide === undefined ? "" : `, ${withUnit(`slide ${fixed(slide, stage.decimals)}`, stage.scene.unit)}`;
  $("#angles").textContent = `${angles.join(", ")} deg${slid}`;
  $("#place").textContent = withUnit(`P ${place}`, stage.scene.unit);
  const degrees = (theta2 * DEG).toFixed(1);
  set(stage.svg, { "aria-valuenow": degrees, "aria-valuetext": `${degrees} degrees` });
}

function tellTravel(stage, low, high) {
  set(stage.svg, { "aria-valuemin": (low * DEG).toFixed(1), "aria-valuemax": (high * DEG).toFixed(1) });
}
