"""A lesson as a folder with one page of HTML: opens in any browser, asks no network, needs no tools."""

from __future__ import annotations

from html import escape
from typing import TYPE_CHECKING, Any
from urllib.parse import quote

import numpy as np

from texlab_core.documents.lesson_parts import LessonError
from texlab_core.documents.lessons import PAPERS, title_of_method
from texlab_core.files.page import page_end, page_head
from texlab_core.files.whole import write_whole
from texlab_core.lessons.running import run_lesson

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from numpy.typing import NDArray

    from texlab_core.documents.lessons import Lesson, LessonStep
    from texlab_core.lessons.running import StepResult

_STYLE = """
:root { color-scheme: light dark; --line: #8884; }
body { font: 18px/1.5 system-ui, sans-serif; margin: 0 auto; max-width: 76rem; padding: 1.5rem; }
h1 { font-size: 1.7rem; margin: 0 0 .3rem; }
nav { position: sticky; top: 0; background: Canvas; padding: .5rem 0; border-bottom: 1px solid var(--line);
  display: flex; gap: .6rem; align-items: center; flex-wrap: wrap; z-index: 1; }
nav button, nav select { font: inherit; }
section { padding: 1rem 0 2rem; border-bottom: 1px solid var(--line); }
section h2 { font-size: clamp(1.5rem, 3.2vw, 2.6rem); line-height: 1.2; margin: .4rem 0 1rem; max-width: 60rem; }
.pictures { display: flex; flex-wrap: wrap; gap: 1rem; align-items: flex-start; }
figure { margin: 0; max-width: 100%; }
figure img { display: block; max-width: 100%; }
figure.texture img { width: 18rem; image-rendering: pixelated; }
figcaption { font-size: .85rem; color: GrayText; max-width: 18rem; }
.drawing figcaption { max-width: 48rem; }
.note, .try { max-width: 48rem; white-space: pre-line; }
.try::before { content: "Try: "; font-weight: 600; }
.meta { color: GrayText; font-size: .85rem; }
details { max-width: 48rem; margin: .8rem 0; white-space: pre-line; }
input[type=range] { width: 18rem; display: block; }
body.one section { display: none; }
body.one section.now { display: block; }
"""

_SCRIPT = """
"use strict";
const steps = Array.from(document.querySelectorAll("section")), body = document.body;
const jump = document.getElementById("jump"), count = document.getElementById("count");
let now = 0;
function show(place) {
  now = Math.min(Math.max(place, 0), steps.length - 1);
  steps.forEach((each, index) => each.classList.toggle("now", index === now));
  jump.value = now;
  count.textContent = (now + 1) + " of " + steps.length;
  window.scrollTo(0, 0);
}
document.getElementById("back").addEventListener("click", () => show(now - 1));
document.getElementById("next").addEventListener("click", () => show(now + 1));
jump.addEventListener("change", () => show(Number(jump.value)));
document.getElementById("all").addEventListener("change", event => {
  body.classList.toggle("one", !event.target.checked);
});
document.addEventListener("keydown", event => {
  if (event.target.type === "range") return;
  const way = {PageDown: 1, ArrowRight: 1, PageUp: -1, ArrowLeft: -1}[event.key];
  if (way && body.classList.contains("one")) { event.preventDefault(); show(now + way); }
});
document.querySelectorAll("input[type=range]").forEach(slider => {
  const figure = slider.closest("figure"), image = figure.querySelector("img");
  const files = JSON.parse(slider.dataset.files), values = JSON.parse(slider.dataset.values);
  const said = figure.querySelector("output");
  const turn = () => {
    image.src = files[slider.value];
    said.textContent = values[slider.value];
  };
  slider.addEventListener("input", turn);
  turn();
});
body.classList.add("one");
document.querySelector("nav").hidden = false;
show(0);
"""


def export(
    lesson: Lesson,
    folder: Path,
    *,
    reduced: bool = False,
    on_step: Callable[[int, int], None] | None = None,
    should_stop: Callable[[], bool] | None = None,
) -> Path:
    """Write a lesson as a page with its pictures beside it.

    Parameters
    ----------
    folder
        Made if it is not there; it must be empty, or hold a page written before.
    reduced
        At most 64 pixels a side.
    on_step
        Called with the number of the step and of all.
    should_stop
        Asked often.

    Returns
    -------
    Path
        Of ``index.html``.

    Raises
    ------
    LessonError
        When the folder holds something else, or a step cannot be run.
    """
    page = folder / "index.html"
    if folder.exists() and not folder.is_dir():
        raise LessonError(f"{folder}: is a file, and a folder is needed.")
    if folder.is_dir() and any(folder.iterdir()) and not page.is_file():
        raise LessonError(f"{folder}: is not empty and holds no page of a lesson; name another folder.")
    folder.mkdir(parents=True, exist_ok=True)
    parts = []
    for number, (step, made) in enumerate(
        zip(
            lesson.steps,
            run_lesson(lesson, reduced=reduced, on_step=on_step, should_stop=should_stop),
            strict=True,
        ),
        1,
    ):
        parts.append(_section(step, made, number, folder))
    write_whole(page, page_of(lesson, parts).encode())
    return page


