"""Recipes: what a saved result was made from and how, and how to make it again."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from texlab_core.documents.embedding import MAX_EMBEDDED, MAX_USED, embed, unpack_arrays, unpack_pixels
from texlab_core.engine.inputs import ArraysInput, Crop, DataInput, ImageInput, Input
from texlab_core.engine.job import Job
from texlab_core.engine.params import frozen_mapping
from texlab_core.engine.run import versions
from texlab_core.engine.sizes import size_to_json
from texlab_core.errors import InputError, RecipeError
from texlab_core.files.strict_json import packed
from texlab_core.images.exemplar import as_exemplar, as_first_exemplar, take

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from texlab_core.engine.levels import Levels
    from texlab_core.engine.params import Params
    from texlab_core.engine.result import Result
    from texlab_core.images.exemplar import Source
    from texlab_core.images.formats.decoded import Depth

VERSION = 1
MAX_MEASURES = 256
MAX_MEASURE_NAME = 80


@dataclass(frozen=True, slots=True, eq=False)
class RecipeInput:
    """One input as a recipe has it.

    Parameters
    ----------
    role
        Which input of the method it is ("exemplar").
    kind
        "image", "data" or "arrays".
    name, sha256
        Of the input that was used.
    size
        Height and width of an image.
    scale, crop
        How the image was taken from its source.
    content
        The encoded source, pixels, arrays or data, under its key; empty when the file does not hold it. With an
        image comes its transparency under ``alpha``, where it was kept.
    depth
        Of an image: 8, 16 or "float", as its file had it.
    taken
        Scale and crop at which a picture was read that is too large to be kept whole.
    levels
        What was made of its values, after scale and crop; None: nothing.
    """

    role: str
    kind: str
    name: str
    sha256: str
    size: tuple[int, int] | None
    scale: float
    crop: Crop | None
    content: Mapping[str, Any]
    depth: Depth = 8
    taken: tuple[float, Crop | None] | None = None
    levels: Levels | None = None

    @property
    def is_embedded(self) -> bool:
        """Whether the recipe holds the input itself."""
        return bool(self.content)

    def restore(self, *, force: bool = False) -> Input:
        """Return the embedded input.

        Raises
        ------
        RecipeError
            When it is not embedded, malformed, or (unless ``force``) has another hash.
        """
        if not self.content:
            raise RecipeError(f"The recipe lacks {self.described}, which was too large to be kept in the file.")
        found = self._unpack()
        if found.sha256 != self.sha256 and not force:
            raise RecipeError(
                f"The recipe's input {self.name} is not the one that was used (another hash): the file was "
                "changed, or it was made with another version of the libraries."
            )
        return found

    def _unpack(self) -> Input:
        if self.kind == "arrays":
            return ArraysInput(unpack_arrays(self.content["arrays"], self.name), self.name)
        if self.kind == "data":
            return DataInput(self.content["data"], self.name)
        try:
            kind, crop, scale, levels = (
                ("source", self.crop, self.scale, self.levels)
                if "source" in self.content
                else ("pixels", None, 1.0, None)
            )
            alpha = self.content.get("alpha")
            return take(
                unpack_pixels(self.content[kind], self.name),
                self.name,
                crop,
                scale,
                depth=self.depth,
                alpha=None if alpha is None else unpack_pixels(alpha, self.name),
                taken=self.taken,
                levels=levels,
            )
        except RecipeError:
            raise
        except InputError as error:
            raise RecipeError(f"The recipe's input {error}") from error

    def match(self, given: Source, *, force: bool = False) -> ImageInput:
        """Return an image from outside as this input.

        It must have the hash of the one that was used, as it is or after the recipe's scale and crop; with
        ``force`` any image is taken as it is.

        Raises
        ------
        RecipeError
            When it is another image.
        ImageError
            When it cannot be read.
        """
        scale, crop = self.taken or (1.0, None)
        first = self._read(given, scale, crop, {})
        # A recipe does not say what was done with transparency; another hash tells that it was something else.
        readings: list[Callable[[], ImageInput]] = [
            lambda: first,
            lambda: self._read(given, scale, crop, {"alpha": "keep"}),
            lambda: self._read(given, scale, crop, {"background": 0.0}),
        ]
        if self.taken is None and not isinstance(given, ImageInput):
            readings.append(lambda: as_first_exemplar(given))
        for reading in readings:
            image = reading()
            if image.sha256 == self.sha256:
                return image
            if self.scale != 1 or self.crop is not None or self.levels is not None:
                try:
                    taken = as_exemplar(image, crop=self.crop, scale=self.scale, levels=self.levels)
                except InputError:
                    taken = image
                if taken.sha256 == self.sha256:
                    return taken
        if self.role in ("mask", "region"):
            from texlab_core.images.masks import as_mask

            if (mask := as_mask(given)).sha256 == self.sha256:
                return mask
        if self.role == "blend":
            from texlab_core.images.masks import as_blend

            if (blend := as_blend(given)).sha256 == self.sha256:
                return blend
        if not force:
            raise RecipeError(f"{first.name} is not the image of the recipe, which is {self.described}.")
        return first

    @staticmethod
    def _read(given: Source, scale: float, crop: Crop | None, reading: dict[str, Any]) -> ImageInput:
        """Read an image from outside; one that is not as large as it was is not scaled and cropped again."""
        if scale == 1 and crop is None:
            return as_exemplar(given, **reading)
        try:
            return as_exemplar(given, scale=scale, crop=crop, **reading)
        except InputError:
            return as_exemplar(given, **reading)

    @property
    def described(self) -> str:
        """Role, name, size and hash, for messages."""
        size = "" if self.size is None else f"{self.size[1]} x {self.size[0]} pixels, "
        return f"the {self.role} {self.name} ({size}SHA-256 {self.sha256[:12]}...)"


@dataclass(frozen=True, slots=True, eq=False)
class Recipe:
    """Everything that is needed to make a result again; every value was checked.

    Parameters
    ----------
    method
        Id of a registered method.
    params
        Its parameters; those that the file does not have take their defaults.
    size
        Height and width of the result, or depth, height and width.
    seed
        0 .. 2147483647.
    versions
        Of the program and the libraries that made the result.
    inputs
        By role.
    measures
        What was known of the result when it was saved: numbers by the id of their measure, some of which may be of
        packages that are not installed here. They decide nothing.
    """

    method: str
    params: Params
    size: tuple[int, ...]
    seed: int
    versions: Mapping[str, str]
    inputs: Mapping[str, RecipeInput]
    measures: Mapping[str, float] = field(default_factory=dict)

    @property
    def missing(self) -> tuple[RecipeInput, ...]:
        """The inputs that the file does not hold."""
        return tuple(each for each in self.inputs.values() if not each.is_embedded)

    @property
    def other_versions(self) -> Mapping[str, tuple[str, str]]:
        """Versions that differ, then and today; the same bits are promised only when there are none."""
        today = versions()
        return {name: (then, today[name]) for name, then in self.versions.items() if today.get(name, then) != then}

    def job(
        self, exemplar: Source | None = None, *, given: Mapping[str, Source] | None = None, force: bool = False
    ) -> Job:
        """Return the job that makes the result again.

        Parameters
        ----------
        exemplar
            Used instead of the embedded one, and needed when there is none. It must be the image of the recipe: as
            it was used, or the source that the recipe scales and crops. It also stands in for missing inputs with
            its hash.
        given
            Other images, by role, in the same way.
        force
            Take the given images whatever their hash.

        Raises
        ------
        RecipeError
            When an input is missing, damaged, or another one than the recipe's.
        """
        images = dict(given or {})
        if exemplar is not None:
            images["exemplar"] = exemplar
        for role in images:
            if role not in self.inputs or self.inputs[role].kind != "image":
                raise RecipeError(f"The recipe has no image called {role}.")
        found = {role: self.inputs[role].match(image, force=force) for role, image in images.items()}
        # An image that is grown outward is its own exemplar: one may stand in for several inputs.
        same = {self.inputs[role].sha256: image for role, image in found.items()}
        inputs: dict[str, Input] = {}
        for role, each in self.inputs.items():
            stand_in = found.get(role) or (None if each.is_embedded else same.get(each.sha256))
            inputs[role] = each.restore(force=force) if stand_in is None else stand_in
        try:
            return Job(method=self.method, inputs=inputs, params=self.params, size=self.size, seed=self.seed)
        except InputError as error:
            raise RecipeError(f"The recipe cannot be followed: {error}") from error


def written_recipe(result: Result, measures: Mapping[str, float] | None = None) -> str:
    """Return the recipe of a result as files carry it: JSON on one line; see :func:`recipe_json`."""
    return packed(recipe_json(result, measures))


def recipe_json(result: Result, measures: Mapping[str, float] | None = None) -> dict[str, Any]:
    """Return the recipe of a result as JSON data, with its inputs.

    Parameters
    ----------
    result
        What was made.
    measures
        What is known about it, by id; None takes what its method said. Nothing is measured for it.
    """
    job = result.job
    known = known_measures(result.measures if measures is None else measures)
    return {
        "texlab": VERSION,
        "method": job.method,
        "params": job.params.to_json(),
        "size": size_to_json(job.size),
        "seed": job.seed,
        "versions": dict(result.versions),
        **({"measures": known} if known else {}),
        # One of them may be larger, so that all together stay within what is read.
        "inputs": {
            role: embed(each, used=MAX_USED if role == "exemplar" else MAX_EMBEDDED)
            for role, each in job.inputs.items()
        },
    }


def known_measures(measures: Mapping[str, float]) -> dict[str, float]:
    """Return the numbers that JSON can hold."""
    return {name: float(value) for name, value in measures.items() if math.isfinite(value)}


def measures_from_json(data: object) -> Mapping[str, float]:
    """Return numbers by the ids of their measures; raises ``RecipeError`` when they are something else."""
    usable = isinstance(data, dict) and len(data) <= MAX_MEASURES
    for name, value in data.items() if usable and isinstance(data, dict) else ():
        is_name = len(name) <= MAX_MEASURE_NAME and name.isprintable()
        usable = usable and is_name and isinstance(value, int | float) and not isinstance(value, bool)
    if not usable or not isinstance(data, dict):
        raise RecipeError("measures must be a few numbers by name.")
    return frozen_mapping(known_measures(data))
