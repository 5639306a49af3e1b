"""Making the pictures of a pop-out test, letting the machine look at them, and writing both for other programs."""

from __future__ import annotations

import csv
import io
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from texlab_core.engine.cache import AnalysisCache
from texlab_core.engine.run import run
from texlab_core.errors import Cancelled, InputError
from texlab_core.files import strict_json
from texlab_core.files.whole import write_together
from texlab_core.images.formats.maps import made_folder
from texlab_core.popout.design import paste
from texlab_core.popout.observer import observe
from texlab_core.popout.record import ANSWER_COLUMNS, Record
from texlab_core.popout.scoring import Answer

if TYPE_CHECKING:
    import os
    from collections.abc import Callable

    from numpy.typing import NDArray

    from texlab_core.engine.steps import FloatImage
    from texlab_core.popout.design import Design, Trial

KEY_NAME, ANSWERS_NAME = "key.json", "answers.csv"


@dataclass(frozen=True, eq=False)
class Made:
    """The pictures of a test.

    Parameters
    ----------
    record
        The test, with the machine's clicks.
    pictures
        (H, W, 3) uint8 in the order of showing; gray is repeated.
    """

    record: Record
    pictures: tuple[NDArray[np.uint8], ...]


def picture_of(
    design: Design,
    trial: Trial,
    *,
    cache: AnalysisCache | None = None,
    should_stop: Callable[[], bool] | None = None,
) -> FloatImage:
    """Return the picture of a trial, (H, W, C) float32 in [0, 1], with the piece in it.

    Raises
    ------
    InputError
        When the method cannot work.
    Cancelled
        When ``should_stop`` said so.
    """
    result = run(design.job(trial), should_stop=should_stop, cache=cache)
    (rows, columns), pixels = design.piece, design.exemplar.pixels
    piece = pixels[trial.piece_top : trial.piece_top + rows, trial.piece_left : trial.piece_left + columns]
    made: FloatImage = paste(result.image, piece, trial.top, trial.left, design.feather)
    return made


def make(
    design: Design,
    *,
    on_progress: Callable[[float], None] | None = None,
    should_stop: Callable[[], bool] | None = None,
    cache: AnalysisCache | None = None,
) -> Made:
    """Make all pictures, and let the machine observer look at each.

    They are made before any is shown: how long one takes would tell its method.

    Parameters
    ----------
    design
        The test.
    on_progress
        Called with the share that is done.
    should_stop
        Asked every few milliseconds.
    cache
        Where analyses are kept and found.

    Raises
    ------
    InputError
        When a method cannot work; the message does not say in which picture.
    Cancelled
        When ``should_stop`` said so.
    """
    cache = AnalysisCache() if cache is None else cache

    def look() -> None:
        if should_stop is not None and should_stop():
            raise Cancelled

    record = Record.of(design)
    pictures, clicks = [], []
    for done, trial in enumerate(record.trials):
        if on_progress is not None:
            on_progress(done / len(record.trials))
        look()
        made = picture_of(design, trial, cache=cache, should_stop=should_stop)
        picture = np.rint(np.clip(made, 0, 1) * 255).astype(np.uint8)
        pictures.append(np.ascontiguousarray(np.broadcast_to(picture, (*picture.shape[:2], 3))))
        # What the machine sees is what people see: eight bits.
        seen = observe(picture.astype(np.float32) / np.float32(255), design.piece, look)
        if seen is not None:
            clicks.append(Answer(trial.number, *seen))
    if on_progress is not None:
        on_progress(1.0)
    return Made(record.with_machine(clicks), tuple(pictures))


def write_test(made: Made, folder: str | os.PathLike[str]) -> tuple[str, ...]:
    """Write pictures, a key and an empty table of answers into a folder that is new or empty: all or nothing.

    Returns
    -------
    tuple
        Names of the files: ``001.png`` and so on in the order of showing, which say nothing but their pixels, then
        ``answers.csv`` and ``key.json``.

    Raises
    ------
    InputError
        When the folder is no folder, is not empty, or cannot be written to.
    """
    from texlab_core.images.formats.writing import encode_png

    out = check_folder(folder)
    digits = max(3, len(str(len(made.pictures))))
    names = [f"{place:0{digits}}.png" for place in range(1, len(made.pictures) + 1)]
    files = {out / name: encode_png(picture) for name, picture in zip(names, made.pictures, strict=True)}
    table = io.StringIO()
    writer = csv.writer(table)
    writer.writerow((*ANSWER_COLUMNS, "picture"))
    writer.writerows((place, "", "", "", name) for place, name in enumerate(names, 1))
    files[out / ANSWERS_NAME] = table.getvalue().encode()
    files[out / KEY_NAME] = strict_json.dumps(made.record.to_json()).encode()
    with made_folder(out):
        write_together(files)
    return tuple(path.name for path in files)


def check_folder(folder: str | os.PathLike[str]) -> Path:
    """Return a folder that a test can be written into; raises ``InputError`` unless it is empty or not there."""
    out = Path(folder)
    if not str(folder):
        raise InputError("out: the name of the folder is empty.")
    try:
        if out.is_dir():
            if any(out.iterdir()):
                raise InputError(f"{out}: must be a new or an empty folder, and there are files in it.")
        elif out.exists() or out.is_symlink():
            raise InputError(f"{out}: must be a new or an empty folder, and it is a file.")
        elif not out.parent.is_dir():
            raise InputError(f"{out}: the folder {out.parent} does not exist.")
    except (OSError, ValueError) as error:
        raise InputError(f"{out}: cannot be used ({getattr(error, 'strerror', None) or error}).") from error
    return out
