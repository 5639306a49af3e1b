"""Export: results of any selection of jobs, seeds and sizes, written as one set or not at all."""

from __future__ import annotations

import dataclasses
import hashlib
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal, get_args

from texlab_core.documents.beside import check_beside, sidecar, sidecar_bytes
from texlab_core.documents.recipe import written_recipe
from texlab_core.documents.record import (
    carried_alpha,
    check_result_format,
    encode_result,
    holds_recipe,
    result_bits,
)
from texlab_core.engine.cache import AnalysisCache
from texlab_core.engine.registry import find_method
from texlab_core.engine.run import run
from texlab_core.engine.sizes import size_text
from texlab_core.errors import InputError, ParamError
from texlab_core.files.whole import check_target, write_together
from texlab_core.images.formats.volumes import VOLUME_SUFFIXES
from texlab_core.images.formats.writing import can_hold_alpha, check_quality
from texlab_core.sheets.contact_sheet import Tile
from texlab_core.sheets.export_names import MOST_FILES, PATTERN, Named, check_pattern, file_stems
from texlab_core.sheets.sweep import show

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping, Sequence
    from pathlib import Path

    from texlab_core.engine.job import Job
    from texlab_core.engine.result import Result
    from texlab_core.engine.steps import Step
    from texlab_core.images.formats.writing import Bits

RecipeAt = Literal["inside", "beside", "none"]
RECIPES: tuple[RecipeAt, ...] = get_args(RecipeAt)
# All files of a set are held until the last one is there.
_MOST_BYTES = 2 * 2**30


@dataclass(frozen=True, eq=False)
class Item:
    """One file to write.

    Parameters
    ----------
    job
        What makes it.
    title
        For names and captions; the method's when empty.
    result
        What the job gave, when that is known already.
    measures
        Numbers about that result by id, when they are known already; its recipe keeps them.
    """

    job: Job
    title: str = ""
    result: Result | None = None
    measures: Mapping[str, float] | None = None

    @property
    def named(self) -> Named:
        """What its name can be made of."""
        return Named(self.job, self.title or find_method(self.job.method).title)


@dataclass(frozen=True)
class Export:
    """How a set is written; every value is checked.

    Parameters
    ----------
    folder
        Where the files go.
    pattern
        Of their names; fields are :data:`texlab_core.sheets.export_names.FIELDS`.
    suffix
        ".png", say: their format.
    bits
        8, 16 or "float"; None for the exemplar's own.
    quality
        1 to 100, for formats that can lose something.
    recipe
        Inside each file where the format holds it (else beside), always beside, or nowhere.

    Raises
    ------
    InputError
        When a value is out of range, or they do not go together.
    """

    folder: Path
    pattern: str = PATTERN
    suffix: str = ".png"
    bits: Bits | None = None
    quality: int | None = None
    recipe: RecipeAt = "inside"

    def __post_init__(self) -> None:
        check_pattern(self.pattern)
        if self.recipe not in RECIPES:
            raise ParamError("recipe", f"one of {', '.join(RECIPES)}", self.recipe)
        if not self.suffix.startswith("."):
            raise ParamError("format", "the ending of a format as in .png", self.suffix)
        object.__setattr__(self, "suffix", self.suffix.lower())
        if self.suffix != ".npy":
            check_result_format(f"image{self.suffix}", self.bits)
        check_quality(f"image{self.suffix}", self.quality)


def selection(
    base: Iterable[Item], seeds: Sequence[int] = (), sizes: Sequence[tuple[int, ...]] = ()
) -> tuple[Item, ...]:
    """Return every item with every seed and size, all checked.

    Parameters
    ----------
    base
        Jobs to vary; a result is kept where the job stays the same.
    seeds, sizes
        None of them keeps each job's own.

    Raises
    ------
    InputError
        When a job cannot work, or there would be more than 1000.
    """
    found: list[Item] = []
    for item in base:
        for size in sizes or (item.job.size,):
            for seed in seeds or (item.job.seed,):
                if len(found) == MOST_FILES:
                    raise InputError(f"An export has at most {MOST_FILES} files; ask for fewer seeds or sizes.")
                same = size == item.job.size and seed == item.job.seed
                job = item.job if same else dataclasses.replace(item.job, size=size, seed=seed)
                found.append(dataclasses.replace(item, job=job) if same else Item(job, item.title))
    return tuple(found)


def planned(export: Export, items: Sequence[Item]) -> tuple[Path, ...]:
    """Return the paths of the files, in the order of the items; nothing is computed or written.

    Raises
    ------
    InputError
        When two would have one name, one cannot be written, or holds no result of so many dimensions.
    """
    if not items:
        raise InputError("There is nothing to export.")
    stems = file_stems(export.pattern, [each.named for each in items])
    paths = tuple(export.folder / f"{stem}{export.suffix}" for stem in stems)
    for path, item in zip(paths, items, strict=True):
        check_one(export, item, path)
    return paths