def page_of(lesson: Lesson, sections: list[str]) -> str:
    """Return the page around its sections."""
    papers = ", ".join(PAPERS[each] for each in lesson.papers)
    about = " · ".join(each for each in (f"chapter {lesson.chapter}" if lesson.chapter else "", papers) if each)
    options = "".join(
        f'<option value="{place}">{place + 1}. {escape(step.sentence)}</option>'
        for place, step in enumerate(lesson.steps)
    )
    body = f"""<p class="meta">{escape(about)}</p>
<p>{escape(lesson.summary)}</p>
<nav hidden>
<button id="back" type="button">Back</button>
<button id="next" type="button">Next</button>
<span id="count" role="status"></span>
<select id="jump" aria-label="Go to a step">{options}</select>
<label><input id="all" type="checkbox"> all steps on one page</label>
</nav>
{"".join(sections)}"""
    return page_head(lesson.title, _STYLE) + body + page_end(_SCRIPT)


def _section(step: LessonStep, made: StepResult, number: int, folder: Path) -> str:
    name = f"step-{number:02d}"
    figures = []
    if made.exemplar is not None:
        marked = _with_marks(made.exemplar.pixels, step.marks)
        figures.append(_figure(_save(folder, f"{name}-exemplar.png", marked), "exemplar"))
    slider = step.series
    for place, (column, result) in enumerate(zip(step.columns, made.results, strict=True)):
        title = title_of_method(column)
        if slider is not None and slider.column == place:
            files = [
                _save(folder, f"{name}-{place}-{index}.png", each.image) for index, each in enumerate(made.series)
            ]
            values = [f"{slider.parameter.replace('_', ' ')} {value}" for value in slider.values]
            # It starts where the column stands.
            own = column.params().to_json().get(slider.parameter)
            start = slider.values.index(own) if own in slider.values else 0
            figures.append(_slider_figure(files, values, start, title))
        else:
            figures.append(_figure(_save(folder, f"{name}-{place}.png", result.image), title))
    if made.drawn is not None:
        file = _save(folder, f"{name}-drawing.png", made.drawn.sheet)
        figures.append(_figure(file, " · ".join(made.drawn.lines), kind="drawing"))
    words = [f'<p class="note">{escape(step.note)}</p>'] if step.note else []
    if step.question:
        answer = f"<p>{escape(step.answer)}</p>" if step.answer else ""
        words.append(f"<details><summary>{escape(step.question)}</summary>{answer}</details>")
    if step.try_this:
        words.append(f'<p class="try">{escape(step.try_this)}</p>')
    if step.figures:
        words.append(f'<p class="meta">{escape(", ".join(map(_figure_title, step.figures)))}</p>')
    pictures = f'<div class="pictures">{"".join(figures)}</div>' if figures else ""
    return f'<section id="{name}"><h2>{escape(step.sentence)}</h2>{pictures}{"".join(words)}</section>\n'


def _figure_title(figure: str) -> str:
    paper, _, number = figure.partition(" ")
    kind = "" if number.startswith("table") else "Fig. "
    return f"{PAPERS[paper]}, {kind}{number.replace('table', 'Table')}"


def _figure(file: str, caption: str, kind: str = "texture") -> str:
    return (
        f'<figure class="{kind}"><img src="{quote(file)}" alt="{escape(caption)}" loading="lazy">'
        f"<figcaption>{escape(caption)}</figcaption></figure>"
    )


def _slider_figure(files: list[str], values: list[str], start: int, title: str) -> str:
    import json

    shown = [quote(file) for file in files]
    return (
        f'<figure class="texture"><img src="{shown[start]}" alt="{escape(title)}"><input type="range" min="0"'
        f' max="{len(files) - 1}" value="{start}" aria-label="{escape(values[0].rpartition(" ")[0])}"'
        f' data-files="{escape(json.dumps(shown))}" data-values="{escape(json.dumps(values))}">'
        f"<figcaption>{escape(title)}: <output>{escape(values[start])}</output></figcaption></figure>"
    )


def _save(folder: Path, name: str, image: NDArray[Any]) -> str:
    from texlab_core.images.formats.writing import encode_png

    pixels = image if image.dtype == np.uint8 else np.rint(np.clip(image, 0, 1) * 255).astype(np.uint8)
    write_whole(folder / name, encode_png(pixels))
    return name


def _with_marks(pixels: NDArray[Any], marks: tuple[tuple[int, int, int, int], ...]) -> NDArray[Any]:
    """Outline rectangles in a picture, two pixels thick."""
    shown = np.repeat(pixels, 3, axis=2) if pixels.shape[2] == 1 else np.array(pixels)
    for top, left, height, width in marks:
        inside = np.zeros(shown.shape[:2], bool)
        inside[top : top + height, left : left + width] = True
        inside[top + 2 : top + height - 2, left + 2 : left + width - 2] = False
        shown[inside] = (0.84, 0.37, 0.0)
    return shown
