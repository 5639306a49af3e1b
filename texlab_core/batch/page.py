"""A page with every result of a batch: one file of HTML with its style and script inside, pictures beside it."""

from __future__ import annotations

from html import escape
from typing import TYPE_CHECKING
from urllib.parse import quote

from texlab_core.files.page import page_end, page_head
from texlab_core.findings.finding import HINT
from texlab_core.measures.registry import measures as known_measures

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from texlab_core.batch.rows import Row, Rows

_STYLE = """
:root { color-scheme: light dark; --line: #8884; --dim: #8888; --bad: #c33; }
body { font: 15px/1.45 system-ui, sans-serif; margin: 1.5rem; }
h1 { font-size: 1.4rem; margin: 0 0 .3rem; }
p { margin: .2rem 0 .8rem; max-width: 60rem; white-space: pre-line; }
form { position: sticky; top: 0; background: Canvas; padding: .5rem 0; display: flex; gap: .8rem; flex-wrap: wrap;
  align-items: center; border-bottom: 1px solid var(--line); z-index: 1; }
input[type=search] { min-width: 16rem; }
table { border-collapse: collapse; margin-top: .6rem; }
th, td { text-align: left; vertical-align: top; padding: .35rem .7rem .35rem 0;
  border-bottom: 1px solid var(--line); }
td.number, th.number { text-align: right; font-variant-numeric: tabular-nums; }
th button { font: inherit; font-weight: 600; background: none; border: 0; padding: 0; cursor: pointer;
  color: inherit; }
th[aria-sort=ascending] button::after { content: " \\2191"; }
th[aria-sort=descending] button::after { content: " \\2193"; }
img { display: block; max-width: 128px; image-rendering: pixelated; }
small { color: GrayText; display: block; }
.error { color: var(--bad); max-width: 30rem; }
ul { margin: 0; padding-left: 1.1rem; min-width: 16rem; max-width: 30rem; }
[hidden] { display: none; }
"""

_SCRIPT = """
"use strict";
const form = document.querySelector("form"), body = document.querySelector("tbody");
const rows = Array.from(body.rows), shown = document.getElementById("shown");
function filter() {
  const words = form.words.value.toLowerCase().split(/\\s+/).filter(Boolean);
  let count = 0;
  for (const row of rows) {
    const text = row.dataset.text;
    const fits = words.every(word => text.includes(word))
      && (!form.variant.value || row.dataset.variant === form.variant.value)
      && (!form.state.value || row.dataset.state.split(" ").includes(form.state.value));
    row.hidden = !fits;
    count += fits;
  }
  shown.textContent = count === rows.length ? "" : count + " shown";
}
function sort(header, column) {
  const down = header.getAttribute("aria-sort") === "ascending";
  for (const each of header.parentNode.cells) each.removeAttribute("aria-sort");
  header.setAttribute("aria-sort", down ? "descending" : "ascending");
  const numeric = header.classList.contains("number");
  const value = row => row.cells[column].dataset.value ?? row.cells[column].textContent;
  const order = new Map(rows.map((row, place) => [row, place]));
  const sorted = rows.slice().sort((a, b) => {
    const x = value(a), y = value(b);
    if ((x === "") !== (y === "")) return x === "" ? 1 : -1;
    const way = numeric ? x - y : x.localeCompare(y, undefined, {numeric: true});
    return (down ? -way : way) || order.get(a) - order.get(b);
  });
  body.append(...sorted);
}
form.addEventListener("input", filter);
form.addEventListener("submit", event => event.preventDefault());
document.querySelectorAll("th").forEach((header, column) => {
  const button = header.querySelector("button");
  if (button) button.addEventListener("click", () => sort(header, column));
});
form.hidden = false;
filter();
"""


_BESIDE = """The numbers are in <a href="report.csv">report.csv</a> too. Each picture carries its
recipe: <code>texlab redo PICTURE --out AGAIN.png</code> makes it again."""


