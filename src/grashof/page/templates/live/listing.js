// The list of designs: rows that keep their colour while their designs are followed.
const SHOWN_COLUMNS = 4;

class Listing {
  rows; seen; root;

  constructor(root, { onPick, onCompare }) {
    Object.assign(this, { root, onPick, onCompare, rows: new Map(), compared: new Set(), seen: new Set() });
    this.head = $("thead tr", root);
    this.body = $("tbody", root);
    this.body.addEventListener("click", (event) => {
      const row = event.target.closest("tr");
      if (row && !event.target.closest("label")) onPick(Number(row.dataset.key));
    });
    this.body.addEventListener("change", (event) => {
      onCompare(Number(event.target.closest("tr").dataset.key), event.target.checked);
    });
    this.body.addEventListener("keydown", (event) => {
      const way = { ArrowDown: "nextElementSibling", ArrowUp: "previousElementSibling" }[event.key];
      const next = way && event.target.closest("tr")[way];
      if (!next) return;
      event.preventDefault();
      $("[data-pick]", next).focus();
      onPick(Number(next.dataset.key));
    });
  }

  // Designs in their order; `lost` states the misses of a followed design, `waiting` are not followed.
  show({ designs, columns, lost, phase, found }) {
    const following = phase === "track";
    const shown = columns.filter(({ key }) => designs.some(({ figures }) => figures[key] !== null)).slice(0, SHOWN_COLUMNS);
    this.heads(shown);
    const wanted = new Set(designs.map(({ key }) => key));
    const why = new Map(lost.map(({ key, why: reason }) => [key, reason]));
    designs.forEach((design, k) => {
      const row = this.rows.get(design.key) || this.made(design.key);
      this.update(row, design, k, shown, phase, found);
    });
    for (const [key, row] of [...this.rows]) {
      row.classList.toggle("lost", why.has(key));
      row.classList.toggle("waiting", following && !wanted.has(key) && !why.has(key));
      if (why.has(key)) this.tellLost(row, why.get(key));
      else if (!wanted.has(key) && !following) {
        row.remove();
        this.rows.delete(key);
      }
    }
    if (!following) this.body.append(...designs.map(({ key }) => this.rows.get(key)));
  }

  clear() {
    this.rows.clear();
    this.seen.clear();
    this.body.replaceChildren();
  }

  heads(columns) {
    const cells = columns.map(({ label, unit, about }) => {
      const cell = document.createElement("th");
      cell.scope = "col";
      cell.title = about || label;
      cell.append(label, document.createElement("br"), Object.assign(document.createElement("small"), { textContent: unit }));
      return cell;
    });
    const [first, picture] = this.head.children;
    this.head.replaceChildren(first, picture, ...cells, this.head.lastElementChild);
  }

  made(key) {
    const row = document.createElement("tr");
    row.dataset.key = key;
    row.append($("template", this.root).content.cloneNode(true));
    $(".swatch", row).classList.add(`pen-${1 + (key % 8)}`);
    this.rows.set(key, row);
    this.body.append(row);
    return row;
  }

  update(row, design, k, columns, phase, found) {
    const { key } = design;
    row.classList.remove("lost", "waiting");
    const fresh = !this.seen.has(key) && phase !== "track";
    this.seen.add(key);
    if (fresh) {
      row.classList.add("new");
      row.addEventListener("animationend", () => row.classList.remove("new"), { once: true });
    }
    $("[data-pick]", row).textContent = k + 1;
    $("[data-pick]", row).setAttribute("aria-label", `Show ${found ? "design" : "closest miss"} ${k + 1}`);
    $("input", row).setAttribute("aria-label", `Compare design ${k + 1}`);
    $(".thumb", row).replaceWith(thumbnail(design));
    for (const old of $$("[data-value]", row)) old.remove();
    const cells = columns.map((column) => {
      const cell = document.createElement("td");
      cell.dataset.value = column.key;
      cell.textContent = listed(design.figures[column.key], column.decimals);
      return cell;
    });
    row.lastElementChild.before(...cells);
  }

  tellLost(row, why) {
    const cells = $$("[data-value]", row);
    if (!cells.length) return;
    const cell = document.createElement("td");
    Object.assign(cell, { colSpan: cells.length, className: "text why", textContent: why, title: why });
    cell.dataset.value = "lost";
    cells[0].before(cell);
    for (const old of cells) old.remove();
  }

  mark(key) {
    for (const [each, row] of this.rows) {
      row.classList.toggle("chosen", each === key);
      $("[data-pick]", row).setAttribute("aria-pressed", String(each === key));
    }
  }

  markCompared(keys) {
    for (const [key, row] of this.rows) $("input", row).checked = keys.includes(key);
  }
}

// A number as the list shows it: as in Python's `Column.text`.
function listed(value, decimals) {
  if (value === null || value === undefined) return "–";
  if (typeof value !== "number") return String(value);
  return decimals < 0 ? minus(value.toExponential(3)) : fixed(value, decimals);
}
