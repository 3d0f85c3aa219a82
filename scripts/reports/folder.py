"""The folder of counterparts: a picture or table for each item, and a page of them all."""

import base64
import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from jinja2 import Environment, FileSystemLoader, StrictUndefined
from matplotlib.figure import Figure

from grashof.figures import save, save_animation
from reports.luggage import Luggage
from reports.material import Made
from reports.pumpjack import Pumpjack

HERE = Path(__file__).parent
REPORTS = {"pumpjack": "The pumpjack", "luggage": "Unloading luggage"}
_ROUNDING = 1e-14  # of values about 1: less is shown as 0
_ROWS = 30  # of a table on the page; the CSV has them all
COLUMNS = ("quantity", "as published", "right", "cause")
Row = tuple[str, str, str, str]
Sources = Mapping[str, Pumpjack | Luggage]  # by report


@dataclass(frozen=True, slots=True)
class Item:
    """A figure, table or statement of a report, and its counterpart, made by the method `make` with `args`.

    `reported` is the content of the report, `right` states the right figures, by their names in braces, and
    `wrong` the error.
    """

    report: str
    figure: str
    id: str
    title: str
    make: str
    reported: str
    right: str
    wrong: str
    args: Sequence[Any] = ()

    @property
    def stem(self) -> str:
        """Common beginning of the names of its files."""
        return f"{self.report}-{self.id}"


def items() -> list[Item]:
    """All items, in the order of the reports."""
    text = (HERE / "items.toml").read_text(encoding="utf-8")
    return [Item(**given) for given in tomllib.loads(text)["item"]]


def write_folder(folder: Path, sources: Sources, rows: Mapping[str, Sequence[Row]]) -> list[Path]:
    """Write the counterparts of all items, and index.html; the files, the page last.

    Files of the same names are replaced. `rows` is the table of published and right values, by report.
    """
    folder.mkdir(parents=True, exist_ok=True)
    entries_of: dict[str, list[dict[str, Any]]] = {name: [] for name in REPORTS}
    written: list[Path] = []
    for item in items():
        source = sources[item.report]
        if item.make == "printed":
            made = Made(tables={"": pd.DataFrame(rows[item.report], columns=COLUMNS)})
        else:
            made = getattr(source, item.make)(*item.args)
        pictures, tables = _write(folder, item.stem, made)
        written += [*pictures, *(path for path, _ in tables)]
        entries_of[item.report].append(
            {
                "item": item,
                "right": item.right.format(**source.numbers),
                "wrong": item.wrong.format(**source.numbers),
                "pictures": [_inline(path) for path in pictures],
                "tables": [{"file": path.name, **_short(table)} for path, table in tables],
            }
        )
    pages = Environment(loader=FileSystemLoader(HERE), autoescape=True, undefined=StrictUndefined)
    page = pages.get_template("page.html").render(reports=REPORTS, entries_of=entries_of)
    (folder / "index.html").write_text(page, encoding="utf-8")
    return [*written, folder / "index.html"]


def _write(folder: Path, stem: str, made: Made) -> tuple[list[Path], list[tuple[Path, pd.DataFrame]]]:
    pictures, tables = [], []
    for end, figure in made.figures.items():
        name = f"{stem}-{end}" if end else stem
        path = folder / f"{name}.{'png' if isinstance(figure, Figure) else 'gif'}"
        if isinstance(figure, Figure):
            save(figure, [path])
        else:
            save_animation(figure, path)
        pictures.append(path)
    for end, table in made.tables.items():
        path = folder / f"{f'{stem}-{end}' if end else stem}.csv"
        table.to_csv(path, index=False, lineterminator="\n")
        tables.append((path, table))
    return pictures, tables


def _inline(path: Path) -> dict[str, str]:
    kind = path.suffix.removeprefix(".")
    content = base64.b64encode(path.read_bytes()).decode()
    return {"file": path.name, "source": f"data:image/{kind};base64,{content}"}


def _short(table: pd.DataFrame) -> dict[str, Any]:
    """Headings and cells of a short table; of a long one only its length."""
    if len(table) > _ROWS:
        return {"columns": [], "rows": [], "count": len(table)}
    cells = [[_cell(value) for value in row] for row in table.itertuples(index=False)]
    return {"columns": list(map(str, table.columns)), "rows": cells, "count": len(table)}


def _cell(value: Any) -> str:
    if isinstance(value, float):
        return "" if np.isnan(value) else f"{value:.7g}" if abs(value) > _ROUNDING else "0"
    return {True: "yes", False: "no"}[value] if isinstance(value, bool) else str(value)
