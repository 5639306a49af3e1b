"""The report of a batch: a table for spreadsheets, and a page to look through; neither needs a network."""

from __future__ import annotations

import csv
import io
import json
from typing import TYPE_CHECKING, Any

from texlab_core.batch.page import page_of
from texlab_core.files.wording import harmless

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence
    from pathlib import Path

    from texlab_core.batch.folder import BatchFolder
    from texlab_core.batch.plan import Plan
    from texlab_core.batch.rows import Rows

TABLE, PAGE = "report.csv", "index.html"
_COLUMNS = (
    "input",
    "part",
    "variant",
    "method",
    "parameters",
    "width",
    "height",
    "depth",
    "seed",
    "picture",
    "job",
)


def table_of(rows: Rows) -> Iterator[str]:
    """Yield the lines of the CSV table."""
    names = rows.measures
    yield _line([*_COLUMNS, *names, "findings", "error"])
    for row in rows:
        about = row.about
        size = about.get("size") or {"width": "", "height": ""}
        cells: list[Any] = [about["input"], about["part"], about["variant"], about["method"]]
        cells += [json.dumps(about["parameters"], sort_keys=True), size["width"], size["height"]]
        cells += [size.get("depth", ""), about["seed"]]
        cells += [row.picture, row.job]
        cells += ["" if (value := (row.measures or {}).get(name)) is None else repr(value) for name in names]
        cells += [" ".join(row.findings), row.error]
        yield _line([harmless(cell) for cell in cells])


def _line(cells: Sequence[Any]) -> str:
    out = io.StringIO()
    csv.writer(out).writerow(cells)
    return out.getvalue()


def write_report(folder: BatchFolder, plan: Plan, rows: Rows, total: int) -> tuple[Path, Path]:
    """Write page and table, line by line; return their paths.

    Parameters
    ----------
    folder
        Of the batch.
    plan
        For its name, note and methods.
    rows
        The jobs that are over.
    total
        How many there will be.
    """
    table = folder.write(TABLE, table_of(rows))
    page = folder.write(PAGE, page_of(plan.name, plan.note, [each.name for each in plan.variants], rows, total))
    return page, table
