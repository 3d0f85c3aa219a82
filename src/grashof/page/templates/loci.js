// Where the joints of a design can be: pieces of two curves, the darker, the better the best design there.
const SHADES = 5;

// Half of the best transmission angle and less is the lightest shade.
function shadeOf(share) {
  return Math.min(SHADES - 1, Math.max(0, Math.floor((share - 0.5) * 2 * SHADES)));
}

// Moving pivots at the first target thin, ground pivots thick; pieces of one shade are one path.
function drawLoci(stage, loci) {
  for (const name of ["ground", "moving"]) {
    const paths = Array.from({ length: SHADES }, () => []);
    loci[name].forEach(([x1, y1, x2, y2], k) => {
      const [from, to] = [stage.at([x1, y1]), stage.at([x2, y2])];
      paths[shadeOf(loci.share[k])].push(`M${from.map(px).join(" ")}L${to.map(px).join(" ")}`);
    });
    paths.forEach((pieces, shade) => {
      if (pieces.length) add(stage.svg, "path", { class: `locus ${name} shade-${shade}`, d: pieces.join("") });
    });
  }
}
