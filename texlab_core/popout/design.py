"""Which pictures a pop-out test shows, where the pieces lie, and in which order: all of it from one seed."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from texlab_core.engine.job import MAX_SEED, Job, check_seed, check_size
from texlab_core.engine.registry import EXEMPLAR, find_method
from texlab_core.engine.streams import Streams
from texlab_core.errors import InputError, ParamError
from texlab_core.files.wording import printable

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from texlab_core.engine.inputs import ImageInput
    from texlab_core.engine.params import Params

# Smaller pieces hold no texture.
SMALLEST_PIECE = 16
MAX_REPEATS = 100
MAX_TRIALS = 500
MAX_SETTINGS = 20
MAX_NAME = 200
# Who always clicks the middle must not be right more often than this.
MOST_CHANCE = 0.5
DEFAULT_SHARE = 0.5
SMALLEST_PICTURE = 256
DEFAULT_REPEATS = 5


@dataclass(frozen=True, kw_only=True)
class Setting:
    """A method with its parameters, as one of those that are compared.

    Parameters
    ----------
    method
        Id of a method that makes pictures from the exemplar alone.
    params
        Its parameters.
    name
        What it is called when the test is over; "" takes the method's title.
    """

    method: str
    params: Params
    name: str = ""

    def __post_init__(self) -> None:
        method = find_method(self.method)
        if method.dimensions != 2:
            raise InputError(f"{method.title} makes solids, and a pop-out test shows pictures.")
        needed = {each.name for each in method.inputs if each.required}
        if not needed <= {EXEMPLAR.name} or EXEMPLAR.name not in {each.name for each in method.inputs}:
            raise InputError(
                f"{method.title} does not make its pictures from the exemplar alone; a pop-out test takes methods"
                " that do."
            )
        object.__setattr__(self, "name", printable(self.name, MAX_NAME) or method.title)


@dataclass(frozen=True, kw_only=True)
class Trial:
    """One picture of the test.

    Parameters
    ----------
    number
        Place in the order of showing, from 1.
    setting
        Index of the setting that makes it.
    seed
        Of its synthesis.
    top, left
        First row and column of the piece in the picture.
    piece_top, piece_left
        First row and column of the piece in the exemplar.
    """

    number: int
    setting: int
    seed: int
    top: int
    left: int
    piece_top: int
    piece_left: int


@dataclass(frozen=True, kw_only=True)
class Design:
    """A whole test.

    Parameters
    ----------
    exemplar
        What pieces are cut from and pictures are made of.
    settings
        1 .. 20 methods with parameters; names that are the same get numbers.
    repeats
        Pictures of each, 1 .. 100, each from a seed of its own; 500 in all.
    size
        Height and width of the pictures.
    share
        Sides of the piece over those of the exemplar, above 0 .. 1; 1 pastes the whole exemplar, as in the paper.
    feather
        Width in pixels over which the piece is blended in; 0 is the hard edge of the paper.
    seed
        Decides seeds, places and order.

    Raises
    ------
    InputError
        When a value is out of range, the piece is under 16 pixels, or the picture is so small that a click in its
        middle would be right in more than half of the cases.
    """

    exemplar: ImageInput
    settings: tuple[Setting, ...]
    repeats: int = DEFAULT_REPEATS
    size: tuple[int, int]
    share: float = DEFAULT_SHARE
    feather: int = 0
    seed: int = 0

    def __post_init__(self) -> None:
        if not 1 <= len(self.settings) <= MAX_SETTINGS:
            raise InputError(f"A pop-out test takes 1 to {MAX_SETTINGS} methods, got {len(self.settings)}.")
        object.__setattr__(self, "settings", named_apart(self.settings))
        if type(self.repeats) is not int or not 1 <= self.repeats <= MAX_REPEATS:
            raise ParamError("repeats", f"a whole number from 1 to {MAX_REPEATS}", self.repeats)
        if self.repeats * len(self.settings) > MAX_TRIALS:
            raise InputError(
                f"A pop-out test has at most {MAX_TRIALS} pictures, got {self.repeats * len(self.settings)}."
            )
        if not isinstance(self.share, int | float) or not 0 < self.share <= 1:
            raise ParamError("share", "a number above 0, at most 1", self.share)
        check_seed(self.seed)
        height, width = check_size(self.size, 2)
        rows, columns = self.piece
        if min(rows, columns) < SMALLEST_PIECE:
            raise InputError(
                f"The piece would have {columns} x {rows} pixels; it takes at least"
                f" {SMALLEST_PIECE} x {SMALLEST_PIECE}: choose a larger share or a larger exemplar."
            )
        if type(self.feather) is not int or not 0 <= self.feather <= min(rows, columns) // 2:
            raise ParamError("feather", f"a whole number from 0 to {min(rows, columns) // 2}", self.feather)
        if height < rows or width < columns or chance((height, width), self.piece) > MOST_CHANCE:
            high, wide = least_size(self.piece)
            raise InputError(
                f"size: the piece has {columns} x {rows} pixels, so that in pictures of {width} x {height} a click"
                f" in the middle would mostly be right; {wide} x {high} pixels or more are needed."
            )

    @property
    def piece(self) -> tuple[int, int]:
        """Height and width of the piece."""
        height, width = self.exemplar.size
        return round(self.share * height), round(self.share * width)

    @property
    def chance(self) -> float:
        """Share of hits that the best click without looking would reach."""
        return chance(self.size, self.piece)

    def trials(self) -> tuple[Trial, ...]:
        """Return all pictures in the order of showing.

        Seeds and places are drawn for each setting and repetition from a stream of its own, so that further
        repetitions leave those before as they are; only the order changes.
        """
        streams = Streams(self.seed)
        (height, width), (rows, columns), whole = self.size, self.piece, self.exemplar.size
        drawn = []
        for setting in range(len(self.settings)):
            for repeat in range(self.repeats):
                draw = streams("popout trial", setting, repeat)
                seed = int(draw.integers(0, MAX_SEED, endpoint=True))
                ends = (height - rows, width - columns, whole[0] - rows, whole[1] - columns)
                drawn.append((setting, seed, *(int(draw.integers(0, end, endpoint=True)) for end in ends)))
        order = streams("popout order").permutation(len(drawn))
        names = ("setting", "seed", "top", "left", "piece_top", "piece_left")
        return tuple(
            Trial(number=place, **dict(zip(names, drawn[int(index)], strict=True)))
            for place, index in enumerate(order, 1)
        )

    def job(self, trial: Trial) -> Job:
        """Return the job of a picture before the piece is put in; raises ``InputError`` when it cannot work."""
        setting = self.settings[trial.setting]
        inputs = {EXEMPLAR.name: self.exemplar}
        return Job(method=setting.method, inputs=inputs, params=setting.params, size=self.size, seed=trial.seed)

    def to_json(self) -> dict[str, Any]:
        """Return it as JSON data; of the exemplar name, size and hash."""
        return {
            "exemplar": {
                "name": printable(self.exemplar.name, MAX_NAME),
                "sha256": self.exemplar.sha256,
                "size": list(self.exemplar.size),
            },
            "settings": [
                {"name": each.name, "method": each.method, "parameters": each.params.to_json()}
                for each in self.settings
            ],
            "repeats": self.repeats,
            "size": list(self.size),
            "piece": list(self.piece),
            "share": self.share,
            "feather": self.feather,
            "seed": self.seed,
        }


def usual_size(exemplar: ImageInput, share: float) -> tuple[int, int]:
    """Return height and width of pictures in which the piece has room: three times its sides, at least 256."""
    height, width = (max(SMALLEST_PICTURE, 3 * round(share * side)) for side in exemplar.size)
    return height, width


def chance(size: tuple[int, int], piece: tuple[int, int]) -> float:
    """Return the share of hits of the best click without looking, for places that are all equally likely.

    That is a click in the middle: along a side of N pixels a piece of n pixels has N - n + 1 places, and
    min(n, N - n + 1) of them cover the middle.
    """
    return math.prod(min(n, side - n + 1) / (side - n + 1) for side, n in zip(size, piece, strict=True))


def least_size(piece: tuple[int, int]) -> tuple[int, int]:
    """Return the smallest height and width, in the piece's ratio, at which guessing is right in half at most."""
    rows, columns = (math.ceil(n * (1 + math.sqrt(1 / MOST_CHANCE))) - 1 for n in piece)
    return rows, columns