def page_of(
    name: str,
    note: str,
    variants: Sequence[str],
    rows: Rows,
    total: int,
    *,
    address: Callable[[str], str] = quote,
    beside: str = _BESIDE,
    links: bool = True,
) -> Iterator[str]:
    """Yield the page in pieces.

    Parameters
    ----------
    name, note
        Of the plan.
    variants
        The names of its methods.
    rows
        The jobs that are over.
    total
        How many jobs there will be.
    address
        Returns what a browser finds a small picture by, from its path in the batch's folder.
    beside
        What is said of the files beside the page, HTML.
    links
        Whether a small picture leads to the file of the whole one.
    """
    failed, measures = rows.failed, rows.measures
    counts = [f"{len(rows) - failed} of {total} textures"] + ([f"{failed} failed"] if failed else [])
    options = "".join(f"<option>{escape(each)}</option>" for each in variants)
    headers = ["<th>Exemplar</th>", "<th>Result</th>"]
    headers += [f"<th><button>{each}</button></th>" for each in ("Input", "Method", "Size")]
    headers.append('<th class="number"><button>Seed</button></th>')
    headers += [_heading(name) for name in measures]
    headers.append("<th><button>Findings</button></th>")
    yield page_head(name, _STYLE)
    yield f"""<p>{escape(note)}</p>
<p>{", ".join(counts)}. {beside}</p>
<form hidden>
<label>Search <input type="search" name="words" autocomplete="off"></label>
<label>Method <select name="variant"><option value="">all</option>{options}</select></label>
<label>State <select name="state"><option value="">all</option><option value="made">made</option>\
<option value="found">with findings</option><option value="hinted">to look at</option>\
<option value="failed">failed</option></select></label>
<span id="shown" role="status"></span>
</form>
<table>
<thead><tr>{"".join(headers)}</tr></thead>
<tbody>
"""
    for row in rows:
        yield _row(row, measures, address, links)
    yield """</tbody>
</table>
"""
    yield page_end(_SCRIPT)


def _heading(name: str) -> str:
    measure = known_measures().get(name)
    if measure is None:
        return f'<th class="number"><button>{escape(name)}</button></th>'
    better = "" if measure.better == "neither" else f" The {measure.better}, the better."
    said = escape(f"{measure.summary}{better}")
    return f'<th class="number" title="{said}"><button>{escape(measure.title)}</button></th>'


def _written(name: str, value: float) -> str:
    measure = known_measures().get(name)
    return f"{value:.4g}" if measure is None else measure.text(value)


def _row(row: Row, measures: Sequence[str], address: Callable[[str], str], links: bool) -> str:
    about = row.about
    state = "failed" if row.error else " ".join(["made", *_kinds(row.findings)])
    words = " ".join([row.title, row.error, *row.findings]).lower()
    part = f"<small>{escape(about['part'])}</small>" if about["part"] else ""
    cells = [
        f"<td>{_image(row.exemplar, address)}</td>",
        f"<td>{_image(row.thumbnail, address, row.picture if links else '', row.title)}</td>",
        f'<td data-value="{escape(about["input"])}">{escape(about["input"])}{part}</td>',
        f"<td>{escape(about['variant'])}</td>",
        f"<td>{escape(row.size)}</td>",
        f'<td class="number">{about["seed"]}</td>',
    ]
    for name in measures:
        value = (row.measures or {}).get(name)
        shown = "" if value is None else escape(_written(name, value))
        cells.append(f'<td class="number" data-value="{"" if value is None else repr(value)}">{shown}</td>')
    if row.error:
        cells.append(f'<td class="error">{escape(row.error)}</td>')
    else:
        items = "".join(f"<li>{escape(each)}</li>" for each in row.findings)
        cells.append(f"<td>{f'<ul>{items}</ul>' if items else ''}</td>")
    data = f'data-state="{state}" data-variant="{escape(about["variant"])}" data-text="{escape(words)}"'
    return f"<tr {data}>{''.join(cells)}</tr>\n"


def _kinds(findings: Sequence[str]) -> list[str]:
    """Return whether there are findings, and whether there are hints: they are counted apart."""
    hints = sum(each.startswith(HINT) for each in findings)
    return ["found"] * (len(findings) > hints) + ["hinted"] * (hints > 0)


def _image(path: str, address: Callable[[str], str], link: str = "", title: str = "exemplar") -> str:
    if not path:
        return ""
    image = f'<img src="{address(path)}" alt="{escape(title)}" loading="lazy">'
    return f'<a href="{quote(link)}">{image}</a>' if link else image
