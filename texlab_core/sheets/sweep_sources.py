"""Where sweeps come from: the ready-made ones, files of the user's, and what a contact sheet carries."""

from __future__ import annotations

from pathlib import Path
from typing import BinaryIO

from texlab_core.errors import RecipeError
from texlab_core.files import strict_json
from texlab_core.files.regular import open_regular, reason
from texlab_core.files.resources import resource
from texlab_core.files.wording import did_you_mean
from texlab_core.images.formats.png_text import SIGNATURE, read_text
from texlab_core.sheets.figure import FIGURE_SUFFIXES
from texlab_core.sheets.sweep_recipes import TEXT_KEY, SweepRecipe, sweep_recipe_from_json

# A figure carries its recipe in front.
_FIGURE_HEAD = 4 * strict_json.MAX_BYTES


def bundled_sweeps(method: str | None = None) -> tuple[SweepRecipe, ...]:
    """Return the sweeps that come with the program (of one method), by name."""
    found = []
    for file in resource("sweeps").iterdir():
        if file.name.endswith(".json"):
            what = f"the bundled sweep {file.name}"
            data = strict_json.loads(file.read_bytes(), what=what, error=RecipeError)
            found.append(sweep_recipe_from_json(data, what=what))
    return tuple(sorted((each for each in found if method in (None, each.method)), key=lambda each: each.name))


def find_sweep(source: str) -> SweepRecipe:
    """Return what ``FILE|NAME`` means: a JSON file, the contact sheet of an earlier sweep, or a bundled one.

    Raises
    ------
    RecipeError
        When there is none, or it cannot be used.
    """
    path = Path(source)
    if path.suffix.lower() == ".json":
        what = f"the sweep {path.name}"
        return sweep_recipe_from_json(strict_json.load(path, what=what, error=RecipeError), what=what)
    if path.suffix.lower() in (".png", *FIGURE_SUFFIXES):
        return _from_sheet(path)
    known = {each.name: each for each in bundled_sweeps()}
    if source in known:
        return known[source]
    hint = did_you_mean(source, known) or f"there are {', '.join(known)}"
    raise RecipeError(f"There is no sweep called {strict_json.shorten(source)} ({hint}).")


def _from_sheet(path: Path) -> SweepRecipe:
    try:
        with open_regular(path) as file:
            text = _carried(file)
    except OSError as bad:
        raise RecipeError(f"{path}: cannot be opened ({reason(bad)}).") from bad
    except ValueError as bad:
        raise RecipeError(f"The sheet {path.name} cannot be used ({bad}).") from bad
    if text is None:
        raise RecipeError(f"{path.name} is no contact sheet of a sweep: it carries no recipe.")
    what = f"the sheet {path.name}"
    return sweep_recipe_from_json(strict_json.loads(text, what=what, error=RecipeError), what=what)


def _carried(file: BinaryIO) -> str | bytes | None:
    """Return the recipe in a sheet; it stands at the beginning of a figure."""
    head = file.read(_FIGURE_HEAD)
    if head.startswith(SIGNATURE):
        file.seek(len(SIGNATURE))
        return read_text(file, TEXT_KEY, strict_json.MAX_BYTES)
    from texlab_core.sheets.figure_pdf import attached_text
    from texlab_core.sheets.figure_svg import carried_text

    return attached_text(head) if head.startswith(b"%PDF-") else carried_text(head)