def named_apart(settings: Sequence[Setting]) -> tuple[Setting, ...]:
    """Return settings whose names all differ: the second one of a name gets a 2 behind it, and so on."""
    taken: set[str] = set()
    found = []
    for each in settings:
        name, number = each.name, 1
        while name in taken:
            number += 1
            name = f"{each.name} {number}"
        taken.add(name)
        found.append(replace(each, name=name))
    return tuple(found)


def settings_of(names: Sequence[str], params: Mapping[str, Params] | None = None) -> tuple[Setting, ...]:
    """Return settings of methods by id, with their defaults where ``params`` has none for them."""
    given = params or {}
    return tuple(
        Setting(method=name, params=given[name] if name in given else find_method(name).params()) for name in names
    )


def figures(seed: int = 0, repeats: int = 1) -> Design:
    """Return Figs. 2 to 5 of De Bonet's paper as a test: the whole original on what four methods make of it.

    Repetition (Fig. 2), independent pixels (Fig. 3), independent bands (Fig. 4), and the paper's own method with
    the paper's settings (Fig. 5), which alone is meant to hide the original.
    """
    from texlab_core.documents.preset_store import bundled_presets
    from texlab_core.engine.inputs import Crop
    from texlab_core.images.exemplar import as_exemplar

    crop = Crop(top=64, left=64, height=96, width=96)
    exemplar = as_exemplar("gallery:stochastic-gravel", crop=crop)
    named = {2: "tiling", 3: "pixels", 4: "bands", 5: "de-bonet"}
    paper = {each.method: each.params() for each in bundled_presets("de-bonet") if each.name == "paper"}
    settings = []
    for figure, name in named.items():
        method = find_method(name)
        params = paper.get(name) or method.params()
        settings.append(Setting(method=name, params=params, name=f"Fig. {figure}: {method.title}"))
    side = 3 * crop.height
    return Design(
        exemplar=exemplar, settings=tuple(settings), repeats=repeats, size=(side, side), share=1.0, seed=seed
    )


