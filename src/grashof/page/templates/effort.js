// The effort of a hand by virtual work, with struts and springs wherever their ends are, at the samples of Python.

// Places of an end and its velocity in the motion, as [x, y, vx, vy] at every sample.
function movesOf({ link, at: [u, v] }, { frames, angle }) {
  const frame = frames[link];
  if (!frame) return angle.map(() => [u, v, 0, 0]);
  return frame.angle.map((turned, k) => {
    const [cos, sin] = [Math.cos(turned), Math.sin(turned)];
    const [dx, dy] = [u * cos - v * sin, u * sin + v * cos];
    const { [k]: turn } = frame.turn;
    return [frame.x[k] + dx, frame.y[k] + dy, frame.vx[k] - turn * dy, frame.vy[k] + turn * dx];
  });
}

// Lengths of a strut, and their rates in the motion.
function strutMotion({ ends }, effort) {
  const [from, to] = ends.map((end) => movesOf(end, effort));
  const ways = from.map((start, k) => to[k].map((value, axis) => value - start[axis]));
  const lengths = ways.map(([x, y]) => Math.hypot(x, y));
  return { lengths, rates: ways.map(([x, y, vx, vy], k) => (lengths[k] > 0 ? (x * vx + y * vy) / lengths[k] : 0)) };
}

// At 20 deg C, linear between the two lengths that a size states.
function forceOf({ extended, compressed, forceExtended, forceCompressed }, length) {
  return forceExtended + (forceCompressed - forceExtended) * ((extended - length) / (extended - compressed));
}

// Lengths of all struts, the effort at each temperature and the friction; null where the hand is at rest.
function effortOf(effort, struts) {
  const { parts, others, per, friction, temperatures } = effort;
  const moved = struts.map((strut) => strutMotion(strut, effort));
  const known = (value, k) => (others[k] === null || per[k] === null ? null : value());
  const sum = (of, k) => moved.reduce((total, { lengths, rates }, n) => total + of(parts[n], lengths[k], rates[k]), 0);
  const power = (t) => (part, length, rate) => part.warmth[t] * part.push * forceOf(part, length) * rate;
  const rubbed = (part, _length, rate) => part.friction * Math.abs(rate);
  return {
    lengths: moved.map(({ lengths }) => lengths),
    efforts: temperatures.map((_, t) => others.map((rest, k) => known(() => rest - per[k] * sum(power(t), k), k))),
    friction: friction.map((rest, k) => known(() => rest + Math.abs(per[k]) * sum(rubbed, k), k)),
  };
}

// Whether a demand holds at an angle, and a side of it there.
const isWithin = ({ start, end }, angle) => angle >= start && (end === null || angle <= end);
function sideAt([first, last], { start, end }, angle) {
  const share = end === null ? 0 : Math.min(Math.max((angle - start) / (end - start), 0), 1);
  return first + (last - first) * share;
}

// The limits of the effort as lines { label, values }; friction narrows or widens some.
function limitsOf({ demands, angle, sense }, friction) {
  const lines = new Map();
  for (const demand of demands) {
    [demand.least, demand.most].forEach((side, which) => {
      if (side.includes(null)) return;
      const label = demand.labels[which];
      const shift = demand.friction * (which ? -1 : 1);
      const before = lines.get(label) || angle.map(() => null);
      const at = (k) => (demand.opening ? sense[k] : 1) * (sideAt(side, demand, angle[k]) + shift * friction[k]);
      lines.set(label, before.map((old, k) => (isWithin(demand, angle[k]) && friction[k] !== null ? at(k) : old)));
    });
  }
  return [...lines].map(([label, values]) => ({ label, values }));
}

// The greatest excess of the effort over its limits at the samples, N; a negative one is a margin.
function excessOf({ demands, angle, sense }, { efforts, friction }) {
  let worst = -Infinity;
  for (const demand of demands) {
    const [low, high] = [demand.least, demand.most].map((side) => (side.includes(null) ? null : side));
    for (const values of efforts) {
      values.forEach((value, k) => {
        if (value === null || !isWithin(demand, angle[k])) return;
        const [effort, loss] = [demand.opening ? sense[k] * value : value, demand.friction * friction[k]];
        if (high) worst = Math.max(worst, effort - sideAt(high, demand, angle[k]) + loss);
        if (low) worst = Math.max(worst, sideAt(low, demand, angle[k]) - effort + loss);
      });
    }
  }
  return worst;
}

// Both plots, with the lines that an analysis has, in its order.
function effortPlots(effort, struts, unit) {
  const found = effortOf(effort, struts);
  const { angle, theta2, over, temperatures, bare, without } = effort;
  const lines = temperatures.map((label, t) => ({ label, values: found.efforts[t] }));
  const panel = { places: angle, angles: theta2, over };
  return {
    ...found,
    excess: excessOf(effort, found),
    curves: {
      effort: { ...panel, title: "Effort", unit: "N", series: [...lines, { label: bare, values: without }, ...limitsOf(effort, found.friction)] },
      "effort-lengths": { ...panel, title: "Lengths of struts and springs", unit, series: struts.map(({ label }, k) => ({ label, values: found.lengths[k] })) },
    },
  };
}