def check_one(export: Export, item: Item, path: Path) -> None:
    """Raise ``InputError`` when an item cannot be written under this path."""
    dimensions = len(item.job.size)
    check_result_format(path, export.bits, dimensions)
    if dimensions == 3 and export.quality is not None:
        raise ParamError("quality", f"left out for a solid ({', '.join(VOLUME_SUFFIXES)})", export.quality)
    if path.parent.is_dir():
        check_target(path)
    if _is_beside(export, path):
        check_beside(path)


def run_export(
    export: Export,
    items: Sequence[Item],
    paths: Sequence[Path] | None = None,
    *,
    on_progress: Callable[[float], None] | None = None,
    should_stop: Callable[[], bool] | None = None,
) -> tuple[Path, ...]:
    """Make what is not there yet and write all files, or none.

    Parameters
    ----------
    export, items
        What to write and how.
    paths
        Where, if not where :func:`planned` says.
    on_progress
        Called with the share that is done, 0 to 1, never falling.
    should_stop
        Asked between steps.

    Returns
    -------
    tuple of Path
        The files that were written, without the recipes beside them.

    Raises
    ------
    InputError
        When one cannot be made or written; then all that was there stays as it was.
    Cancelled
        When ``should_stop`` said so, also with nothing written.
    """
    targets = planned(export, items) if paths is None else tuple(paths)
    cache = AnalysisCache()
    files: dict[Path, bytes] = {}
    held = 0
    for index, (item, path) in enumerate(zip(items, targets, strict=True)):
        check_one(export, item, path)
        tell = _teller(on_progress, index, len(items))
        result = item.result or run(item.job, tell, should_stop, cache=cache)
        made = _files(export, result, path, item.measures)
        held += sum(map(len, made.values()))
        if held > _MOST_BYTES:
            raise InputError(
                f"The set has more than {_MOST_BYTES // 2**30} GB, the most that is written as one; ask for fewer "
                "or smaller files."
            )
        # Recipes go first: whenever the program ends, a file that is new has its own.
        files = {**{each: data for each, data in made.items() if each != path}, **files, path: made[path]}
        if on_progress is not None:
            on_progress((index + 1) / len(items))
    _write(files)
    return targets


def _write(files: Mapping[Path, bytes]) -> None:
    """Write a set; folders that are missing are made, and go again when it cannot be written."""
    made: list[Path] = []
    try:
        for folder in dict.fromkeys(path.parent for path in files):
            if not folder.exists():
                folder.mkdir()
                made.append(folder)
        write_together(files)
    except OSError as error:
        raise InputError(f"{error.filename}: cannot be made ({error.strerror}).") from error
    except InputError:
        for folder in made:
            folder.rmdir()
        raise


def run_items(
    items: Sequence[Item],
    *,
    on_progress: Callable[[float], None] | None = None,
    should_stop: Callable[[], bool] | None = None,
) -> tuple[Result, ...]:
    """Return the results of all items, made where they are not there yet; raises as :func:`run_export` does."""
    cache = AnalysisCache()
    return tuple(
        item.result or run(item.job, _teller(on_progress, index, len(items)), should_stop, cache=cache)
        for index, item in enumerate(items)
    )


def _teller(on_progress: Callable[[float], None] | None, index: int, count: int) -> Callable[[Step], None] | None:
    if on_progress is None:
        return None
    best = 0.0

    def tell(step: Step) -> None:
        nonlocal best
        share = 0.1 * step.fraction if step.phase == "analysis" else 0.1 + 0.85 * step.fraction
        best = max(best, share)
        on_progress((index + best) / count)

    return tell


def _is_beside(export: Export, path: Path) -> bool:
    return export.recipe == "beside" or (export.recipe == "inside" and not holds_recipe(path))


def _files(export: Export, result: Result, path: Path, measures: Mapping[str, float] | None) -> dict[Path, bytes]:
    bits = result_bits(result, path) if export.bits is None else export.bits
    recipe = written_recipe(result, measures)
    alpha = carried_alpha(result) if result.volume is None and can_hold_alpha(path) else None
    inside = recipe if export.recipe == "inside" else None
    data = encode_result(result, path, bits=bits, alpha=alpha, quality=export.quality, recipe=inside)
    if not _is_beside(export, path):
        return {path: data}
    return {path: data, sidecar(path): sidecar_bytes(path, recipe, hashlib.sha256(data).hexdigest())}


def export_tiles(results: Iterable[tuple[Item, Result]]) -> list[Tile]:
    """Return pictures of results for a figure, each with its title, size, seed and what is not at its default."""
    tiles = []
    for item, result in results:
        job = item.job
        defaults = type(job.params)().to_json()
        set_by_hand = [
            f"{name.replace('_', ' ')} {show(value)}"
            for name, value in job.params.to_json().items()
            if value != defaults[name]
        ]
        lines = (item.named.title, f"{size_text(job.size)}, seed {job.seed}", ", ".join(set_by_hand))
        tiles.append(Tile(result.image, tuple(line for line in lines if line)))
    return tiles