def paste(image: np.ndarray, piece: np.ndarray, top: int, left: int, feather: int = 0) -> np.ndarray:
    """Return a picture with a piece laid over it.

    Parameters
    ----------
    image
        (H, W, C) float32 in [0, 1].
    piece
        (h, w, C) float32, or with one channel where the picture has three, or the other way round.
    top, left
        Its first row and column in the picture; it lies inside.
    feather
        Width in pixels of the ramp at its four sides, a raised cosine; with 0 every sample is the piece's.

    Returns
    -------
    ndarray
        (H, W, max of both C) float32.
    """
    height, width = piece.shape[:2]
    rows, columns = slice(top, top + height), slice(left, left + width)
    if not (0 <= top <= image.shape[0] - height and 0 <= left <= image.shape[1] - width):
        raise ValueError(f"A piece of {height} x {width} at ({top}, {left}) is not inside {image.shape[:2]}.")
    channels = max(image.shape[2], piece.shape[2])
    made = np.array(np.broadcast_to(image, (*image.shape[:2], channels)), np.float32)
    if feather == 0:
        made[rows, columns] = piece
        return made
    weights = np.outer(ramp(height, feather), ramp(width, feather))[:, :, None].astype(np.float32)
    made[rows, columns] += weights * (piece - made[rows, columns])
    return made


def ramp(length: int, feather: int) -> np.ndarray:
    """Return weights (length,) that rise from 0 to 1 over ``feather`` pixels at both ends, as sin^2."""
    inside = np.minimum(np.arange(length), np.arange(length)[::-1]) + 0.5
    return np.asarray(np.square(np.sin(np.pi / 2 * np.minimum(inside / max(feather, 1), 1.0))))
