"""One method with the same parameters over many textures: a grid of jobs like any other sweep."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from typing import TYPE_CHECKING

from texlab_core.engine.job import Job
from texlab_core.errors import Cancelled, InputError
from texlab_core.images.gallery import gallery
from texlab_core.sheets.sweep import MAX_CELLS, TEXTURE, Sweep, Vary

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping, Sequence

    from texlab_core.engine.inputs import Crop, ImageInput, Input
    from texlab_core.engine.params import Params

# A larger texture is reduced to this longest side: its structure is to fit into cells of usual size.
LARGEST_SIDE = 256


@dataclass(frozen=True, eq=False)
class TextureGrid(Sweep):
    """A sweep whose first axis runs over textures, all in cells of one size; the second may vary one knob.

    Parameters
    ----------
    base, axes
        As of a sweep; the first axis is :data:`TEXTURE` with what the textures are called.
    textures
        The exemplars, one for each value of the first axis.
    """

    textures: tuple[ImageInput, ...] = ()

    def _checked(self, axis: Vary) -> Vary:
        return axis if axis.name == TEXTURE else super()._checked(axis)

    def _job(self, index: int) -> Job:
        texture = self.textures[index % len(self.textures)]
        job = dataclasses.replace(self.base, inputs={**self.base.inputs, "exemplar": texture})
        changes = {name: value for name, value in self.values(index).items() if name != TEXTURE}
        seed = changes.pop("seed", job.seed)
        return dataclasses.replace(job, params=job.params.replace(**changes), seed=seed)


LeftOut = tuple[tuple[str, str], ...]
"""Names of textures that have no place in a grid, each with the reason in one sentence."""


def texture_grid(
    textures: Sequence[ImageInput],
    method: str,
    params: Params | None = None,
    *,
    size: tuple[int, ...] | None = None,
    seed: int = 0,
    inputs: Mapping[str, Input] | None = None,
    down: Vary | None = None,
) -> tuple[TextureGrid, LeftOut]:
    """Return the grid of a method over textures, and those that it cannot work with.

    Parameters
    ----------
    textures
        The exemplars, in order.
    method, params, size, seed
        What all cells share; None takes the defaults and the first texture's own size.
    inputs
        Further inputs of the method.
    down
        One knob (or ``seed``) that is varied in each texture's column.

    Raises
    ------
    InputError
        When there is none that the method can work with, or there are more than 400 cells.
    """
    if not textures:
        raise InputError("A grid of textures needs at least one that can be read.")
    rows = 1 if down is None else len(down.values)
    if len(textures) * rows > MAX_CELLS:
        raise InputError(f"A sweep has at most {MAX_CELLS} cells, got {len(textures) * rows}.")
    axes = () if down is None else (down,)
    found: list[ImageInput] = []
    left_out: list[tuple[str, str]] = []
    base: Job | None = None
    for texture in textures:
        own = {**(inputs or {}), "exemplar": texture}
        try:
            wanted = size if base is None else base.size
            # None takes the defaults.
            job = Job(method=method, inputs=own, params=params, size=wanted, seed=seed)  # type: ignore[arg-type]
            TextureGrid(job, (Vary(TEXTURE, (texture.name,)), *axes), textures=(texture,))
        except InputError as error:
            left_out.append((texture.name, str(error)))
            continue
        base = job if base is None else base
        found.append(texture)
    if base is None:
        raise InputError(left_out[0][1])
    titles = {entry.uri: entry.title for entry in gallery()}
    names = tuple(titles.get(each.name, each.name) for each in found)
    return TextureGrid(base, (Vary(TEXTURE, names), *axes), textures=tuple(found)), tuple(left_out)


def read_textures(
    sources: Iterable[str],
    *,
    scale: float | None = None,
    crop: Crop | None = None,
    should_stop: Callable[[], bool] | None = None,
) -> tuple[tuple[ImageInput, ...], LeftOut]:
    """Read many textures; what cannot be read is left out, with the reason.

    Parameters
    ----------
    sources
        Paths, or ``gallery:NAME``.
    scale, crop
        Taken of each; without both, a texture with a side above 256 pixels is reduced to that, as its notes say.
    should_stop
        Asked before and while each is read.

    Raises
    ------
    Cancelled
        When ``should_stop`` said so.
    """
    from texlab_core.images.exemplar import as_exemplar

    found: list[ImageInput] = []
    left_out: list[tuple[str, str]] = []
    for source in sources:
        if should_stop is not None and should_stop():
            raise Cancelled
        try:
            image = as_exemplar(source, scale=scale or 1.0, crop=crop, should_stop=should_stop)
        except InputError as error:
            left_out.append((source, str(error)))
            continue
        if scale is None and crop is None and max(image.size) > LARGEST_SIDE:
            image = as_exemplar(image, scale=round(LARGEST_SIDE / max(image.size), 4))
        found.append(image)
    return tuple(found), tuple(left_out)


def left_out_words(left_out: LeftOut) -> str:
    """Return one sentence about what has no place in a grid; empty when everything has."""
    if not left_out:
        return ""
    count = "One texture is" if len(left_out) == 1 else f"{len(left_out)} textures are"
    return f"{count} left out: {left_out[0][1]}"
